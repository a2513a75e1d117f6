// SPDX-License-Identifier: GPL-3.0-or-later
/// From the solvers' units (lengths in R, times in sqrt(R/g)) to those of an answer: each method's last step.
#pragma once

#include "leapmap/motion.hpp"
#include "leapmap/scene.hpp"
#include "physics/flight.hpp"
#include "trajectory/contact_state.hpp"

namespace leapmap {

/// The outcome's times from sqrt(R/g) to seconds.
inline void to_seconds(Outcome& outcome, double time_unit) {
  outcome.jump_time *= time_unit;
  outcome.apex_time *= time_unit;
  outcome.flight_time *= time_unit;
  outcome.first_jump_time *= time_unit;
}

/// Points in the solvers' units to SI.
inline void to_si(std::vector<MotionPoint>& points, const Scene& scene) {
  const double second = time_unit(scene), metre = scene.radius;
  for (MotionPoint& point : points) {
    point.t *= second;
    point.spin /= second;
    point.x *= metre;
    point.y *= metre;
  }
}

inline PhaseStart in_si(Phase phase, const ContactState<double>& at, int direction, const Scene& scene) {
  const double second = time_unit(scene);
  return {phase, direction, at.time * second, at.angle, at.spin / second, at.travel * scene.radius};
}

inline Candidate in_si(const LiftOff<double>& lift_off, const Flight<double>& flight, const Scene& scene) {
  const double second = time_unit(scene);
  return {lift_off.time * second,
          lift_off.angle,
          lift_off.spin / second,
          flight.height,
          flight.apex_time * second,
          flight.flight_time * second,
          flight.dip,
          flight.height >= scene.hop_height};
}

}  // namespace leapmap
