// SPDX-License-Identifier: GPL-3.0-or-later
/// The walks into trouble, as data.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "model/model.hpp"
#include "noslip/exact.hpp"
#include "numerics/game_steppers.hpp"
#include "numerics/gsl_integrator.hpp"
#include "study/precision.hpp"
#include "study/stability.hpp"

namespace leapmap {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double usual_tolerance = 1e-10, usual_step = 0x1p-6;

Contestant by_exact(double tolerance) {
  return {"exact", false, tolerance, 0, RollingModel::energy_integral};
}

/// A mass on the rim of an ever lighter hoop rolls through phi = 0, where the inertia about the contact is 2
/// m R^2: the spin has a needle there, of width about 1 / sqrt(mass ratio).
StabilityCase needle(bool quick) {
  StabilityCase needle{"needle", "mass ratio", {}, usual_contestants(Friction::sticking)};
  for (int decade = 0; decade <= 9; decade += quick ? 3 : 1) {
    StabilitySubject subject{std::pow(10.0, decade), {}, {.runway = 2.0, .hop_height = 0.02}};
    subject.design.mass_ratio = subject.x;
    subject.design.release_angle = -1.45;  // from where it comes down to phi = 0 and gets past it
    needle.subjects.push_back(subject);
  }
  return needle;
}

/// The unstable equilibrium has the centre of mass straight above the contact: sin(theta) = rho sin(theta +
/// phi).
StabilityCase release(bool quick) {
  StabilityCase release{
      "release", "distance from the unstable equilibrium [rad]", {}, usual_contestants(Friction::sticking)};
  for (int decade = 1; decade <= 12; decade += quick ? 4 : 1) {
    StabilitySubject subject{std::pow(10.0, -decade), {}, {}};
    const Hoop<long double> hoop = reduce<long double>(subject.design);
    const long double equilibrium =
        std::numbers::pi_v<long double> - slope_of(hoop) - std::asin(hoop.sin_slope / hoop.rho);
    subject.design.release_angle = static_cast<double>(equilibrium + subject.x);
    release.subjects.push_back(subject);
  }
  return release;
}

/// Flat plane, a thin hoop with its mass on the rim and on top, pushed with spin w: where w^2 = sqrt(27 (1 -
/// rho) / (1 + rho)) - 1 the normal force touches zero, and beyond it a pair of lift-off and return is born.
/// From rest (w = 0) that is at mass ratio 13, at cos = -5/13 from the top.
StabilityCase graze(bool quick) {
  StabilityCase graze{
      "graze", "mass ratio beyond the fold, relative", {}, usual_contestants(Friction::sticking)};
  constexpr double spin = 0.01;
  constexpr double q = (1.0 + spin * spin) * (1.0 + spin * spin);
  constexpr double fold = (27.0 - q) / (2.0 * q);
  for (int decade = 1; decade <= 15; decade += quick ? 4 : 1)
    for (const double side : {-1.0, 1.0}) {
      StabilitySubject subject{side * std::pow(10.0, -decade), {}, {.runway = 0.9}};
      subject.design.slope = 0.0;
      subject.design.mass_ratio = fold * (1.0 + subject.x);
      subject.design.release_spin = spin;
      graze.subjects.push_back(subject);
    }
  return graze;
}

/// So slight a slope that the hoop is fast enough to jump only after many turns, as many as exact counts.
StabilityCase long_run(bool quick) {
  StabilityCase long_run{"long", "revolutions rolled to the jump", {}, usual_contestants(Friction::sticking)};
  long_run.max_steps = 5'000'000;  // the longest run takes some 3.2 million of the usual fixed steps
  for (const double turns : {1.0, 10.0, 100.0, 1000.0, 10000.0}) {
    if (quick && turns > 100.0) break;
    StabilitySubject subject{turns, {}, {.runway = 3.0 * turns + 2.0}};
    subject.design.slope = 0.2 / turns;
    subject.design.mass_ratio = 3.0;
    subject.design.release_spin = 0.5;
    Outcome outcome;
    ExactSolver<double>(usual_tolerance).solve({&subject.design, 1}, subject.scene, {&outcome, 1});
    subject.x = (outcome.jump_angle - subject.design.release_angle) / (2.0 * pi);
    long_run.subjects.push_back(subject);
  }
  return long_run;
}

std::vector<StabilitySubject> random_subjects(std::size_t count) {
  std::vector<StabilitySubject> subjects;
  for (const Design& design : random_designs(count, 5)) subjects.push_back({0.0, design, {.runway = 4.0}});
  subjects.push_back({0.0, {}, {}});  // the paper's hoop
  return subjects;
}

/// Fixed steps from a sixteenth to two sqrt(R/g), in which the hoops turn by a quarter revolution and more.
StabilityCase long_steps(bool quick) {
  StabilityCase steps{"step", "step [sqrt(R/g)]", random_subjects(quick ? 4 : 20), {}, true};
  for (const auto& steppers : {gsl_steppers(), game_steppers()})
    for (const GslStepper& stepper : steppers)
      for (int half_octave = -8; half_octave <= 2; half_octave += quick ? 4 : 1)
        if (stepper.order > 0)
          steps.contestants.push_back(
              {std::string(stepper.name), true, std::pow(2.0, 0.5 * half_octave), stepper.order});
  return steps;
}

StabilityCase unreachable_tolerances(bool quick) {
  StabilityCase tolerances{"tolerance", "tolerance", random_subjects(quick ? 1 : 5), {}, true};
  if (quick) tolerances.max_steps = 20'000;
  for (const double tolerance : {1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 1e-18, 1e-30})
    tolerances.contestants.push_back(by_exact(tolerance));
  for (const GslStepper& stepper : gsl_steppers())
    for (const double tolerance : {1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 1e-18, 1e-30})
      tolerances.contestants.push_back({std::string(stepper.name), false, tolerance});
  return tolerances;
}

/// Jump after jump of a hoop with no stable gait: errors grow by a factor from each landing to the next.
StabilityCase chaos(bool quick) {
  StabilityCase chaos{"chaos", "jumps", {}, usual_contestants(Friction::sticking)};
  for (const long jumps : {1, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 24, 28}) {
    if (quick && jumps != 1 && jumps != 8 && jumps != 16) continue;
    StabilitySubject subject{static_cast<double>(jumps),
                             {.slope = 0.6, .mass_ratio = 8.0, .offset_ratio = 0.9},
                             {.runway = 1000.0}};
    subject.scene.jumps = jumps;
    chaos.subjects.push_back(subject);
  }
  return chaos;
}

}  // namespace

std::vector<Contestant> usual_contestants(Friction friction) {
  const bool slips = model_of(friction).slips;
  std::vector<Contestant> contestants{by_exact(usual_tolerance)};
  for (const GslStepper& stepper : gsl_steppers())
    contestants.push_back({std::string(stepper.name), false, usual_tolerance});
  const auto add_fixed = [&](const GslStepper& stepper) {
    contestants.push_back({std::string(stepper.name), true, usual_step, stepper.order});
  };
  if (!slips) std::ranges::for_each(game_steppers(), add_fixed);
  add_fixed(*find_gsl_stepper("gsl-rk4"));
  if (!slips) add_fixed(*find_gsl_stepper("gsl-rk2imp"));
  return contestants;
}

std::vector<NamedCase> stability_cases() {
  std::vector<NamedCase> cases{{"needle", needle},   {"release", release},
                               {"graze", graze},     {"long", long_run},
                               {"step", long_steps}, {"tolerance", unreachable_tolerances},
                               {"chaos", chaos}};
  std::ranges::copy(friction_cases(), std::back_inserter(cases));
  return cases;
}

StabilityCase stability_case(const NamedCase& named, const StabilityOptions& options) {
  StabilityCase made = named.make(options.quick);
  if (options.quick) made.max_steps = std::min(made.max_steps, 20'000l);
  return made;
}

}  // namespace leapmap
