// SPDX-License-Identifier: GPL-3.0-or-later
/// From the solvers' units (lengths in R, times in sqrt(R/g)) to those of an answer: each method's last step.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "hoop/contact_state.hpp"
#include "hoop/flight.hpp"
#include "leapmap/design.hpp"
#include "leapmap/motion.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// The outcome's times from sqrt(R/g) to seconds.
inline void to_seconds(Outcome& outcome, double time_unit) {
  outcome.jump_time *= time_unit;
  outcome.apex_time *= time_unit;
  outcome.flight_time *= time_unit;
  outcome.first_jump_time *= time_unit;
}

/// Times in seconds and speeds in m/s, which grow with the root of the radius.
inline constexpr std::array growing_with_size{&Outcome::jump_time,      &Outcome::apex_time,
                                              &Outcome::flight_time,    &Outcome::first_jump_time,
                                              &Outcome::gait_jump_time, &Outcome::gait_speed};
inline constexpr std::array later_growing_with_size{&Jump::time, &Jump::flight_time};

constexpr bool grows_with_size(const OutcomeNumber& number) {
  for (double Outcome::*const one : growing_with_size)
    if (number.jump == 1 && number.own == one) return true;
  for (double Jump::*const one : later_growing_with_size)
    if (number.jump > 1 && number.of_jump == one) return true;
  return false;
}

/// The quantity of an outcome if it is one of them, else 0.
inline double in_seconds(const OutcomeNumber& number, const Outcome& outcome) {
  return grows_with_size(number) ? number.of(outcome) : 0.0;
}

/// From a hoop of Scene::radius to one of the design's size.
inline void resize(const Design& design, Outcome& outcome) {
  if (design.size == 1.0) return;
  const double factor = std::sqrt(design.size);
  for (double Outcome::*const number : growing_with_size) outcome.*number *= factor;
  for (Jump& jump : outcome.later_jumps)
    for (double Jump::*const number : later_growing_with_size) jump.*number *= factor;
}
inline void resize(std::span<const Design> designs, std::span<Outcome> outcomes) {
  for (std::size_t i = 0; i < designs.size(); ++i) resize(designs[i], outcomes[i]);
}

/// Points in the solvers' units to SI.
inline void to_si(std::vector<MotionPoint>& points, const Scene& scene) {
  const double second = time_unit(scene), metre = scene.radius;
  for (MotionPoint& point : points) {
    point.t *= second;
    point.spin /= second, point.pendulum_spin /= second;
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
