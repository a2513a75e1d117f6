// SPDX-License-Identifier: GPL-3.0-or-later
/// The points of a motion, whatever the friction: where they lie in time, and what they hold, in the solvers'
/// units until they are all taken (units.hpp).
#pragma once

#include "hoop/contact_state.hpp"
#include "hoop/flight.hpp"
#include "hoop/sliding.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/motion.hpp"

namespace leapmap {

inline MotionPoint rolling_point(const Hoop<double>& hoop, const ContactState<double>& at) {
  const Trig<double> phi = trig(at.angle);
  const double acceleration = angular_acceleration(hoop, phi, at.spin);
  return {at.time,
          at.angle,
          at.spin,
          at.travel,
          0.0,
          normal_force(hoop, phi, at.spin, acceleration),
          friction_force(hoop, phi, at.spin, acceleration),
          Phase::rolling};
}

/// friction: mu_kinetic, with the sign of the sliding.
inline MotionPoint sliding_point(const Hoop<double>& hoop, double friction, const ContactState<double>& at) {
  const auto motion = sliding_motion(hoop, trig(at.angle), at.spin * at.spin, friction);
  return {at.time, at.angle, at.spin, at.travel, 0.0, motion.normal_force, motion.friction, Phase::sliding};
}

/// `flown` after the flight that begins at `from`.
inline MotionPoint flight_point(const Hoop<double>& hoop, const ContactState<double>& from, double flown) {
  const Trig<double> phi = trig(from.angle);
  const Turned<double> turned = turned_in_flight(hoop, from.spin, flown);
  return {from.time + flown,
          from.angle + turned.value,
          turned.rate,
          from.travel + travel_in_flight(hoop, phi, from.spin, from.slip, flown).value,
          height_above_plane(hoop, phi, from.spin, flown, from.normal).value,
          0.0,
          0.0,
          Phase::flight};
}

/// Samples at multiples of an interval. Throws InputError if they would be more than 10^7.
struct TraceSampler {
  double interval;
  std::vector<MotionPoint>& points;
  long next = 0;

  /// Takes the samples up to `end` that are not taken yet; point_at(t) gives them.
  template <class PointAt>
  void until(double end, const PointAt& point_at) {
    if (end / interval > 1e7)
      throw InputError("a trace of more than 10000000 points; allowed: a longer interval");
    for (; interval * static_cast<double>(next) <= end; ++next)
      points.push_back(point_at(interval * static_cast<double>(next)));
  }

  /// A flight up to its landing, which is a sample of its own.
  void fly(const Hoop<double>& hoop, const ContactState<double>& from, double flight_time) {
    until(from.time + flight_time, [&](double t) { return flight_point(hoop, from, t - from.time); });
    points.push_back(flight_point(hoop, from, flight_time));
  }
};

}  // namespace leapmap
