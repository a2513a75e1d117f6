// SPDX-License-Identifier: GPL-3.0-or-later
/// What a motor must have to be a design's drive torque, in SI units.
#pragma once

#include "leapmap/motion.hpp"
#include "leapmap/spec.hpp"

namespace leapmap::cli {

/// Largest values up to the jump's lift-off, or by samples up to the motion's end.
struct Motor {
  double mass;    ///< of hoop and weight together [kg]; 0: not known, and torque, power and work are NaN
  double torque;  ///< [N m]
  double power;   ///< of the torque on the hoop [W]; below zero: it only brakes
  double spin;    ///< [rpm], of the hoop
  double work;    ///< done in all [J]
  bool only_brakes;
};

/// motion: the design's. One that does not jump is solved once more, with samples.
Motor motor_of(const Spec& spec, const Motion& motion);

}  // namespace leapmap::cli
