// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stability.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "hoop/rolling.hpp"
#include "model/model.hpp"
#include "numerics/nan.hpp"
#include "study/truth.hpp"

namespace leapmap {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double most_error = 0.05;

/// What can be expected of any method at a subject.
struct Expected {
  Truth truth;
  double condition = 0.0;
  bool decided = true;
};

/// Moves every input by some ulps up and down and looks how far the answer moves. With friction a design goes
/// through several phases, each with roundings of its own.
Expected expected_of(const StabilitySubject& subject) {
  const int ulps = model_of(subject.scene).slips ? 100 : 4;
  Expected expected{truths_of({&subject.design, 1}, subject.scene)[0]};
  const Outcome right = refined_outcome(subject.design, subject.scene);
  for (double Design::*input : inputs_of(subject.scene.friction)) {
    double worst = 0.0;
    for (const double direction : {-1.0, 1.0}) {
      Design moved = subject.design;
      double& value = moved.*input;
      const bool at_most = input == &Design::offset_ratio && value * direction == 1.0;
      if (value == 0.0 || std::isnan(value) || at_most) continue;
      for (int i = 0; i < ulps; ++i) value = std::nextafter(value, direction * HUGE_VAL);
      const Outcome there = refined_outcome(moved, subject.scene);
      if (!same_course(there, right)) {
        expected.decided = false;
        continue;
      }
      const double change = std::abs(value / subject.design.*input - 1.0);
      worst = std::max(worst, error_of(there, right) / change);
    }
    expected.condition += worst;
  }
  // What so many ulps move by more than that no method in double can be asked for.
  if (ulps * epsilon * expected.condition > most_error) expected.decided = false;
  if (expected.truth.witness == Witness::integration) expected.condition = nan;  // not known by long double
  return expected;
}

double energy_drift(const Design& design, const Outcome& outcome) {
  if (outcome.status != Status::jumped) return nan;
  const Hoop<double> hoop = reduce<double>(design);
  const double kinetic = kinetic_energy(hoop, trig(outcome.jump_angle), outcome.jump_spin);
  const double drift = rolling_energy(hoop, outcome.jump_angle, outcome.jump_spin) -
                       rolling_energy(hoop, design.release_angle, design.release_spin);
  return std::abs(drift) / (1.0 + kinetic);
}

/// The error that a contestant was asked for: its tolerance, as far as doubles go. A fixed step asks for
/// none.
double asked_of(const Contestant& contestant) {
  constexpr double finest = 1e-12, of_a_step = 1e-6;
  return contestant.fixed_step ? of_a_step : std::max(contestant.setting, finest);
}

Finding finding_of(const Outcome& ours, const Expected& expected, double error, double asked) {
  if (!expected.decided) return Finding::undecided;
  if (ours.status == Status::failed) return Finding::failed;
  if (!same_course(ours, expected.truth.outcome)) return Finding::wrong;
  if (error <= std::max(asked, 100.0 * epsilon * (1.0 + expected.condition))) return Finding::fine;
  return error <= most_error ? Finding::lossy : Finding::wrong;
}

}  // namespace

std::string_view name_of(Finding finding) {
  constexpr std::array<std::string_view, 5> names{"fine", "undecided", "lossy", "failed", "wrong"};
  return names[static_cast<std::size_t>(finding)];
}

std::string_view verdict_of(std::span<const Finding> findings) {
  const auto any = [&](Finding finding) { return std::ranges::find(findings, finding) != findings.end(); };
  if (any(Finding::wrong)) return "silently wrong";
  if (any(Finding::failed))
    return any(Finding::fine) || any(Finding::lossy) ? "reports failure" : "breaks down";
  if (any(Finding::lossy)) return "loses digits";
  return any(Finding::fine) ? "fine" : "undecided";
}

std::vector<StabilityRow> run_case(const StabilityCase& stability_case,
                                   const std::function<bool()>& stop_requested) {
  using Clock = std::chrono::steady_clock;
  std::vector<Expected> expected;
  for (const StabilitySubject& subject : stability_case.subjects) {
    if (stop_requested && stop_requested()) return {};
    expected.push_back(expected_of(subject));
  }

  std::vector<StabilityRow> rows;
  for (const Contestant& contestant : stability_case.contestants) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (stop_requested && stop_requested()) return rows;
      const StabilitySubject& subject = stability_case.subjects[i];
      const Solving solving =
          model_of(subject.scene).solving(contestant, subject.scene, stability_case.max_steps);
      Outcome outcome;
      const auto begin = Clock::now();
      solving.solve({&subject.design, 1}, {&outcome, 1});
      const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
      const double error = same_course(outcome, expected[i].truth.outcome)
                               ? error_of(outcome, expected[i].truth.outcome)
                               : nan;
      rows.push_back(
          {stability_case.name, stability_case.abscissa, contestant.method,
           contestant.fixed_step ? "step" : "tolerance", contestant.setting,
           stability_case.walks_settings ? contestant.setting : subject.x, error,
           model_of(subject.scene).slips ? nan : energy_drift(subject.design, outcome), expected[i].condition,
           solving.evaluations ? static_cast<double>(solving.evaluations()) : nan, seconds,
           outcome.failure ? outcome.failure : "",
           finding_of(outcome, expected[i], error, asked_of(contestant)), expected[i].truth.witness});
    }
  }
  return rows;
}

}  // namespace leapmap
