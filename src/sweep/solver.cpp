// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/solver.hpp"

#include <memory>

#include "trajectory/coulomb_integration.hpp"
#include "trajectory/exact.hpp"

namespace leapmap {
namespace {

/// One design after another, by anything that solves one.
template <class One>
Solver one_by_one(std::shared_ptr<One> one, const Scene& scene) {
  return [one, scene](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) outcomes[i] = one->solve(designs[i], scene);
  };
}

Solver make_exact(const Scene& scene, double tolerance, const Wanted& wanted) {
  if (scene.friction == Friction::coulomb)
    return one_by_one(std::make_shared<CoulombSolver<double>>(tolerance), scene);
  const auto exact = std::make_shared<ExactSolver<Batch>>(tolerance, wanted);
  return [exact, scene](std::span<const Design> designs, std::span<Outcome> outcomes) {
    exact->solve(designs, scene, outcomes);
  };
}

Solver make_integration(const Scene& scene, const IntegrationOptions& options) {
  if (scene.friction == Friction::coulomb)
    return one_by_one(std::make_shared<CoulombIntegration>(options), scene);
  return one_by_one(std::make_shared<RollingIntegration>(options), scene);
}

}  // namespace

Solver make_solver(const Spec& spec) {
  if (resolved_method(spec.numerics) != "exact")
    return make_integration(spec.scene, integration_options(spec.numerics));
  const auto stored = [&](std::string_view field) { return stores(spec.output, field); };
  return make_exact(spec.scene, spec.numerics.tolerance,
                    {.first_jump_time = stored("first_jump_time"),
                     .jump_time = stored("jump_time"),
                     .descent = stored("flight_time") || stored("dip")});
}

Solver make_solver(const Spec& spec, std::string_view method, double tolerance) {
  return method == "exact" ? make_exact(spec.scene, tolerance, {})
                           : make_integration(spec.scene, adaptive(method, tolerance));
}

}  // namespace leapmap
