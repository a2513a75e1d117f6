// SPDX-License-Identifier: GPL-3.0-or-later
/// Designs that many tests use: the paper's, and seeded random ones.
#pragma once

#include <random>

#include "integrate/rolling_integration.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap::testing {

inline Design paper_hoop() { return {}; }

/// A scene in which a second is sqrt(R/g), a metre R.
inline Scene unit_scene(Friction friction = Friction::sticking) {
  return {.friction = friction, .radius = 1.0, .gravity = 1.0};
}

inline const Scene coulomb = unit_scene(Friction::coulomb);

/// The same with a motor that idles in flight, as the reference tables have it.
inline Scene idle_scene(Friction friction = Friction::sticking) {
  Scene scene = unit_scene(friction);
  scene.motor_in_flight = false;
  return scene;
}

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A design as a user might choose it, any release.
inline Design random_design(std::mt19937_64& random) {
  Design design;
  design.slope = uniform(random, 0.05, 0.9);
  design.mass_ratio = std::exp(uniform(random, std::log(0.1), std::log(20.0)));
  design.offset_ratio = uniform(random, 0.1, 1.0);
  design.inertia_factor = uniform(random, 0.5, 1.0);
  design.release_angle = uniform(random, 2.5, 4.5);
  design.release_spin = uniform(random, 0.0, 1.0);
  return design;
}

/// The same released either way, on slopes up or down, and driven either way or not at all.
inline Design either_way(std::mt19937_64& random) {
  Design design = random_design(random);
  design.slope = uniform(random, -0.6, 0.9);
  design.release_angle = uniform(random, -3.2, 6.4);
  design.release_spin = random() % 4 == 0 ? 0.0 : uniform(random, -2.0, 2.0);
  design.drive_torque = random() % 3 == 0 ? 0.0 : uniform(random, -0.6, 0.6);
  return design;
}

/// The same with coefficients of friction and restitution, where the model has them.
inline Design either_way(std::mt19937_64& random, Friction friction) {
  Design design = either_way(random);
  if (friction == Friction::sticking) return design;
  design.drive_torque = 0.0;  // a motor that idles in flight leaves most of these without an answer
  design.mu_static = uniform(random, 0.1, 1.5);
  design.mu_kinetic = uniform(random, 0.5, 1.0) * design.mu_static;
  design.restitution = uniform(random, 0.0, 0.8);
  return design;
}

using leapmap::adaptive;

inline Outcome solve(const Design& design, const Scene& scene = unit_scene(),
                     std::string_view stepper = "gsl-rk8pd", double tolerance = 1e-12) {
  return RollingIntegration(adaptive(stepper, tolerance)).solve(design, scene);
}

}  // namespace leapmap::testing
