// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/model.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "friction/coulomb.hpp"
#include "friction/coulomb_integration.hpp"
#include "friction/coulomb_lanes.hpp"

namespace leapmap::friction {

Solver exact(const Scene& scene, double tolerance, const Wanted& wanted) {
  if (scene.jumps > 1) return in_sequence(long_jumps(scene, tolerance, wanted), scene);
  return [lanes = std::make_shared<CoulombLanes<Batch>>(tolerance, wanted), scene](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    lanes->solve(designs, scene, outcomes);
  };
}

JumpSolver<double> jumps(const Scene& scene, double tolerance, const Wanted& wanted) {
  return [lanes = std::make_shared<CoulombLanes<Batch>>(tolerance, wanted), scene](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) { lanes->solve(start, designs, states, scene, outcomes); };
}

LongJumpSolver<double> long_jumps(const Scene& scene, double tolerance, const Wanted& wanted) {
  return [lanes = std::make_shared<CoulombLanes<Batch>>(tolerance, wanted), scene](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes,
             const GoesOn& goes_on) { lanes->solve(start, designs, states, scene, outcomes, goes_on); };
}

std::function<double(const Design&)> effort(const Scene& scene, bool derivatives) {
  // Panels of slides are nearly all of it: a hoop that rocks to rest slides some hundred times.
  const auto panels = std::make_shared<double>();
  const JumpSolver<double> counted =
      [panels, derivatives, scene, solver = std::make_shared<CoulombSolver<double>>(1e-10)](
          Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
          std::span<Outcome> outcomes) {
        constexpr double derived = 10.0;  // the way to a jump once more in duals, on top of it
        for (std::size_t i = 0; i < designs.size(); ++i) {
          std::vector<RecordedSlide<double>> slides;
          outcomes[i] = solver->solve(start, designs[i], states[i], scene, {}, &slides);
          double way = 2.0;
          for (const RecordedSlide<double>& slide : slides) way += 0.2 + static_cast<double>(slide.size());
          *panels += derivatives && outcomes[i].status == Status::jumped ? (1.0 + derived) * way : way;
        }
      };
  return [panels, solve = in_sequence(counted, scene)](const Design& design) {
    *panels = 0.0;
    Outcome outcome;
    solve({&design, 1}, {&outcome, 1});
    return *panels;
  };
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  if (scene.jumps > 1) return in_sequence(integrated_jumps(scene, options), scene);
  return one_by_one(std::make_shared<CoulombIntegration>(options), scene);
}

JumpSolver<double> integrated_jumps(const Scene& scene, const IntegrationOptions& options) {
  return jumps_one_by_one<double>(std::make_shared<CoulombIntegration>(options), scene);
}

}  // namespace leapmap::friction
