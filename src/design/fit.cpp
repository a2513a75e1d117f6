// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/fit.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "design/explained.hpp"
#include "design/fit_errors.hpp"
#include "design/fit_starts.hpp"
#include "engine/parallel.hpp"
#include "leapmap/solve.hpp"
#include "spec/options.hpp"
#include "spec/spec.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

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
  Numerics usual = spec.numerics;
  usual.method = "auto";
  if (resolved_method(spec) != resolved_method(usual, spec.scene)) refuse("a method other than \"exact\"");
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
    judge_film(explained, best.residuals, options.loss, spreading, told);
  }
  name_parameters(explained, best, told);
  tell_uncertainty(problem, best, spreading.uncertainty, options, told);
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
