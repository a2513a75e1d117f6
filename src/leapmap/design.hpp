// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// The parameters of one design.
#pragma once

#include <limits>
#include <numbers>

namespace leapmap {

/// One hoop and its release. The defaults are the paper's hoop, released from rest with its mass on top.
struct Design {
  double slope = 0.40;                      ///< theta [rad], in (-pi/2, pi/2); below zero: uphill
  double mass_ratio = 20.0 / 8.2;           ///< beta = m_p / m, in [0, 1e12]
  double offset_ratio = 1.0;                ///< lambda = L / R, in [0, 1]
  double inertia_factor = 1.0;              ///< kappa = I / (m R^2), in [0, 1e12]: thin hoop 1, disc 1/2
  double release_angle = std::numbers::pi;  ///< phi at t = 0 [rad], in [-1e6, 1e6]; 0: mass on the
                                            ///< plane, pi: mass on top
  double release_spin = 0.0;                ///< w at t = 0 [sqrt(g/R)], in [-1e4, 1e4], positive downhill
  double drive_torque = 0.0;                ///< tau, of a motor [(m + m_p) g R], in [-1e3, 1e3],
                                            ///< positive downhill; see Scene::motor_in_flight
  double resisting_torque = 0.0;            ///< against the rotation while the hoop touches the plane
                                            ///< [(m + m_p) g R], in [0, 1e3]: of a bearing, of rolling
  // Contact; no effect with Friction::sticking.
  double mu_static = 0.5;  ///< static friction coefficient, in [0, 1e6]
  double mu_kinetic =
      std::numeric_limits<double>::quiet_NaN();  ///< kinetic, in [0, 1e6]; NaN: equal to
                                                 ///< mu_static; larger: mu_static is set to it
  double restitution = 0.0;                      ///< Poisson's, in [0, 1]
  double size = 1.0;  ///< radius over Scene::radius, > 0; scales times and speeds only
  double mass = 1.0;  ///< total mass over that of the nominal hoop, > 0; scales forces and energies only
  // Of a pendulum, Mechanism::pendulum; mass_ratio and offset_ratio are its mass and its length then.
  double pendulum_inertia = 0.0;  ///< its own, about its centre of mass [m_p L^2], in [0, 1e12]
  double pendulum_angle = 0.0;    ///< psi at t = 0 [rad], in [-1e6, 1e6], measured as phi: 0: it hangs
  double pendulum_spin = 0.0;     ///< psi' at t = 0 [sqrt(g/R)], in [-1e4, 1e4], not relative to the hoop
  double motor_torque = 0.0;      ///< on the pendulum; minus that on the hoop [(m + m_p) g R], in
                                  ///< [-1e3, 1e3]; at no_load_speed it is used up
  double no_load_speed =
      std::numeric_limits<double>::infinity();  ///< of pendulum relative to hoop [sqrt(g/R)], > 0
  double motor_target = 0.0;  ///< of Scene::motor_law: an angle [rad] or a speed [sqrt(g/R)]
  double motor_gain =
      std::numeric_limits<double>::infinity();  ///< laws speed and angle: torque per missing speed or angle
  double motor_damping = 0.0;                   ///< law angle: torque per spin of the pendulum
};

}  // namespace leapmap
