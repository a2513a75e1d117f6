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

/// From one end of a leg to the other, as seen on it (physics/parameters.hpp).
struct Leg {
  double way;
  Roll<double> roll;
  double begin;  ///< its time [sqrt(R/g)]
};

std::vector<Leg> legs_of(const Design& design, const Hoop<double>& hoop, const std::vector<double>& turns,
                         const RollingTime<double>& time) {
  double way = way_of(hoop, design.release_angle, design.release_spin);
  std::vector<Leg> legs{
      {way, begin_roll(seen(hoop, way), way * design.release_angle, way * design.release_spin), 0.0}};
  for (const double turn : turns) {
    const Leg last = legs.back();
    way = -way;
    const Roll<double> next = begin_roll(seen(hoop, way), way * turn, 0.0);
    const double length = -next.release - last.roll.release;
    legs.push_back({way, next, last.begin + time.halving_to_rest(last.roll, length)});
  }
  return legs;
}

/// Every lift-off, timed from one to the next. The jump and the first are the outcome's to the last digit.
std::vector<Candidate> candidates_of(const std::vector<Leg>& legs, const Told& told, const Outcome& outcome,
                                     const Scene& scene, const RollingTime<double>& time) {
  std::vector<Candidate> candidates;
  std::size_t on = legs.size();
  Roll<double> roll;
  double passed = 0.0;
  for (std::size_t i = 0; i < told.lift_offs.size(); ++i) {
    LiftOff<double> lift_off = told.lift_offs[i];
    const Leg& leg = legs[told.legs[i]];
    if (on != told.legs[i]) roll = leg.roll, passed = leg.begin, on = told.legs[i];
    lift_off.time = passed += time.halving(roll, leg.way * lift_off.angle);
    roll = begin_roll(leg.roll.hoop, leg.way * lift_off.angle, leg.way * lift_off.spin);
    candidates.push_back(in_si(lift_off, fly(leg.roll.hoop, lift_off), scene));
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

/// Where a way ends that has turned so often.
double end_of(const Outcome& outcome, const Design& design, const Scene& scene, double way) {
  if (outcome.status == Status::jumped) return outcome.jump_angle;
  if (outcome.status == Status::stalled) return design.release_angle;
  return design.release_angle + way * 2.0 * std::numbers::pi * scene.runway;
}

}  // namespace

Motion tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval) {
  Motion motion;
  Told told;
  ExactSolver<Batch>(tolerance).solve({&design, 1}, scene, {&motion.outcome, 1}, &told);
  const Outcome& outcome = motion.outcome;
  const Hoop<double> hoop = derive<double>(design);
  if (way_of(hoop, design.release_angle, design.release_spin) == 0.0 ||
      outcome.status == Status::airborne_at_release || outcome.status == Status::failed)
    return motion;
  const std::vector<double>& turns = told.turns;
  const RollingTime<double> time(tolerance);
  const std::vector<Leg> legs = legs_of(design, hoop, turns, time);
  motion.candidates = candidates_of(legs, told, outcome, scene, time);

  const ContactState<double> release{.angle = design.release_angle, .spin = design.release_spin};
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

  RollingMotion sampled(hoop, interval / second, motion.points);
  ContactState<double> from = release;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    sampled.roll(from, turns[k], true);
    from = {.time = sampled.end(), .travel = turns[k] - design.release_angle, .angle = turns[k]};
  }
  // From rest the second turn is at the release.
  const bool ends_at_rest = outcome.status == Status::stalled && design.release_spin == 0.0;
  sampled.roll(from, end_of(outcome, design, scene, legs.back().way), ends_at_rest);
  if (jumps) {
    motion.points.push_back(rolling_point(hoop, lift_off));
    sampled.fly(lift_off, outcome.flight_time / second);
  }
  motion.end = sampled.end() * second;
  to_si(motion.points, scene);
  return motion;
}

}  // namespace leapmap::rolling
