// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/model.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "coulomb/coulomb.hpp"
#include "coulomb/coulomb_integration.hpp"
#include "coulomb/coulomb_lanes.hpp"

namespace leapmap::coulomb {

/// Everything comes with the phases, wanted or not.
Solver exact(const Scene& scene, double tolerance, const Wanted& wanted) {
  if (scene.jumps > 1) return in_sequence(jumps(scene, tolerance, wanted), scene);
  return [lanes = std::make_shared<CoulombLanes<Batch>>(tolerance), scene](std::span<const Design> designs,
                                                                           std::span<Outcome> outcomes) {
    lanes->solve(designs, scene, outcomes);
  };
}

JumpSolver<double> jumps(const Scene& scene, double tolerance, const Wanted&) {
  return [lanes = std::make_shared<CoulombLanes<Batch>>(tolerance), scene](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) { lanes->solve(start, designs, states, scene, outcomes); };
}

std::function<double(const Design&)> effort(const Scene& scene) {
  Scene first = scene;
  first.jumps = 1;
  return [solver = std::make_shared<CoulombSolver<double>>(1e-10), first, all = exact(scene, 1e-6, {}),
          follows = scene.jumps > 1](const Design& design) {
    // Panels of slides are nearly all of it: a hoop that rocks to rest slides some hundred times.
    std::vector<SlideTold<double>> slides;
    solver->solve(design, first, {}, &slides);
    double panels = 2.0;
    for (const SlideTold<double>& slide : slides) panels += 0.2 + static_cast<double>(slide.size());
    if (!follows) return panels;
    Outcome outcome;
    all({&design, 1}, {&outcome, 1});
    return panels * std::max(1.0, static_cast<double>(outcome.jumps()));
  };
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  if (scene.jumps > 1) return in_sequence(integrated_jumps(scene, options), scene);
  return one_by_one(std::make_shared<CoulombIntegration>(options), scene);
}

JumpSolver<double> integrated_jumps(const Scene& scene, const IntegrationOptions& options) {
  return jumps_one_by_one<double>(std::make_shared<CoulombIntegration>(options), scene);
}

}  // namespace leapmap::coulomb
