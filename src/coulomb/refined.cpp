// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/coulomb.hpp"
#include "coulomb/model.hpp"

namespace leapmap::coulomb {

Outcome refined(const Design& design, const Scene& scene) {
  return CoulombSolver<long double>(1e-15).solve(design, scene);
}

}  // namespace leapmap::coulomb
