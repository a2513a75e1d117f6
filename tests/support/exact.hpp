// SPDX-License-Identifier: GPL-3.0-or-later
/// The exact solver on lists of designs, and how its outcomes compare.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "noslip/exact.hpp"
#include "support/designs.hpp"

namespace leapmap::testing {

template <class T>
std::vector<Outcome> solve_all(const std::vector<Design>& designs, const Scene& scene, double tolerance) {
  std::vector<Outcome> outcomes(designs.size());
  ExactSolver<T>(tolerance).solve(designs, scene, outcomes);
  return outcomes;
}
/// The reference: the same equations in long double.
inline std::vector<Outcome> reference(const std::vector<Design>& designs, const Scene& scene) {
  return solve_all<long double>(designs, scene, 1e-18);
}

inline std::string told(const Design& d) {
  return fmt::format(
      "slope {} mass_ratio {} offset_ratio {} inertia_factor {} release_angle {} release_spin {} "
      "drive_torque "
      "{}",
      d.slope, d.mass_ratio, d.offset_ratio, d.inertia_factor, d.release_angle, d.release_spin,
      d.drive_torque);
}

/// Wider than random_design: steep slopes, heavy masses, any release angle, near stalls.
inline std::vector<Design> wild_designs(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<Design> designs(static_cast<std::size_t>(count));
  for (Design& d : designs) {
    d.slope = uniform(random, 0.02, 1.2);
    d.mass_ratio = std::exp(uniform(random, -2.3, 4.0));
    d.offset_ratio = uniform(random, 0.05, 1.0);
    d.inertia_factor = uniform(random, 0.0, 1.2);
    d.release_angle = uniform(random, -3.0, 9.0);
    d.release_spin = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, 0.0, 1.5);
  }
  return designs;
}

inline double relative(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b)) ? 0.0 : std::abs(a / b - 1.0);
}

}  // namespace leapmap::testing
