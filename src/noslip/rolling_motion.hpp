// SPDX-License-Identifier: GPL-3.0-or-later
/// Samples rolling over time by inverting the time integral, and flights in closed form.
#pragma once

#include "noslip/rolling_time.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap {

inline constexpr double motion_tolerance = 1e-12;  ///< of the times between samples, relative

class RollingMotion {
 public:
  /// interval: between samples [sqrt(R/g)]. points: what they are added to, in the solvers' units.
  RollingMotion(const Hoop<double>& hoop, double interval, std::vector<MotionPoint>& points)
      : hoop_(hoop), sampler_{interval, points} {}

  /// Rolls without slip from a state to an angle ahead, uphill or downhill. to_rest: it turns round there.
  void roll(const ContactState<double>& from, double end, bool to_rest);
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
  void roll_on(const ContactState<double>& from, double length);
  MotionPoint shown(ContactState<double> at) const;
  void roll_to_rest(const ContactState<double>& from, double length);
  double rolled_within(const Roll<double>& roll, double duration, double least, double step,
                       double most) const;

  Hoop<double> hoop_;
  double way_ = 1.0;  // the state is seen from the side where it rolls downhill
  TraceSampler sampler_;
  double end_ = 0.0;
  RollingTime<double> time_{motion_tolerance};
};

/// 1 for a release that sets out downhill, -1 for uphill; 0: at rest, and nothing pulls.
inline double way_of(const Hoop<double>& hoop, double angle, double spin) {
  const double sets_out = setting_out(hoop, angle, trig(angle), spin);
  return sets_out > 0.0 ? 1.0 : sets_out < 0.0 ? -1.0 : 0.0;
}

}  // namespace leapmap
