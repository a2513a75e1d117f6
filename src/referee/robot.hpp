// SPDX-License-Identifier: GPL-3.0-or-later
/// A hoop with a driven pendulum as Newton and Euler have it, in SI units: two bodies in Cartesian
/// coordinates, held together by the pin's two forces and on the plane by the contact's. Nothing is reduced,
/// and nothing is shared with pendulum/.
#pragma once

#include <array>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap::referee {

/// Masses, lengths, inertias and the motor's numbers [kg, m, s, N]; the bare hoop weighs 1 kg.
struct Robot {
  double m = 1.0, m_p;  ///< hoop, pendulum
  double R, L;          ///< radius; pin to the pendulum's centre of mass
  double I, I_p;        ///< of the hoop, and of the pendulum, about their centres
  double g, slope;
  double stall, no_load;  ///< the motor's torque at rest, signed, and the speed at which it has none
  double target;          ///< an angle or a speed, by the law
  double gain, damping;
  MotorLaw law;

  double weight() const { return (m + m_p) * g; }
};
Robot robot_of(const Design& design, const Scene& scene);

/// Hoop's centre, both angles, and their rates; and the work of the motor.
struct RobotMotion {
  double x, y, phi, psi;
  double x_rate, y_rate, spin, swing;
  double work;
};

/// What the motor does: gives so much, or whatever keeps the two from turning against each other.
enum class Motored { up, down, follows, holds, idles };

struct RobotMode {
  enum Kind { rolls, slides, flies } kind = rolls;
  Motored motor = Motored::up;
  double drag = 0.0;  ///< F / N of sliding
};

/// Second derivatives of the six coordinates, the pin's force on the hoop, the contact's, and the torque.
struct RobotForces {
  double x, y, phi, pendulum_x, pendulum_y, psi;
  double pin_x, pin_y, friction, normal, torque;
};
/// Solves eleven equations: three of each body, two of the pin, two of the contact, one of the motor.
RobotForces forces_of(const Robot& robot, const RobotMode& mode, const RobotMotion& at);
/// Their determinant over that without friction: where it is not above zero, sliding has no answer.
double sliding_determinant(const Robot& robot, const RobotMode& mode, const RobotMotion& at);

/// Torque of the motor at its limits up and down, and what its law wants in between [N m].
struct MotorRange {
  double up, down, wanted;
};
MotorRange motor_range(const Robot& robot, const RobotMotion& at);

/// [J]
double energy(const Robot& robot, const RobotMotion& at);

/// A landing, and the plane's normal impulse [N s]. mu_kinetic below zero: it stops the contact in both
/// directions. motor: idles, or holds the two together as one body.
struct RobotLanded {
  RobotMotion after;
  double impulse;
};
RobotLanded land(const Robot& robot, const RobotMotion& before, Motored motor, double mu_kinetic,
                 double restitution, double rest_speed);

/// Solves one design by integrating those equations, as Referee does.
Outcome solve_robot(const Design& design, const Scene& scene, double tolerance, long most_steps,
                    bool meets_forces);

}  // namespace leapmap::referee
