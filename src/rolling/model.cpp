// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/model.hpp"

#include "rolling/exact.hpp"
#include "rolling/rolling_integration.hpp"

namespace leapmap::rolling {

Solver exact(const Scene& scene, double tolerance, const Wanted& wanted) {
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance, wanted), scene](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    solver->solve(designs, scene, outcomes);
  };
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  return one_by_one(std::make_shared<RollingIntegration>(options), scene);
}

}  // namespace leapmap::rolling
