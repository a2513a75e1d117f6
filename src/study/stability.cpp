// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stability.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "physics/rolling.hpp"
#include "trajectory/exact.hpp"

namespace leapmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double most_error = 0.05;

Outcome true_outcome(const StabilitySubject& subject) {
  Outcome outcome;
  ExactSolver<long double>(1e-18).solve({&subject.design, 1}, subject.scene, {&outcome, 1});
  return outcome;
}

/// The largest of the errors of height, absolute, and of both times, relative. Of outcomes with the same
/// flags.
double error_of(const Outcome& ours, const Outcome& right) {
  double error = 0.0;
  const auto worsen = [&](double by) { error = by > error || std::isnan(by) ? by : error; };
  if (right.candidates > 0) worsen(std::abs(ours.first_jump_time / right.first_jump_time - 1.0));
  if (right.status == Status::jumped) {
    worsen(std::abs(ours.jump_height - right.jump_height));
    worsen(std::abs(ours.jump_time / right.jump_time - 1.0));
  }
  return error;
}

/// What can be expected of any method at a subject.
struct Truth {
  Outcome outcome;
  double condition = 0.0;
  bool decided = true;
};

/// Moves every input by some ulps up and down and looks how far the answer moves.
Truth truth_of(const StabilitySubject& subject) {
  constexpr int ulps = 4;
  Truth truth{true_outcome(subject)};
  for (double Design::*input : {&Design::slope, &Design::mass_ratio, &Design::offset_ratio,
                                &Design::inertia_factor, &Design::release_angle, &Design::release_spin}) {
    double worst = 0.0;
    for (const double direction : {-1.0, 1.0}) {
      StabilitySubject moved = subject;
      double& value = moved.design.*input;
      if (value == 0.0 || (input == &Design::offset_ratio && value * direction == 1.0)) continue;
      for (int i = 0; i < ulps; ++i) value = std::nextafter(value, direction * HUGE_VAL);
      const Outcome there = true_outcome(moved);
      if (!same_flags(there, truth.outcome)) {
        truth.decided = false;
        continue;
      }
      const double change = std::abs(value / subject.design.*input - 1.0);
      worst = std::max(worst, error_of(there, truth.outcome) / change);
    }
    truth.condition += worst;
  }
  return truth;
}

double energy_drift(const Design& design, const Outcome& outcome) {
  if (outcome.status != Status::jumped) return nan;
  const Hoop<double> hoop = derive<double>(design);
  const double kinetic = kinetic_energy(hoop, trig(outcome.jump_angle), outcome.jump_spin);
  const double drift = rolling_energy(hoop, outcome.jump_angle, outcome.jump_spin) -
                       rolling_energy(hoop, design.release_angle, design.release_spin);
  return std::abs(drift) / (1.0 + kinetic);
}

Finding finding_of(const Outcome& ours, const Truth& truth, double error) {
  if (!truth.decided) return Finding::undecided;
  if (ours.status == Status::failed) return Finding::failed;
  if (!same_flags(ours, truth.outcome)) return Finding::wrong;
  if (error <= std::max(1e-6, 100.0 * epsilon * (1.0 + truth.condition))) return Finding::fine;
  return error <= most_error ? Finding::lossy : Finding::wrong;
}

}  // namespace

std::string_view name_of(Finding finding) {
  constexpr std::array<std::string_view, 5> names{"fine", "undecided", "lossy", "failed", "wrong"};
  return names[static_cast<std::size_t>(finding)];
}

std::string_view verdict_of(std::span<const Finding> findings) {
  const auto any = [&](Finding finding) { return std::ranges::find(findings, finding) != findings.end(); };
  if (any(Finding::wrong)) return "wrong without a word";
  if (any(Finding::failed))
    return any(Finding::fine) || any(Finding::lossy) ? "gives up honestly" : "breaks down";
  if (any(Finding::lossy)) return "loses digits";
  return any(Finding::fine) ? "fine" : "undecided";
}

std::vector<StabilityRow> run_case(const StabilityCase& stability_case,
                                   const std::function<bool()>& stop_requested) {
  using Clock = std::chrono::steady_clock;
  std::vector<Truth> truths;
  for (const StabilitySubject& subject : stability_case.subjects) {
    if (stop_requested && stop_requested()) return {};
    truths.push_back(truth_of(subject));
  }

  std::vector<StabilityRow> rows;
  for (const Contestant& contestant : stability_case.contestants) {
    for (std::size_t i = 0; i < truths.size(); ++i) {
      if (stop_requested && stop_requested()) return rows;
      const StabilitySubject& subject = stability_case.subjects[i];
      const Solving solving = make_solving(contestant, subject.scene, stability_case.max_steps);
      Outcome outcome;
      const auto begin = Clock::now();
      solving.solve({&subject.design, 1}, {&outcome, 1});
      const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
      const double error =
          same_flags(outcome, truths[i].outcome) ? error_of(outcome, truths[i].outcome) : nan;
      rows.push_back({stability_case.name, stability_case.abscissa, contestant.method,
                      contestant.fixed_step ? "step" : "tolerance", contestant.setting,
                      stability_case.walks_settings ? contestant.setting : subject.x, error,
                      energy_drift(subject.design, outcome), truths[i].condition,
                      solving.evaluations ? static_cast<double>(solving.evaluations()) : nan, seconds,
                      outcome.failure ? outcome.failure : "", finding_of(outcome, truths[i], error)});
    }
  }
  return rows;
}

}  // namespace leapmap
