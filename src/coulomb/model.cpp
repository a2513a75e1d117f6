// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/model.hpp"

#include "coulomb/coulomb.hpp"
#include "coulomb/coulomb_integration.hpp"

namespace leapmap::coulomb {

/// Everything comes with the phases, wanted or not.
Solver exact(const Scene& scene, double tolerance, const Wanted& wanted) {
  if (scene.jumps > 1) return in_sequence(jumps(scene, tolerance, wanted), scene);
  return one_by_one(std::make_shared<CoulombSolver<double>>(tolerance), scene);
}

JumpSolver<double> jumps(const Scene& scene, double tolerance, const Wanted&) {
  return jumps_one_by_one<double>(std::make_shared<CoulombSolver<double>>(tolerance), scene);
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  if (scene.jumps > 1) return in_sequence(integrated_jumps(scene, options), scene);
  return one_by_one(std::make_shared<CoulombIntegration>(options), scene);
}

JumpSolver<double> integrated_jumps(const Scene& scene, const IntegrationOptions& options) {
  return jumps_one_by_one<double>(std::make_shared<CoulombIntegration>(options), scene);
}

}  // namespace leapmap::coulomb
