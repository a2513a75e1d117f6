// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/model.hpp"

#include "integrate/rolling_integration.hpp"
#include "noslip/exact.hpp"

namespace leapmap::noslip {

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

std::function<double(const Design&)> effort(const Scene& scene, bool derivatives) {
  if (scene.jumps == 1 && !derivatives) return [](const Design&) { return 1.0; };
  return [solve = exact(scene, 1e-6, {}), derivatives](const Design& design) {
    Outcome outcome;
    solve({&design, 1}, {&outcome, 1});
    constexpr double derived = 2.0;  // to a jump, on top of the way there
    return 1.0 + static_cast<double>(outcome.jumps()) * (derivatives ? 1.0 + derived : 1.0);
  };
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  if (scene.jumps > 1) return in_sequence(integrated_jumps(scene, options), scene);
  return one_by_one(std::make_shared<RollingIntegration>(options), scene);
}

JumpSolver<double> integrated_jumps(const Scene& scene, const IntegrationOptions& options) {
  return jumps_one_by_one<double>(std::make_shared<RollingIntegration>(options), scene);
}

}  // namespace leapmap::noslip
