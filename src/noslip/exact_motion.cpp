// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion without slip and without an integrator.
#include <numbers>

#include "hoop/flight_search.hpp"
#include "hoop/units.hpp"
#include "noslip/exact.hpp"
#include "noslip/model.hpp"
#include "noslip/rolling_motion.hpp"

namespace leapmap::noslip {
namespace {

/// From one end of a leg to the other, as seen on it (hoop/parameters.hpp).
struct Leg {
  double way;
  Roll<double> roll;
  double begin;  ///< its time [sqrt(R/g)]
};

std::vector<Leg> legs_of(const ContactState<double>& from, const Hoop<double>& hoop,
                         const std::vector<double>& turns, const RollingTime<double>& time) {
  double way = way_of(hoop, from.angle, from.spin);
  std::vector<Leg> legs{{way, begin_roll(seen(hoop, way), way * from.angle, way * from.spin), from.time}};
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
std::vector<Candidate> candidates_of(const std::vector<Leg>& legs, const FoundLiftOffs& told,
                                     const Outcome& outcome, const Scene& scene,
                                     const RollingTime<double>& time) {
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
    candidates.push_back(in_si(lift_off, fly(seen(leg.roll.hoop, leg.way), lift_off), scene));
    candidates.back().is_jump = false;
  }
  if (!candidates.empty()) {
    candidates.front().t = outcome.first_jump_time;
    candidates.front().height = outcome.first_jump_height;
  }
  if (outcome.status == Status::jumped) {
    Candidate& jump = candidates.back();
    jump.t = outcome.jump_time, jump.height = outcome.jump_height, jump.is_jump = true;
    jump.apex_time = outcome.apex_time, jump.flight_time = outcome.flight_time, jump.dip = outcome.dip;
  }
  return candidates;
}

/// Whether the hoop rolls before it jumps or its search ends; else it leaves where it landed.
bool rolls_before(const Outcome& outcome, const FoundLiftOffs& found) {
  return outcome.status != Status::jumped || !found.bounces || found.lift_offs.size() > 1;
}

/// Where a hoop jumps; second: the solvers' unit of time.
ContactState<double> lift_off_of(const Outcome& outcome, double second) {
  return {.time = outcome.jump_time / second,
          .travel = outcome.jump_distance,
          .angle = outcome.jump_angle,
          .spin = outcome.jump_spin};
}

/// Tells the ways to jumps, one after the other, of one design.
class Teller {
 public:
  Teller(const Design& design, const Scene& scene, double tolerance, double interval, Motion& motion)
      : design_(design),
        scene_(scene),
        hoop_(reduce<double>(design, scene)),
        second_(time_unit(scene)),
        samples_(interval > 0.0),
        solver_(tolerance),
        time_(tolerance),
        sampled_(hoop_, interval / second_, motion.points),
        motion_(motion) {}

  Outcome tell(Start start, ContactState<double>& at) {
    const ContactState<double> from = at;
    FoundLiftOffs told;
    Outcome outcome;
    solver_.solve(start, {&design_, 1}, {&at, 1}, scene_, {&outcome, 1}, &told);
    const double way = way_of(hoop_, from.angle, from.spin);
    if (way == 0.0 || outcome.status == Status::airborne_at_release || outcome.status == Status::failed)
      return outcome;
    const std::vector<Leg> legs = legs_of(from, hoop_, told.turns, time_);
    for (const Candidate& candidate : candidates_of(legs, told, outcome, scene_, time_))
      motion_.candidates.push_back(candidate);

    const bool jumps = outcome.status == Status::jumped, rolls = rolls_before(outcome, told);
    const ContactState<double> lift_off = lift_off_of(outcome, second_);
    if (rolls) motion_.phases.push_back(in_si(Phase::rolling, from, 0, scene_));
    if (jumps) {
      motion_.phases.push_back(in_si(Phase::flight, lift_off, 0, scene_));
      motion_.phases.back().t = outcome.jump_time;  // to the last digit
    }
    if (!samples_) return outcome;
    if (rolls) sample(from, outcome, told.turns, legs.back().way);
    if (jumps) {
      motion_.points.push_back(rolling_point(hoop_, lift_off));
      sampled_.fly(lift_off, outcome.flight_time / second_);
    }
    motion_.end = sampled_.end() * second_;
    return outcome;
  }

 private:
  /// What it rolls, over turns on the last of which it goes `way`.
  void sample(const ContactState<double>& begin, const Outcome& outcome, const std::vector<double>& turns,
              double way) {
    ContactState<double> from = begin;
    for (const double turn : turns) {
      sampled_.roll(from, turn, true);
      from = {.time = sampled_.end(), .travel = begin.travel + (turn - begin.angle), .angle = turn};
    }
    if (hoop_.resistance != 0.0 && outcome.status == Status::stalled) return;  // it stays there
    const double end = outcome.status == Status::jumped ? outcome.jump_angle
                       : outcome.status == Status::stalled
                           ? begin.angle
                           : begin.angle - begin.travel + way * 2.0 * std::numbers::pi * scene_.runway;
    // From rest the second turn is where it set out.
    sampled_.roll(from, end, outcome.status == Status::stalled && begin.spin == 0.0);
  }

  const Design& design_;
  const Scene& scene_;
  Hoop<double> hoop_;
  double second_;
  bool samples_;
  ExactSolver<Batch> solver_;
  RollingTime<double> time_;
  RollingMotion sampled_;
  Motion& motion_;
};

}  // namespace

Outcome record(const Design& design, const Scene& scene, double tolerance, RecordedWay& recorded) {
  ExactSolver<Batch> solver(tolerance);
  const Hoop<double> hoop = reduce<double>(design, scene);
  const double second = time_unit(scene);
  recorded.holds = true;
  Outcome whole;
  Sequences<double>([&](Start start, std::span<const Design>, std::span<ContactState<double>> at,
                        std::span<Outcome> outcomes) {
    const ContactState<double> from = at[0];
    FoundLiftOffs found;
    solver.solve(start, {&design, 1}, at, scene, outcomes, &found);
    const Outcome& outcome = outcomes[0];
    recorded.end = at[0];
    if (way_of(hoop, from.angle, from.spin) == 0.0 || outcome.status == Status::airborne_at_release ||
        outcome.status == Status::failed)
      return;
    if (rolls_before(outcome, found)) recorded.phases.push_back({Phase::rolling, from, 0, found.turns});
    if (outcome.status != Status::jumped) return;
    recorded.phases.push_back({Phase::flight, lift_off_of(outcome, second), 0, {}});
    recorded.flights.push_back(
        {outcome.jump_height, outcome.apex_time / second, outcome.flight_time / second, outcome.dip});
  }).solve({&design, 1}, scene, {&whole, 1});
  return whole;
}

Motion tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval) {
  Motion motion;
  Teller teller(design, scene, tolerance, interval, motion);
  Sequences<double>([&](Start start, std::span<const Design>, std::span<ContactState<double>> at,
                        std::span<Outcome> outcome) {
    outcome[0] = teller.tell(start, at[0]);
  }).solve({&design, 1}, scene, {&motion.outcome, 1});
  to_si(motion.points, scene);
  return motion;
}

}  // namespace leapmap::noslip
