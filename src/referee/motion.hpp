// SPDX-License-Identifier: GPL-3.0-or-later
/// The paper's hoop as its Lagrangian has it, in SI units: (7) to (9) in its three coordinates, held on the
/// plane by two multipliers. Nothing is reduced or scaled, nothing is solved in advance but (7) and (8) for
/// the multipliers, and nothing is shared with hoop/: what agrees with this agrees with the paper.
#pragma once

#include <cmath>
#include <limits>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap::referee {

/// A hoop and its mass, of which only the ratio is given: the bare hoop weighs 1 kg.
struct Body {
  double m = 1.0, m_p;  ///< [kg]
  double R, L;          ///< [m]
  double I;             ///< of the bare hoop about its centre [kg m^2]
  double g;             ///< [m/s^2]
  double g_along;       ///< of it along the plane, downhill [m/s^2]
  double g_across;      ///< and across, into the plane [m/s^2]
  double motor;         ///< torque on the hoop [N m]
  double resisting;     ///< torque against the rotation in contact [N m]
  double turn;          ///< what the motor makes of phi'' in flight [rad/s^2]; 0: it idles there

  double mass() const { return m + m_p; }
  /// From the hoop's centre to the centre of mass [m].
  double arm() const { return m_p * L / mass(); }
};
Body body_of(const Design& design, const Scene& scene);

/// Coordinates of the hoop's centre along the plane and above it, the angle, and their rates [m, rad, s]. On
/// the plane y = R.
struct Motion {
  double x, y, phi, x_rate, y_rate, spin;
};

/// What holds for the two multipliers. Rolling: both constraints, (1) and (2). Sliding: (2), and friction
/// lambda_f = drag lambda_n. Flying: neither, both are zero (13). Unheld: as flying,
/// but with the resisting torque of the contact that it is about to leave.
struct Mode {
  enum Kind { rolls, slides, flies, unheld } kind = rolls;
  double drag = 0.0;  ///< -mu_kinetic sign(v)
};

/// The second derivatives of the coordinates, and the multipliers [N].
struct Forces {
  double x, y, phi;
  double friction, normal;
};
/// Solves (7) to (9), the motor's torque in (9), with the mode's two equations.
Forces forces_of(const Body& body, const Mode& mode, const Motion& at);
/// Whether a hoop in contact is at rest in an equilibrium, within the rounding of the numbers that say so: of
/// gravity's and the motor's moments about the contact next to nothing is left.
bool rests(const Body& body, const Motion& at);
/// Of those five equations, divided by what it is without friction: where it falls to zero, sliding has no
/// answer.
double sliding_determinant(const Body& body, const Mode& mode, const Motion& at);

/// (3) plus (4) [J].
double energy(const Body& body, const Motion& at);

/// Velocity of the hoop's lowest point along the plane [m/s]; zero where only rounding keeps it from that.
inline double slip_of(const Body& body, const Motion& at) {
  const double slip = at.x_rate - body.R * at.spin;
  return std::abs(slip) > 4.0 * std::numeric_limits<double>::epsilon() * std::abs(at.x_rate) ? slip : 0.0;
}

/// A landing: the motion after it, and the plane's normal impulse [N s].
struct Landed {
  Motion after;
  double impulse;
};
/// Along Routh's path of impulses, with Poisson's restitution. Rebounds slower than rest_speed [m/s] count as
/// none. Slip is exactly zero after it where friction held it.
Landed land(const Body& body, const Motion& before, double mu_kinetic, double restitution, double rest_speed);
/// With both constraints from then on, (1) and (2): what (7) to (9) make of the two impulses.
Landed land_without_slip(const Body& body, const Motion& before);

/// A flight from a lift-off.
struct Flown {
  double height = 0.0;  ///< of the lowest point's highest place above the plane [m]; 0: it never clears it
  double apex_time = 0.0, landing_time = 0.0;  ///< after lift-off [s]
  double dip = 0.0;                            ///< the lowest place before that [m], <= 0
  bool failed = false;                         ///< it takes more looks than are taken; nothing else is said
};
/// The centre of mass falls freely, and the motor turns the hoop or its spin stays: looks along the flight in
/// small steps.
Flown fly(const Body& body, const Motion& lift_off);
/// Where the hoop is some time after lift-off.
Motion flying(const Body& body, const Motion& lift_off, double time);

}  // namespace leapmap::referee
