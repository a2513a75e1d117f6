// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/model.hpp"

#include "coulomb/coulomb.hpp"
#include "coulomb/coulomb_integration.hpp"

namespace leapmap::coulomb {

/// Everything comes with the phases, wanted or not.
Solver exact(const Scene& scene, double tolerance, const Wanted&) {
  return one_by_one(std::make_shared<CoulombSolver<double>>(tolerance), scene);
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  return one_by_one(std::make_shared<CoulombIntegration>(options), scene);
}

}  // namespace leapmap::coulomb
