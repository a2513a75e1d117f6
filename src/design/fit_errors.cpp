// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/fit_errors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "design/correlated.hpp"
#include "engine/parallel.hpp"
#include "numerics/median.hpp"
#include "numerics/nan.hpp"

namespace leapmap {
namespace {

/// The least sum of squares with one parameter held, the others refitted from a place.
LeastSquaresFit with_one_held(const LeastSquares& problem, std::vector<double> at, std::size_t held,
                              double value) {
  LeastSquares rest{.bounds = problem.bounds, .residuals = problem.residuals, .evaluate = {}};
  rest.bounds.erase(rest.bounds.begin() + static_cast<std::ptrdiff_t>(held));
  const std::size_t columns = problem.bounds.size();
  rest.evaluate = [&](std::span<const double> others, std::span<double> residuals,
                      std::span<double> jacobian) {
    std::vector<double> all(others.begin(), others.end());
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(held), value);
    std::vector<double> whole(jacobian.empty() ? 0 : problem.residuals * columns);
    if (!problem.evaluate(all, residuals, whole)) return false;
    for (std::size_t i = 0, to = 0; i < whole.size(); ++i)
      if (i % columns != held) jacobian[to++] = whole[i];
    return true;
  };
  at.erase(at.begin() + static_cast<std::ptrdiff_t>(held));
  if (!at.empty()) return minimize(rest, at);
  LeastSquaresFit alone{.at = {}, .residuals = std::vector<double>(problem.residuals), .jacobian = {}};
  if (rest.evaluate({}, alone.residuals, {})) alone.sum = sum_of_squares(alone.residuals);
  return alone;
}

/// The ends of where the sum of squares stays below `most`: by steps from the best outwards, and bisection
/// where that ends. Both ends are looked for side by side.
std::array<double, 2> profile(const LeastSquares& problem, std::span<const double> best, std::size_t k,
                              double most, const FitOptions& options) {
  constexpr int steps = 8, halvings = 6;
  const std::array bounds{problem.bounds[k].low, problem.bounds[k].high};
  std::array ends{best[k], best[k]};
  const auto find_end = [&](std::size_t which) {
    std::vector<double> at(best.begin(), best.end());
    const double bound = bounds[which];
    double& end = ends[which];
    const auto holds = [&](double value) {
      const LeastSquaresFit fit = with_one_held(problem, at, k, value);
      if (!(fit.sum <= most)) return false;
      end = value, at = fit.at;
      at.insert(at.begin() + static_cast<std::ptrdiff_t>(k), value);
      return true;
    };
    double beyond = bound;
    int step = 1;
    while (step <= steps && holds(beyond = best[k] + (bound - best[k]) * step / steps)) ++step;
    for (int halving = 0; step <= steps && halving < halvings; ++halving)
      if (const double middle = 0.5 * (end + beyond); !holds(middle)) beyond = middle;
    return true;
  };
  parallel_for_each(ends.size(), options.threads, options.stop_requested, [&] { return find_end; });
  return ends;
}

/// Residuals line by line, of the times at which all was measured that ever was.
struct Lines {
  std::vector<double> residuals{};
  std::size_t columns = 0;

  double count() const { return static_cast<double>(residuals.size() / columns); }
};

Lines lines_of(std::span<const Observation> observations, std::span<const double> residuals) {
  Lines lines;
  const auto end_of_time = [&](std::size_t i) {
    std::size_t end = i;
    while (end < observations.size() && observations[end].t == observations[i].t) ++end;
    return end;
  };
  for (std::size_t i = 0; i < observations.size(); i = end_of_time(i))
    lines.columns = std::max(lines.columns, end_of_time(i) - i);
  for (std::size_t i = 0; i < observations.size(); i = end_of_time(i))
    if (end_of_time(i) - i == lines.columns)
      lines.residuals.insert(lines.residuals.end(), residuals.begin() + static_cast<std::ptrdiff_t>(i),
                             residuals.begin() + static_cast<std::ptrdiff_t>(end_of_time(i)));
  return lines;
}

/// The residuals, the large ones cut to what counts of them.
std::vector<double> limited(std::span<const double> residuals, double deviation) {
  std::vector<double> limited;
  for (const double residual : residuals)
    limited.push_back(std::clamp(residual, -huber_limit * deviation, huber_limit * deviation));
  return limited;
}

}  // namespace

double robust_deviation(std::span<const double> residuals) {
  std::vector<double> sizes;
  for (const double residual : residuals) sizes.push_back(std::abs(residual));
  constexpr double of_normal = 0.6745;
  return std::max(median(std::move(sizes)) / of_normal, 1e-12);
}

std::vector<double> huber_weights(std::span<const double> residuals) {
  const double limit = huber_limit * robust_deviation(residuals);
  std::vector<double> weights;
  for (const double residual : residuals)
    weights.push_back(std::min(1.0, limit / std::max(std::abs(residual), 1e-300)));
  return weights;
}

LeastSquares weighed(const LeastSquares& problem, std::span<const double> weights) {
  std::vector<double> factors;
  for (const double weight : weights) factors.push_back(std::sqrt(weight));
  LeastSquares weighed{.bounds = problem.bounds, .residuals = problem.residuals, .evaluate = {}};
  weighed.evaluate = [evaluate = problem.evaluate, columns = problem.bounds.size(),
                      factors = std::move(factors)](std::span<const double> at, std::span<double> there,
                                                    std::span<double> jacobian) {
    if (!evaluate(at, there, jacobian)) return false;
    for (std::size_t i = 0; i < there.size(); ++i) there[i] *= factors[i];
    for (std::size_t i = 0; i < jacobian.size(); ++i) jacobian[i] *= factors[i / columns];
    return true;
  };
  return weighed;
}

Spreading spreading_of(std::span<const double> residuals, std::size_t degrees, bool errors_known, Loss loss) {
  // Of numbers without any error the residuals are those of rounding.
  constexpr double rounding = 1e-20;
  const double numbers = static_cast<double>(residuals.size());
  Spreading spreading{.sum = sum_of_squares(residuals)};
  double inside = 1.0;
  if (loss == Loss::huber) {
    const std::vector<double> cut = limited(residuals, robust_deviation(residuals));
    spreading.sum = sum_of_squares(cut);
    std::size_t whole = 0;
    for (std::size_t i = 0; i < cut.size(); ++i) whole += cut[i] == residuals[i];
    inside = static_cast<double>(whole) / numbers;
  }
  if (!errors_known) spreading.sum = std::max(spreading.sum, rounding * numbers);
  if (!errors_known || loss == Loss::huber)
    spreading.variance = spreading.sum / static_cast<double>(degrees) / (inside * inside);
  spreading.uncertainty = spreading.variance;
  return spreading;
}

void judge_film(const Explained& explained, std::span<const double> all, Loss loss, Spreading& spreading,
                ModelFit& told) {
  // Bad points say nothing of the others.
  const std::vector<double> cut =
      loss == Loss::huber ? limited(all, robust_deviation(all)) : std::vector<double>(all.begin(), all.end());
  const std::span<const double> residuals = cut;
  const std::vector<Observation>& observations = explained.observations();
  const Lines lines = lines_of(observations, residuals);
  const Correlation correlation =
      correlation_of(lines.residuals, lines.columns, explained.problem().bounds.size());
  told.correlation = correlation.lines;
  told.independent = std::min(lines.count() / correlation.lines, correlation.carrying);
  if (correlation.lines > 1.0) spreading.uncertainty = std::max(spreading.variance, correlation.variance);
  const Measured first = observations.front().kind;
  double squares = 0.0, over_scatter = 0.0;
  std::size_t alike = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!are_alike(observations[i].kind, first)) continue;
    const double residual = residuals[i] * explained.error_of(i);
    squares += residual * residual, ++alike;
  }
  told.error = std::sqrt(squares / static_cast<double>(alike));
  told.judged = explained.errors_known();
  if (told.judged) return;
  constexpr double least_scatter = 1e-6;  // of numbers without noise no more is asked than six digits
  for (const Measured kind : {Measured::angle, Measured::spin, Measured::x}) {
    const double scatter = scatter_of(observations, kind);
    if (std::isnan(scatter)) continue;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < residuals.size(); ++i)
      if (are_alike(observations[i].kind, kind)) {
        const double residual = residuals[i] * explained.error_of(i);
        sum += residual * residual, ++count;
      }
    if (count == 0) continue;
    told.judged = true;
    const double least = is_position(kind) ? least_scatter * explained.units_per_metre() : least_scatter;
    over_scatter =
        std::max(over_scatter, std::sqrt(sum / static_cast<double>(count)) / std::max(scatter, least));
  }
  if (told.judged) told.misfit = over_scatter;
}

void tell_uncertainty(const LeastSquares& problem, const LeastSquaresFit& best, double variance,
                      const FitOptions& options, ModelFit& told) {
  const auto rows = static_cast<Eigen::Index>(problem.residuals),
             columns = static_cast<Eigen::Index>(problem.bounds.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowMajor J = Eigen::Map<const RowMajor>(best.jacobian.data(), rows, columns);
  Eigen::VectorXd width(columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Side& side = problem.bounds[static_cast<std::size_t>(k)];
    width[k] = side.high - side.low;
    J.col(k) *= width[k];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
  // A direction that the data say nothing of counts as known to a thousand boxes.
  const double least = std::sqrt(variance) * 1e-3;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(columns, columns);
  for (Eigen::Index i = 0; i < svd.matrixV().cols(); ++i) {
    const double known = std::max(svd.singularValues()[i], least);
    covariance += svd.matrixV().col(i) * svd.matrixV().col(i).transpose() * (variance / (known * known));
  }
  // Bad points move no end of a profile. Weights flatten the sum by their mean, as they do its curvature.
  const std::vector<double> weights = options.loss == Loss::huber
                                          ? huber_weights(best.residuals)
                                          : std::vector<double>(problem.residuals, 1.0);
  const LeastSquares counted = weighed(problem, weights);
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * best.residuals[i] * best.residuals[i];
  const double mean =
      std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  for (std::size_t k = 0; k < told.parameters.size(); ++k) {
    FittedParameter& parameter = told.parameters[k];
    const Side& side = problem.bounds[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double share = std::sqrt(covariance(i, i));
    constexpr double as_good_as_known =
        0.29;  // of a box: the deviation of a number that may be anywhere in it
    constexpr double on = 1e-5;
    parameter.identified = share < as_good_as_known;
    parameter.error = parameter.identified ? share * width[i] : nan;
    const double at = (parameter.value - side.low) / (side.high - side.low);
    parameter.at_bound = at < on || at > 1.0 - on;
    parameter.low = parameter.value - parameter.error, parameter.high = parameter.value + parameter.error;
    if (!parameter.identified || parameter.at_bound) {
      const auto [low, high] = profile(counted, best.at, k, sum + mean * variance, options);
      parameter.low = low, parameter.high = high;
    }
    for (std::size_t j = 0; j < told.parameters.size(); ++j) {
      const auto l = static_cast<Eigen::Index>(j);
      told.correlations.push_back(covariance(i, l) / std::sqrt(covariance(i, i) * covariance(l, l)));
    }
  }
}

}  // namespace leapmap
