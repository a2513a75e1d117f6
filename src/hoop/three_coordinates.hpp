// SPDX-License-Identifier: GPL-3.0-or-later
/// The hoop in three coordinates held on the plane by two constraints with multipliers, (1), (2) and (7) to
/// (9): more model than rolling needs, here to measure what that costs.
///
/// The coordinates are those of a point at `reference` from the hoop's centre towards the mass, and phi. With
/// reference 0 they are the paper's x, y and phi, and the constraints are linear. With reference rho they are
/// the centre of mass's, as engines for rigid bodies have it, and the constraints are curved: differentiated
/// twice, they drift.
#pragma once

#include <array>

#include "hoop/parameters.hpp"
#include "numerics/root.hpp"

namespace leapmap {

/// (x, y, phi, x', y', w), lengths in R, times in sqrt(R/g).
using ThreeState = std::array<double, 6>;

/// What the equations of motion say at a state.
struct ConstrainedMotion {
  std::array<double, 3> acceleration;  ///< (x'', y'', phi'')
  double friction_force;               ///< lambda_f over the weight, positive downhill
  double normal_force;                 ///< lambda_n over the weight
  double normal_force_rate;            ///< its derivative along the motion
};

struct ThreeCoordinates {
  Hoop<double> hoop;
  double reference = 0.0;  ///< in R, 0 to rho

  /// On the constraints, rolled to that angle, rolling with that spin.
  ThreeState rolling(double angle, double spin) const;
  /// Solves (7) to (9) with the constraints differentiated twice, one linear system of five.
  ConstrainedMotion motion(const ThreeState& y) const;
  /// The same without its rate.
  std::array<double, 3> acceleration(const ThreeState& y) const;
  /// Moves a state onto the constraints, positions and velocities, by the least way the kinetic energy
  /// measures.
  void project(ThreeState& y) const;
  /// How far a state is off the constraints, the largest of both positions and both velocities.
  double drift(const ThreeState& y) const;
};

}  // namespace leapmap
