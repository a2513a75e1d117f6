// SPDX-License-Identifier: GPL-3.0-or-later
/// Lift-offs decided by a hair.
#pragma once

namespace leapmap {

/// A place where the normal force touched zero, or nearly so, without an obvious answer.
struct Graze {
  double time;          ///< since release [sqrt(R/g)]
  double angle;         ///< phi [rad]
  double normal_force;  ///< at its extremum [weights]
  bool minimum;         ///< a minimum or a maximum of the normal force

  /// Whether it was counted as making a lift-off: a minimum below zero, or a maximum above zero, after which
  /// the normal force falls again.
  bool makes_lift_off() const { return minimum == (normal_force < 0.0); }
};

}  // namespace leapmap
