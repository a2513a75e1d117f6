// SPDX-License-Identifier: GPL-3.0-or-later
/// A design's story without an integrator: rolling by its energy integral, whose time is inverted, sliding by
/// Picard's iteration from sample to sample, flights in closed form.
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/flight_search.hpp"
#include "physics/rolling_by_angle.hpp"
#include "trajectory/coulomb.hpp"
#include "trajectory/exact.hpp"
#include "trajectory/rolling_time.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap {
namespace {

/// Samples phase after phase.
class Motion {
 public:
  Motion(const Design& design, const Scene& scene, double interval, std::vector<TracePoint>& points)
      : hoop_(derive<double>(design)),
        friction_(contact_of<double>(design, scene).mu_kinetic),
        sampler_{interval, points} {}

  /// Rolls without slip from a state to an angle ahead, a turn at a time.
  void roll(const ContactState<double>& from, double end) {
    constexpr double turn = 2.0 * std::numbers::pi;
    const double turns = std::ceil((end - from.angle) / turn);
    ContactState<double> start = from;
    for (double k = 1.0; k <= turns; ++k) {
      const Roll<double> roll = begin_roll(hoop_, start.angle, start.spin);
      const double most = (k == turns ? end : from.angle + k * turn) - start.angle;
      const double duration = time_.halving(roll, start.angle + most);
      ContactState<double> at = start;
      sampler_.until(start.time + duration, [&](double t) {
        const double x =
            rolled_within(roll, t - start.time, at.angle - start.angle, at.spin * (t - at.time), most);
        at = rolled(roll, start, x, t);
        return rolling_point(hoop_, at);
      });
      start = rolled(roll, start, most, start.time + duration);
    }
    end_ = start.time;
  }

  void slide(const ContactState<double>& from, int direction, double end) {
    ContactState<double> at = from;
    sampler_.until(end, [&](double t) {
      if (!sliding_.advance(hoop_, friction_, at, t - at.time, direction)) at.angle = NAN;
      at.time = t;
      return sliding_point(hoop_, direction * friction_, at);
    });
    end_ = end;
  }

  void fly(const ContactState<double>& from, double flight_time) {
    sampler_.fly(hoop_, from, flight_time);
    end_ = from.time + flight_time;
  }

  double end() const { return end_; }

 private:
  ContactState<double> rolled(const Roll<double>& roll, const ContactState<double>& from, double x,
                              double time) const {
    ContactState<double> to{.time = time, .travel = from.travel + x, .angle = from.angle + x};
    const double E = std::max(vis_viva_past_release(roll, x), 0.0);
    to.spin = x > 0.0 ? std::sqrt(E / contact_inertia(hoop_, trig(to.angle))) : from.spin;
    return to;
  }

  /// How far it rolls in a time: further than `least`, by some `step`, and at most `most`. The root of t(x),
  /// whose derivative is 1 / w.
  double rolled_within(const Roll<double>& roll, double duration, double least, double step,
                       double most) const {
    if (!(duration > 0.0)) return 0.0;
    const auto time_left = [&](double x) {
      const double E = vis_viva_past_release(roll, x);
      return Sample<double>{time_.halving(roll, roll.release + x) - duration,
                            std::sqrt(contact_inertia(hoop_, trig(roll.release + x)) / E)};
    };
    // What is left of the turn may be hard to time, so that the end of the bracket is come to from below.
    double reach = std::max(1.5 * step, 1e-6 * most);
    while (least + reach < most && time_left(least + reach).value < 0.0) reach *= 2.0;
    const double resolution = 4.0 * std::numeric_limits<double>::epsilon() * (1.0 + most);
    return polish_root(time_left, least, std::min(least + reach, most * (1.0 + 1e-15)), least + step, true,
                       resolution);
  }

  Hoop<double> hoop_;
  double friction_;
  TraceSampler sampler_;
  double end_ = 0.0;
  RollingTime<double> time_{check_tolerance};
  SlidingLeg<double> sliding_{check_tolerance};
};

/// A stall is approached for ever so slowly as its energy is lost in roundings: a hair before it is enough.
double short_of_stall(double release, double stall) { return release + (stall - release) * (1.0 - 1e-9); }

/// As a sweep solves it: all but the times, which are within the tolerance, are the map's to the last digit.
Story of_rolling(const Design& design, const Scene& scene, double tolerance, double interval) {
  Story story;
  std::vector<LiftOff<double>> lift_offs;
  ExactSolver<Batch>(tolerance).solve({&design, 1}, scene, {&story.outcome, 1}, &lift_offs);
  const Outcome& outcome = story.outcome;
  const Hoop<double> hoop = derive<double>(design);
  const Roll<double> released = begin_roll(hoop, design.release_angle, design.release_spin);
  const RollingTime<double> time(tolerance);
  Roll<double> roll = released;  // on from the last lift-off
  double passed = 0.0;
  for (LiftOff<double>& lift_off : lift_offs) {
    lift_off.time = passed += time.halving(roll, lift_off.angle);
    roll = begin_roll(hoop, lift_off.angle, lift_off.spin);
    story.candidates.push_back({lift_off, fly(hoop, lift_off)});
  }
  if (!story.candidates.empty()) {
    story.candidates.front().lift_off.time = outcome.first_jump_time;
    story.candidates.front().flight.height = outcome.first_jump_height;
  }
  const bool jumps = outcome.status == Status::jumped;
  if (jumps) {
    Candidate& jump = story.candidates.back();
    jump.lift_off.time = outcome.jump_time;
    jump.flight = {outcome.jump_height, outcome.apex_time, outcome.flight_time, outcome.dip};
  }
  const bool sets_out = design.release_spin > 0.0 ||
                        (design.release_spin == 0.0 && torque(hoop, trig(design.release_angle)) > 0.0);
  if (!(interval > 0.0) || !sets_out || outcome.status == Status::airborne_at_release) return story;

  double end = jumps ? outcome.jump_angle : design.release_angle + 2.0 * std::numbers::pi * scene.runway;
  if (outcome.status == Status::stalled) {
    const FirstMinimum<double> least = first_minimum(released);
    end = short_of_stall(design.release_angle, stall_angle(released, least.angle, least.crest));
  }
  Motion motion(design, scene, interval, story.points);
  motion.roll({.angle = design.release_angle, .spin = design.release_spin}, end);
  if (jumps) {
    const ContactState<double> lift_off{.time = outcome.jump_time,
                                        .travel = outcome.jump_distance,
                                        .angle = outcome.jump_angle,
                                        .spin = outcome.jump_spin};
    story.points.push_back(rolling_point(hoop, lift_off));
    motion.fly(lift_off, outcome.flight_time);
  }
  story.end = motion.end();
  return story;
}

Story with_friction(const Design& design, const Scene& scene, double tolerance, double interval) {
  Story story;
  ContactState<double> end;
  CoulombObserver observer;
  observer.phase = [&](Phase phase, const ContactState<double>& state, int direction) {
    story.phases.push_back({phase, state, direction});
  };
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    story.candidates.push_back({lift_off, flight});
  };
  observer.end = [&](const ContactState<double>& state) { end = state; };
  story.outcome = CoulombSolver<double>(tolerance).solve(design, scene, observer);
  if (!(interval > 0.0)) return story;

  const Hoop<double> hoop = derive<double>(design);
  Motion motion(design, scene, interval, story.points);
  auto flight = story.candidates.begin();
  for (std::size_t i = 0; i < story.phases.size(); ++i) {
    const auto& [phase, from, direction] = story.phases[i];
    const bool is_last = i + 1 == story.phases.size();
    const ContactState<double>& to = is_last ? end : story.phases[i + 1].state;
    if (phase == Phase::rolling) {
      const bool stalls = is_last && story.outcome.status == Status::stalled;
      motion.roll(from, stalls ? short_of_stall(from.angle, to.angle) : to.angle);
    } else if (phase == Phase::sliding) {
      motion.slide(from, direction, to.time);
    } else {
      story.points.push_back(flight_point(hoop, from, 0.0));
      motion.fly(from, (flight++)->flight.flight_time);
    }
  }
  story.end = motion.end();
  return story;
}

}  // namespace

Story tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval) {
  return scene.friction == Friction::coulomb ? with_friction(design, scene, tolerance, interval)
                                             : of_rolling(design, scene, tolerance, interval);
}

}  // namespace leapmap
