// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/model.hpp"

#include "rolling/exact.hpp"
#include "rolling/rolling_integration.hpp"

namespace leapmap::rolling {

Solver exact(const Scene& scene, double tolerance, const Wanted& wanted) {
  if (scene.jumps > 1) return in_sequence(jumps(scene, tolerance, wanted), scene);
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance, wanted), scene](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    solver->solve(designs, scene, outcomes);
  };
}

JumpSolver<double> jumps(const Scene& scene, double tolerance, const Wanted& wanted) {
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance, wanted), scene](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) { solver->solve(start, designs, states, scene, outcomes); };
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  const auto solver = std::make_shared<RollingIntegration>(options);
  if (scene.jumps == 1) return one_by_one(solver, scene);
  return in_sequence(jumps_one_by_one<double>(solver, scene), scene);
}

}  // namespace leapmap::rolling
