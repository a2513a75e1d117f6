// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion at given times, with its derivatives by the parameters: what a film is compared with.
#pragma once

#include <span>
#include <vector>

#include "leapmap/scene.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

/// S: double, or DesignDual for derivatives.
template <class S>
struct MotionAt {
  S phi;                             ///< [rad]
  S x, y;                            ///< travel of the centre, height of the lowest point above the plane [R]
  S spin;                            ///< [sqrt(g/R)]
  double x_rate, y_rate, spin_rate;  ///< of these over time, in sqrt(R/g)
};

/// The motion at times since release [s], in ascending order; empty if the design cannot be solved. After the
/// landing of the jump, or the search's end, the last phase goes on for ever: a flight goes on through the
/// plane.
///
/// Phases and their ends are the exact solver's. Between them, where the state is no closed form of the time,
/// the equations are integrated by extrapolation of midpoint steps, to the accuracy; a phase's end gets its
/// derivatives by one Newton step of what is zero there. Derivatives by mu_kinetic are added to those by
/// mu_static where it follows that.
template <class S>
std::vector<MotionAt<S>> motion_at(const Design& design, const Scene& scene, std::span<const double> times,
                                   double accuracy = 1e-11);

}  // namespace leapmap
