// SPDX-License-Identifier: GPL-3.0-or-later
/// Samples rolling over time by inverting the time integral, and flights in closed form.
#pragma once

#include "rolling/rolling_time.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap {

inline constexpr double motion_tolerance = 1e-12;  ///< of the times between samples, relative

class RollingMotion {
 public:
  /// interval: between samples [sqrt(R/g)]. points: what they are added to, in the solvers' units.
  RollingMotion(const Hoop<double>& hoop, double interval, std::vector<MotionPoint>& points)
      : hoop_(hoop), sampler_{interval, points} {}

  /// Rolls without slip from a state to an angle ahead.
  void roll(const ContactState<double>& from, double end);
  void fly(const ContactState<double>& from, double flight_time);
  /// point_at(t): the motion up to a time, however it goes on.
  template <class PointAt>
  void until(double end, const PointAt& point_at) {
    sampler_.until(end, point_at);
    end_ = end;
  }

  /// When the motion so far ends [sqrt(R/g)].
  double end() const { return end_; }

 private:
  ContactState<double> rolled(const Roll<double>& roll, const ContactState<double>& from, double x,
                              double time) const;
  double rolled_within(const Roll<double>& roll, double duration, double least, double step,
                       double most) const;

  Hoop<double> hoop_;
  TraceSampler sampler_;
  double end_ = 0.0;
  RollingTime<double> time_{motion_tolerance};
};

/// Whether a release turns downhill, or is from rest and will.
inline bool sets_out(const Hoop<double>& hoop, double angle, double spin) {
  return spin > 0.0 || (spin == 0.0 && torque(hoop, trig(angle)) > 0.0);
}

/// The angle at which a motion towards a stall is left: a hair before it, as it is approached for ever so
/// slowly while its energy is lost in roundings.
inline double short_of_stall(double release, double stall) {
  return release + (stall - release) * (1.0 - 1e-9);
}

}  // namespace leapmap
