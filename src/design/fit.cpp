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
  const std::size_t samples = points.samples(), dimensions = explained.free().size();
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
  const std::size_t samples = SobolPoints::whole(usual(options.coarse, 4096, 1 << 16)),
                    most = usual(options.starts, 8, 24);
  const std::size_t dimensions = explained.free().size();
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

/// The best of fits from several starts, side by side.
LeastSquaresFit best_fit(const LeastSquares& problem, const std::vector<std::vector<double>>& starts,
                         const FitOptions& options, std::size_t& evaluations) {
  std::vector<LeastSquaresFit> fits(starts.size());
  parallel_for_each(starts.size(), options.threads, options.stop_requested, [&] {
    return [&](std::size_t i) {
      if (options.stop_requested && options.stop_requested()) throw Stopped("the fit was stopped");
      fits[i] = minimize(problem, starts[i]);
      return true;
    };
  });
  for (const LeastSquaresFit& fit : fits) evaluations += fit.evaluations;
  return *std::ranges::min_element(fits, {}, &LeastSquaresFit::sum);
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

/// Lines later than the landing of the last jump that the model follows.
std::size_t lines_after_landing(const Measurements& measured, const Outcome& outcome) {
  const bool first = outcome.later_jumps.empty();
  const double landing = first ? outcome.jump_time + outcome.flight_time
                               : outcome.later_jumps.back().time + outcome.later_jumps.back().flight_time;
  return static_cast<std::size_t>(
      std::ranges::count_if(measured.film.t, [&](double t) { return t > landing; }));
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

Fitted fit_model(const Measurements& measured, const Spec& spec, Friction friction,
                 const FitOptions& options) {
  const Explained explained(measured, spec, friction);
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
  for (const auto& start : starts) whole.push_back(explained.with_origin(start));
  const LeastSquaresFit best = best_fit(problem, whole, options, told.evaluations);
  if (best.residuals.empty()) return fitted;
  told.found = true;
  told.design = explained.design_at(best.at);
  told.outcome = solve(told.design, told.scene);
  told.after_landing = lines_after_landing(measured, told.outcome);
  const auto numbers = static_cast<double>(problem.residuals);
  told.degrees = problem.residuals - problem.bounds.size();
  // Where nobody says how good the numbers are, the residuals do; those of numbers without any error by a
  // rounding.
  constexpr double rounding = 1e-20;
  fitted.sum = known ? best.sum : std::max(best.sum, rounding * numbers);
  const double variance = known ? 1.0 : fitted.sum / static_cast<double>(told.degrees);
  double uncertainty = variance;  // what errors of parameters are told by
  if (explained.is_film()) {
    const std::size_t columns = problem.residuals / measured.film.t.size();
    const Correlation correlation = correlation_of(best.residuals, columns, problem.bounds.size());
    told.correlation = correlation.lines;
    told.independent =
        std::min(static_cast<double>(measured.film.t.size()) / correlation.lines, correlation.carrying);
    if (correlation.lines > 1.0) uncertainty = std::max(variance, correlation.variance);
  }
  told.chi_square = known ? best.sum : static_cast<double>(told.degrees);
  told.error = std::sqrt(best.sum / numbers) * explained.unit_error();
  constexpr double least_scatter = 1e-6;  // of numbers without noise no more is asked than six digits
  const double scatter = explained.is_film() && !known ? scatter_of(measured.film) : nan;
  if (!std::isnan(scatter)) told.misfit = told.error / std::max(scatter, least_scatter);
  told.judged = known || !std::isnan(scatter);
  for (std::size_t k = 0; k < explained.free().size(); ++k)
    told.parameters.push_back({.name = explained.free()[k].name, .value = best.at[k]});
  tell_uncertainty(problem, best, uncertainty, told);
  if (known) {
    // A true model passes through as many numbers as it has free parameters, but those at their bounds.
    const auto held =
        static_cast<double>(std::ranges::count(told.parameters, true, &FittedParameter::at_bound));
    const double freedom = numbers - static_cast<double>(problem.bounds.size()) + held;
    told.probability = gsl_cdf_chisq_Q(best.sum, std::max(freedom, 1.0));
  }
  told.model = explained.model_at(best.residuals);
  for (const double residual : best.residuals) told.residuals.push_back(residual / std::sqrt(variance));
  return fitted;
}

}  // namespace

FitReport fit(const Measurements& measured, const Spec& spec, const FitOptions& asked) {
  const auto begin = std::chrono::steady_clock::now();
  FitOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  const StopScope scope(options.stop_requested);
  refuse_what_has_no_use(spec);
  check_measurements(measured, spec);
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
