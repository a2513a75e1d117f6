// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion without slip and without an integrator.
#include <numbers>

#include "physics/flight_search.hpp"
#include "rolling/exact.hpp"
#include "rolling/model.hpp"
#include "rolling/rolling_motion.hpp"
#include "trajectory/units.hpp"

namespace leapmap::rolling {
namespace {

/// Every lift-off, timed from one to the next. The jump and the first are the outcome's to the last digit.
std::vector<Candidate> candidates_of(const Roll<double>& released, std::vector<LiftOff<double>> lift_offs,
                                     const Outcome& outcome, const Scene& scene, double tolerance) {
  std::vector<Candidate> candidates;
  const RollingTime<double> time(tolerance);
  Roll<double> roll = released;
  double passed = 0.0;
  for (LiftOff<double>& lift_off : lift_offs) {
    lift_off.time = passed += time.halving(roll, lift_off.angle);
    roll = begin_roll(released.hoop, lift_off.angle, lift_off.spin);
    candidates.push_back(in_si(lift_off, fly(released.hoop, lift_off), scene));
  }
  if (!candidates.empty()) {
    candidates.front().t = outcome.first_jump_time;
    candidates.front().height = outcome.first_jump_height;
  }
  if (outcome.status == Status::jumped) {
    Candidate& jump = candidates.back();
    jump.t = outcome.jump_time, jump.height = outcome.jump_height;
    jump.apex_time = outcome.apex_time, jump.flight_time = outcome.flight_time, jump.dip = outcome.dip;
  }
  return candidates;
}

}  // namespace

Motion tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval) {
  Motion motion;
  std::vector<LiftOff<double>> lift_offs;
  ExactSolver<Batch>(tolerance).solve({&design, 1}, scene, {&motion.outcome, 1}, &lift_offs);
  const Outcome& outcome = motion.outcome;
  const Hoop<double> hoop = derive<double>(design);
  const Roll<double> released = begin_roll(hoop, design.release_angle, design.release_spin);
  motion.candidates = candidates_of(released, std::move(lift_offs), outcome, scene, tolerance);

  const ContactState<double> release{.angle = design.release_angle, .spin = design.release_spin};
  if (!sets_out(hoop, design.release_angle, design.release_spin) ||
      outcome.status == Status::airborne_at_release)
    return motion;
  motion.phases.push_back(in_si(Phase::rolling, release, 0, scene));
  const double second = time_unit(scene);
  const bool jumps = outcome.status == Status::jumped;
  const ContactState<double> lift_off{.time = outcome.jump_time / second,
                                      .travel = outcome.jump_distance,
                                      .angle = outcome.jump_angle,
                                      .spin = outcome.jump_spin};
  if (jumps) {
    motion.phases.push_back(in_si(Phase::flight, lift_off, 0, scene));
    motion.phases.back().t = outcome.jump_time;  // to the last digit
  }
  if (!(interval > 0.0)) return motion;

  double end = jumps ? outcome.jump_angle : design.release_angle + 2.0 * std::numbers::pi * scene.runway;
  if (outcome.status == Status::stalled) {
    const FirstMinimum<double> least = first_minimum(released);
    end = short_of_stall(design.release_angle, stall_angle(released, least.angle, least.crest));
  }
  RollingMotion sampled(hoop, interval / second, motion.points);
  sampled.roll(release, end);
  if (jumps) {
    motion.points.push_back(rolling_point(hoop, lift_off));
    sampled.fly(lift_off, outcome.flight_time / second);
  }
  motion.end = sampled.end() * second;
  to_si(motion.points, scene);
  return motion;
}

}  // namespace leapmap::rolling
