// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// What all designs of a study share: contact model, definition of a jump, units of the answer.
#pragma once

#include <cmath>

namespace leapmap {

/// Contact model.
enum class Friction {
  sticking,  ///< the contact never slips: the paper's model, (10) to (12)
  coulomb    ///< Coulomb friction: the hoop sticks, slides, lands and jumps again
};

/// What rolls.
enum class Mechanism {
  hoop,     ///< a hoop with masses fixed to it
  pendulum  ///< a hoop with a pendulum on its axis, and a motor between them
};

/// What the motor between hoop and pendulum does, always within its torque at its speed.
enum class MotorLaw {
  constant,     ///< all the torque it gives
  until_angle,  ///< the same until the pendulum has turned to motor_target; then it brakes, and holds
  until_speed,  ///< the same until the pendulum has that speed relative to the hoop
  speed,        ///< brings the pendulum to that speed relative to the hoop, and keeps it there
  angle         ///< brings the pendulum to that angle, with motor_gain and motor_damping
};

/// Contact model, definition of a jump, size and gravity.
struct Scene {
  Mechanism model = Mechanism::hoop;       ///< what rolls
  Friction friction = Friction::sticking;  ///< contact model
  double runway = 5.0;  ///< rolling limit, at which the search for a jump ends [revolutions], in (0, 1e6]
  double hop_height =
      0.05;  ///< jump threshold: the first lift-off this high is the jump [hoop diameters], >= 0
  double clear_height = 0.0;            ///< height of a thin wall to clear [hoop diameters], >= 0; 0: none
  bool clear_height_in_metres = false;  ///< then clear_height is in m, the same for hoops of every size
  long jumps = 1;                       ///< number of jumps to follow, in [1, 250]
  bool motor_in_flight = true;  ///< whether a motor drives the hoop in flight too; else it idles there
  MotorLaw motor_law = MotorLaw::constant;  ///< pendulum only
  double patience = 200.0;  ///< pendulum only: without a jump until then it is stalled [sqrt(R/g)], > 0
  // Gaits; the rolling limit then counts from each landing.
  long settle = 0;               ///< most jumps until a hoop settles on a gait, in [0, 10^6]; 0: no search
  long most_period = 16;         ///< longest period of a gait [jumps], in [1, 64]
  double gait_tolerance = 1e-3;  ///< distance of landings that count as equal [rad, sqrt(g/R)], in (0, 1]
  double rest_speed = 1e-3;      ///< Coulomb only: a slower rebound counts as zero [sqrt(g R)], >= 0
  double radius = 0.041;         ///< R [m], in [1e-9, 1e9]; scales lengths, times and speeds only
  double gravity = 9.81;         ///< g [m/s^2], in [1e-9, 1e9]; scales times and speeds only
  double mass = 0.0;  ///< m + m_p [kg], in [0, 1e9]; scales forces, torques and energies only; 0: not known
};

/// The unit of time of the dimensionless equations, sqrt(R/g) [s].
inline double time_unit(const Scene& scene) { return std::sqrt(scene.radius / scene.gravity); }

/// The height of the wall to clear [R], for a hoop of this size (Design::size).
inline double wall_in_radii(const Scene& scene, double size) {
  return scene.clear_height_in_metres ? scene.clear_height / (scene.radius * size) : 2.0 * scene.clear_height;
}

}  // namespace leapmap
