// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/solver.hpp"

#include <memory>

#include "trajectory/exact.hpp"

namespace leapmap {

Solver make_solver(const Spec& spec) {
  if (resolved_method(spec.numerics) == "exact") {
    const auto stored = [&](std::string_view field) { return stores(spec.output, field); };
    const Wanted wanted{.first_jump_time = stored("first_jump_time"),
                        .jump_time = stored("jump_time"),
                        .descent = stored("flight_time") || stored("dip")};
    const auto exact = std::make_shared<ExactSolver<Batch>>(spec.numerics.tolerance, wanted);
    return [exact, scene = spec.scene](std::span<const Design> designs, std::span<Outcome> outcomes) {
      exact->solve(designs, scene, outcomes);
    };
  }
  const auto rolling = std::make_shared<RollingIntegration>(integration_options(spec.numerics));
  return [rolling, scene = spec.scene](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) outcomes[i] = rolling->solve(designs[i], scene);
  };
}

}  // namespace leapmap
