// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// A hoop as a drawing has it, and the three ratios of a Design that it comes to.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// A mass that is fixed to the hoop.
struct Weight {
  std::string name{};    ///< of its own, for keys such as hoop.slug.mass
  double mass = 0.0;     ///< [kg], >= 0
  double at = 0.0;       ///< distance of its centre from the hoop's axis [m], in [0, R]
  double angle = 0.0;    ///< direction of its centre [rad], in [-2 pi, 2 pi]; only differences matter
  double inertia = 0.0;  ///< about its own centre [kg m^2], >= 0
};

/// A ring with any number of weights.
struct Body {
  double diameter = 0.0;  ///< 2 R [m], > 0
  double mass = 0.0;      ///< of the ring and everything on it except the weights [kg], > 0
  /// Of the same about the axis [kg m^2], >= 0; NaN: of a thin ring, m R^2.
  double inertia = std::numeric_limits<double>::quiet_NaN();
  std::vector<Weight> weights{};  ///< any number of them
};

/// What matters to the motion of a body, and a design of the same motion.
struct ReducedBody {
  double total_mass = 0.0;    ///< M [kg]
  double eccentricity = 0.0;  ///< distance of the centre of mass from the axis, in R: rho
  double inertia = 0.0;       ///< about the axis, in M R^2: J0
  double direction = 0.0;     ///< of the centre of mass, as the weights' angles [rad]
  // One point mass, the sum of the weights at their common centre, and a ring with the rest of the inertia:
  double mass_ratio = 0.0;      ///< of a Design
  double offset_ratio = 0.0;    ///< of a Design
  double inertia_factor = 0.0;  ///< of a Design
};

/// Reduces a body.
/// @throws InputError naming the key, its value and what is allowed
ReducedBody reduce_body(const Body& body);

/// Gives a design the ratios of the body, and a scene its radius and total mass.
void apply_body(const ReducedBody& reduced, const Body& body, Design& design, Scene& scene);

}  // namespace leapmap
