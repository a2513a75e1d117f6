// SPDX-License-Identifier: GPL-3.0-or-later
/// The points of a trace, whatever the friction: where they lie in time, and what they hold.
#pragma once

#include <fmt/format.h>

#include "physics/flight.hpp"
#include "support/errors.hpp"
#include "trajectory/trace.hpp"

namespace leapmap {

inline constexpr double check_tolerance = 1e-12;  ///< of a story's second method, and of its motion

/// Samples at multiples of an interval. Throws InputError if they would be more than 10^7.
struct TraceSampler {
  double interval;
  std::vector<TracePoint>& points;
  long next = 0;

  /// Takes the samples up to `end` that are not taken yet; point_at(t) gives them.
  template <class PointAt>
  void until(double end, const PointAt& point_at) {
    constexpr double most_points = 1e7;
    if (!(end / interval < most_points))
      throw InputError(
          fmt::format("a trace of more than {} points; allowed: a longer interval", most_points));
    for (; interval * static_cast<double>(next) <= end; ++next)
      points.push_back(point_at(interval * static_cast<double>(next)));
  }
};

inline TracePoint rolling_point(const Hoop<double>& hoop, const ContactState<double>& at) {
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

/// `flown` after the flight that begins at `from`.
inline TracePoint flight_point(const Hoop<double>& hoop, const ContactState<double>& from, double flown) {
  const Trig<double> phi = trig(from.angle);
  return {from.time + flown,
          from.angle + from.spin * flown,
          from.spin,
          from.travel + travel_in_flight(hoop, phi, from.spin, from.slip, flown).value,
          height_above_plane(hoop, phi, from.spin, flown, from.normal).value,
          0.0,
          0.0,
          Phase::flight};
}

}  // namespace leapmap
