// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/fit.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>

#include "design/correlated.hpp"
#include "design/explained.hpp"
#include "design/least_squares.hpp"
#include "engine/parallel.hpp"
#include "leapmap/solve.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "numerics/sobol_points.hpp"
#include "spec/options.hpp"
#include "spec/spec.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double sum_of_squares(std::span<const double> residuals) {
  return std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
}

/// A place of the free parameters, and what it leaves unexplained.
struct CoarsePlace {
  std::vector<double> at;
  double sum;
};

/// Adds a map of a part of the box about a place, as large as `share` of it.
void map_coarsely(const Explained& explained, const FitOptions& options, const SobolPoints& points,
                  std::span<const double> centre, double share, std::vector<CoarsePlace>& places) {
  constexpr std::size_t a_block = 256;
  const std::size_t samples = points.samples(), dimensions = explained.searched();
  std::vector<std::vector<double>> found(samples, std::vector<double>(dimensions));
  std::vector<double> sums(samples);
  parallel_for_each((samples + a_block - 1) / a_block, options.threads, options.stop_requested, [&] {
    return [&](std::size_t block) {
      if (options.stop_requested && options.stop_requested()) throw Stopped("the fit was stopped");
      const std::size_t first = block * a_block, count = std::min(a_block, samples - first);
      for (std::size_t i = first; i < first + count; ++i)
        for (std::size_t k = 0; k < dimensions; ++k) {
          const Side& side = explained.problem().bounds[k];
          found[i][k] = side.value(side.coordinate(centre[k]) + share * (points.column(k)[i] - 0.5));
        }
      explained.coarse_sums(std::span(found).subspan(first, count), std::span(sums).subspan(first, count));
      return true;
    };
  });
  for (std::size_t i = 0; i < samples; ++i)
    if (std::isfinite(sums[i])) places.push_back({found[i], sums[i]});
  std::ranges::stable_sort(places, {}, &CoarsePlace::sum);
}

/// The best places of a coarse map of the box, and of finer ones about its best, that are not beside one
/// another; best first.
std::vector<std::vector<double>> coarse_starts(const Explained& explained, const FitOptions& options) {
  const bool film = explained.is_film();  // events are solved in lanes, and tell less
  const auto usual = [&](std::size_t asked, std::size_t of_film, std::size_t of_events) {
    return asked > 0 ? asked : film ? of_film : of_events;
  };
  const std::size_t samples = SobolPoints::whole(usual(options.coarse, 2048, 1 << 16)),
                    most = usual(options.starts, 8, 24);
  const std::size_t dimensions = explained.searched();
  if (dimensions == 0) return {{}};
  std::vector<double> middle;
  for (std::size_t k = 0; k < dimensions; ++k) middle.push_back(explained.problem().bounds[k].value(0.5));
  std::vector<CoarsePlace> places;
  map_coarsely(explained, options, SobolPoints(dimensions, samples, options.seed), middle, 1.0, places);
  // A film's sum of squares has narrow valleys, with steps where a phase appears: closer maps see into them.
  const SobolPoints fewer(dimensions, SobolPoints::whole(samples / 4), options.seed + 1);
  double finest = 1.0;
  for (const double share : {0.2, 0.05, 0.0125}) {
    if (places.empty()) return {};
    const std::vector<double> best = places[0].at;
    map_coarsely(explained, options, fewer, best, finest = share, places);
  }
  std::vector<std::vector<double>> starts;
  const auto add = [&](double beside, std::size_t up_to) {
    for (const CoarsePlace& place : places) {
      if (starts.size() == up_to) break;
      const bool is_new = std::ranges::none_of(starts, [&](const std::vector<double>& start) {
        for (std::size_t k = 0; k < dimensions; ++k) {
          const Side& side = explained.problem().bounds[k];
          if (std::abs(start[k] - place.at[k]) > beside * (side.high - side.low)) return false;
        }
        return true;
      });
      if (is_new) starts.push_back(place.at);
    }
  };
  add(0.1 * finest, (most + 1) / 2);  // beside the best
  add(0.1, most);                     // and elsewhere
  return starts;
}

/// Fits from several starts, side by side, best first; those that found nothing are left out.
std::vector<LeastSquaresFit> fits_from(const LeastSquares& problem,
                                       const std::vector<std::vector<double>>& starts,
                                       const FitOptions& options, int most_iterations,
                                       std::size_t& evaluations) {
  std::vector<LeastSquaresFit> fits(starts.size());
  parallel_for_each(starts.size(), options.threads, options.stop_requested, [&] {
    return [&](std::size_t i) {
      if (options.stop_requested && options.stop_requested()) throw Stopped("the fit was stopped");
      fits[i] = minimize(problem, starts[i], most_iterations);
      return true;
    };
  });
  for (const LeastSquaresFit& fit : fits) evaluations += fit.evaluations;
  std::erase_if(fits, [](const LeastSquaresFit& fit) { return fit.residuals.empty(); });
  std::ranges::stable_sort(fits, {}, &LeastSquaresFit::sum);
  return fits;
}

/// The best of fits from several starts. Of a film they are followed over a few of its numbers; all of them
/// decide between the best two.
LeastSquaresFit best_fit(const Explained& explained, const LeastSquares& problem,
                         std::vector<std::vector<double>> starts, const FitOptions& options,
                         std::size_t& evaluations) {
  constexpr std::size_t finalists = 2;
  constexpr int most_of_each = 30, most_of_finalists = 200;  // iterations
  if (explained.is_film()) {
    const std::vector<LeastSquaresFit> fits =
        fits_from(explained.small_problem(), starts, options, most_of_each, evaluations);
    starts.clear();
    for (const LeastSquaresFit& fit : fits)
      if (starts.size() < finalists && (starts.empty() || fit.at != starts.front())) starts.push_back(fit.at);
  }
  std::vector<LeastSquaresFit> fits = fits_from(problem, starts, options, most_of_finalists, evaluations);
  return fits.empty() ? LeastSquaresFit{} : std::move(fits.front());
}

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
    std::vector<double> whole(jacobian.empty() ? 0 : residuals.size() * columns);
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

/// The ends of where the sum of squares stays within `allowed` of its least: by steps from the best outwards,
/// and bisection where that ends.
std::pair<double, double> profile(const LeastSquares& problem, const LeastSquaresFit& best, std::size_t k,
                                  double allowed) {
  constexpr int steps = 8, halvings = 6;
  const Side& side = problem.bounds[k];
  std::array<double, 2> ends{best.at[k], best.at[k]};
  for (const int way : {-1, 1}) {
    std::vector<double> at = best.at;
    const double bound = way < 0 ? side.low : side.high;
    double& end = ends[way < 0 ? 0 : 1];
    const auto holds = [&](double value) {
      const LeastSquaresFit fit = with_one_held(problem, at, k, value);
      if (!(fit.sum <= best.sum + allowed)) return false;
      end = value, at = fit.at;
      at.insert(at.begin() + static_cast<std::ptrdiff_t>(k), value);
      return true;
    };
    double beyond = bound;
    int step = 1;
    while (step <= steps && holds(beyond = best.at[k] + (bound - best.at[k]) * step / steps)) ++step;
    for (int halving = 0; step <= steps && halving < halvings; ++halving)
      if (const double middle = 0.5 * (end + beyond); !holds(middle)) beyond = middle;
  }
  return {ends[0], ends[1]};
}

/// Standard errors, correlations, and what the data do not tell.
void tell_uncertainty(const LeastSquares& problem, const LeastSquaresFit& best, double variance,
                      ModelFit& told) {
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
    if (!parameter.identified || parameter.at_bound)
      std::tie(parameter.low, parameter.high) = profile(problem, best, k, variance);
    for (std::size_t j = 0; j < told.parameters.size(); ++j) {
      const auto l = static_cast<Eigen::Index>(j);
      told.correlations.push_back(covariance(i, l) / std::sqrt(covariance(i, i) * covariance(l, l)));
    }
  }
}

/// Nothing given is ignored without a word.
void refuse_what_has_no_use(const Spec& spec) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(
        fmt::format("{}: {} has no effect in a fit; allowed: [scene], [design], and the default [numerics]",
                    origin_of(spec), what));
  };
  if (!spec.goals.empty() || !spec.maximize.empty() || !spec.minimize.empty()) refuse("[goal]");
  if (!spec.scatter.spreads.empty()) refuse("[scatter]");
  if (!spec.points.empty() || !spec.list.columns.empty()) refuse("design.points");
  if (!spec.output.fields.empty() || !spec.output.gradients.empty()) refuse("[output]");
  if (resolved_method(spec.numerics) != "exact") refuse("a method other than \"exact\"");
}

/// Times of a film later than the landing of the last jump that the model follows.
std::size_t times_after_landing(std::span<const Observation> observations, const Outcome& outcome,
                                double release) {
  const bool first = outcome.later_jumps.empty();
  const double landing = first ? outcome.jump_time + outcome.flight_time
                               : outcome.later_jumps.back().time + outcome.later_jumps.back().flight_time;
  std::size_t count = 0;
  for (std::size_t i = 0; i < observations.size(); ++i)
    count += observations[i].t - release > landing && (i == 0 || observations[i].t > observations[i - 1].t);
  return count;
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

/// Huber's loss: residuals up to so many standard errors count by their squares, larger ones by their size.
constexpr double huber_limit = 1.345;

/// The standard deviation of residuals most of which are normal.
double robust_deviation(std::span<const double> residuals) {
  std::vector<double> sizes;
  for (const double residual : residuals) sizes.push_back(std::abs(residual));
  std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2));
  constexpr double of_normal = 0.6745;
  return std::max(sizes[sizes.size() / 2] / of_normal, 1e-12);
}

/// The residuals, the large ones cut to what counts of them.
std::vector<double> limited(std::span<const double> residuals, double deviation) {
  std::vector<double> limited;
  for (const double residual : residuals)
    limited.push_back(std::clamp(residual, -huber_limit * deviation, huber_limit * deviation));
  return limited;
}

/// A fit with Huber's loss, from one of least squares: by weights until they stay as they are.
LeastSquaresFit robust_fit(const LeastSquares& problem, LeastSquaresFit best, std::size_t& evaluations) {
  constexpr int most_rounds = 30;
  for (int round = 0; round < most_rounds; ++round) {
    const double deviation = robust_deviation(best.residuals);
    std::vector<double> weights;
    for (const double residual : best.residuals)
      weights.push_back(
          std::sqrt(std::min(1.0, huber_limit * deviation / std::max(std::abs(residual), 1e-300))));
    LeastSquares weighted{.bounds = problem.bounds, .residuals = problem.residuals, .evaluate = {}};
    weighted.evaluate = [&](std::span<const double> at, std::span<double> residuals,
                            std::span<double> jacobian) {
      if (!problem.evaluate(at, residuals, jacobian)) return false;
      for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] *= weights[i];
      for (std::size_t i = 0; i < jacobian.size(); ++i) jacobian[i] *= weights[i / problem.bounds.size()];
      return true;
    };
    const LeastSquaresFit next = minimize(weighted, best.at);
    evaluations += next.evaluations;
    if (next.residuals.empty()) return best;
    double moved = 0.0;
    for (std::size_t k = 0; k < next.at.size(); ++k)
      moved = std::max(moved,
                       std::abs(next.at[k] - best.at[k]) / (problem.bounds[k].high - problem.bounds[k].low));
    best.at = next.at;
    if (!problem.evaluate(best.at, best.residuals, best.jacobian)) return best;
    constexpr double still = 1e-9;
    if (moved < still) break;
  }
  best.sum = sum_of_squares(best.residuals);
  return best;
}

/// A model's fit, and what its information needs.
struct Fitted {
  ModelFit told;
  double sum = 0.0;  ///< of squares of residuals over their errors, or over their unit
  bool errors_known = false;
};

/// Akaike's information, of numbers so many of which count as one.
double information_of(const Fitted& fitted, double correlation) {
  const double numbers = static_cast<double>(fitted.told.residuals.size()) / correlation,
               free = static_cast<double>(fitted.told.parameters.size());
  if (fitted.errors_known) return 2.0 * free + fitted.sum / correlation;
  return 2.0 * free + numbers * std::log(fitted.sum / (numbers * correlation));
}

/// How much of the residuals counts, and what that makes of the errors of parameters.
struct Spreading {
  double sum = 0.0;          ///< of squares that count
  double variance = 1.0;     ///< of a residual over its error
  double uncertainty = 1.0;  ///< what errors of parameters follow from
};

/// With Huber's loss the variance is that of its influence function: of residuals cut at the limit, over the
/// square of the fraction that is not cut.
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

/// What a film's residuals say of the fit: how many of its lines are independent, and whether the residuals
/// are larger than its noise.
void judge_film(const Explained& explained, std::span<const double> residuals, Spreading& spreading,
                ModelFit& told) {
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

void name_parameters(const Explained& explained, const LeastSquaresFit& best, ModelFit& told) {
  for (std::size_t k = 0; k < explained.free().size(); ++k)
    told.parameters.push_back({.name = explained.free()[k].name, .value = best.at[k]});
  for (std::size_t k = 0; k < explained.camera().size(); ++k)
    if (const CameraNumber& number = *explained.camera()[k].number; !number.unit.empty())
      told.parameters.push_back(
          {.name = std::string(number.name), .value = best.at[explained.free().size() + k]});
}

Fitted fit_model(const Measurements& measured, const Spec& spec, Friction friction,
                 const FitOptions& options) {
  const Explained explained(measured, spec, friction, options.free);
  LeastSquares problem = explained.problem();
  problem.evaluate = [&](std::span<const double> at, std::span<double> residuals,
                         std::span<double> jacobian) {
    if (options.stop_requested && options.stop_requested()) throw Stopped("the fit was stopped");
    return explained.problem().evaluate(at, residuals, jacobian);
  };
  const bool known = explained.errors_known();
  if (problem.residuals < problem.bounds.size() + (known ? 0 : 1))
    throw InputError(
        fmt::format("{}: {} numbers for {} free parameters{}; allowed: {}", measured.origin,
                    problem.residuals, problem.bounds.size(), known ? "" : " and an unknown error",
                    known ? "at least one number for each free parameter" : "more numbers, or --error"));
  Fitted fitted{.told = {.scene = explained.scene()}, .errors_known = known};
  ModelFit& told = fitted.told;
  const auto starts = coarse_starts(explained, options);
  told.starts = starts.size();
  if (starts.empty()) return fitted;
  std::vector<std::vector<double>> whole;
  for (const auto& start : starts) whole.push_back(explained.with_camera(start));
  LeastSquaresFit best = best_fit(explained, problem, whole, options, told.evaluations);
  if (best.residuals.empty()) return fitted;
  if (options.loss == Loss::huber) best = robust_fit(problem, std::move(best), told.evaluations);
  told.found = true;
  told.design = explained.design_at(best.at), told.camera = explained.camera_at(best.at);
  told.outcome = solve(told.design, told.scene);
  const auto numbers = static_cast<double>(problem.residuals);
  told.degrees = problem.residuals - problem.bounds.size();
  Spreading spreading = spreading_of(best.residuals, told.degrees, known, options.loss);
  fitted.sum = spreading.sum;
  told.chi_square = known ? spreading.sum : static_cast<double>(told.degrees);
  if (explained.is_film()) {
    told.after_landing = times_after_landing(explained.observations(), told.outcome, told.camera.time_offset);
    judge_film(explained, best.residuals, spreading, told);
  }
  name_parameters(explained, best, told);
  tell_uncertainty(problem, best, spreading.uncertainty, told);
  if (known) {
    // A true model passes through as many numbers as it has free parameters, but those at their bounds.
    const auto held =
        static_cast<double>(std::ranges::count(told.parameters, true, &FittedParameter::at_bound));
    const double freedom = numbers - static_cast<double>(problem.bounds.size()) + held;
    told.probability = gsl_cdf_chisq_Q(spreading.sum, std::max(freedom, 1.0));
  }
  told.model = explained.model_at(best.residuals);
  const double deviation = robust_deviation(best.residuals);
  constexpr double bad = 4.0;  // deviations: one of 16,000 normal residuals
  for (std::size_t i = 0; i < best.residuals.size(); ++i) {
    told.residuals.push_back(best.residuals[i] * (explained.is_film() ? explained.error_of(i) : 1.0));
    if (options.loss == Loss::huber && std::abs(best.residuals[i]) > bad * deviation)
      told.outliers.push_back(i);
  }
  return fitted;
}

}  // namespace

std::vector<std::string> parameters_among(const std::vector<std::string>& names) {
  std::vector<std::string> parameters;
  std::ranges::copy_if(names, std::back_inserter(parameters),
                       [](const std::string& name) { return !find_camera_number(name); });
  return parameters;
}

FitReport fit(const Measurements& measured, const Spec& spec, const FitOptions& asked) {
  const auto begin = std::chrono::steady_clock::now();
  FitOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  const StopScope scope(options.stop_requested);
  refuse_what_has_no_use(spec);
  check_measurements(measured, spec);
  if (options.loss != Loss::squares && !measured.events.empty())
    throw InputError(measured.origin + ": holds events; a loss has no effect on them; allowed: with a film");
  FitReport report;
  std::vector<Fitted> fits;
  std::size_t refused = 0;
  for (const Friction friction : options.models) {
    try {
      fits.push_back(fit_model(measured, spec, friction, options));
    } catch (const InputError& error) {  // the other model may have fewer free parameters
      if (++refused == options.models.size()) throw;
      ModelFit& without = fits.emplace_back().told;
      without.scene = spec.scene, without.scene.friction = friction, without.why = error.what();
    }
  }
  // Of one film there are as many independent numbers whichever model: as many as the better one leaves.
  double correlation = HUGE_VAL;
  for (const Fitted& one : fits)
    if (one.told.found) correlation = std::min(correlation, one.told.correlation);
  for (Fitted& one : fits) {
    if (one.told.found) one.told.information = information_of(one, correlation);
    report.models.push_back(std::move(one.told));
  }
  std::ranges::stable_sort(report.models, {}, &ModelFit::information);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

}  // namespace leapmap
