// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/solving.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "coulomb/coulomb_integration.hpp"
#include "coulomb/model.hpp"
#include "numerics/game_steppers.hpp"
#include "rolling/model.hpp"
#include "rolling/rolling_integration.hpp"

namespace leapmap {
namespace {

IntegrationOptions options_of(const Contestant& contestant, long max_steps) {
  IntegrationOptions options;
  options.stepper = find_gsl_stepper(contestant.method);
  for (const GslStepper& stepper : game_steppers())
    if (stepper.name == contestant.method) options.stepper = &stepper;
  if (contestant.fixed_step) {
    // The tolerances are then those of implicit steppers' Newton iterations: a thousandth of the step's own
    // error, which goes with the step's power order + 1. GSL's Newton does not converge to less at long
    // steps.
    const double newton = 1e-3 * std::pow(contestant.setting, contestant.order + 1);
    options.control.fixed_step = contestant.setting;
    options.control.relative = options.control.absolute = std::clamp(newton, 1e-13, 1e-3);
  } else {
    options.control.relative = options.control.absolute = contestant.setting;
  }
  options.max_steps = max_steps;
  return options;
}

template <class Model>
Solving integrate(const IntegrationOptions& options, const Scene& scene) {
  const auto integration = std::make_shared<Integration<Model>>(options);
  Solving solving{one_by_one(integration, scene), [integration] { return integration->evaluations(); }, {}};
  if constexpr (Model::dimension > 2)
    solving.drift = [integration, scene](const Design& design) {
      Model model;
      model.set(derive<double>(design));
      double worst = 0.0;
      typename Integration<Model>::Observer observer;
      observer.step = [&](const auto& integrator, double) {
        worst = std::max(worst, model.drift(integrator.step().y1));
      };
      integration->solve(design, scene, observer);
      return worst;
    };
  return solving;
}

Solving make_slipping(const Contestant& contestant, const Scene& scene, long max_steps) {
  if (contestant.model == RollingModel::energy_integral)
    return {coulomb::exact(scene, contestant.setting, {}), {}, {}};
  const auto integration = std::make_shared<CoulombIntegration>(options_of(contestant, max_steps));
  return {one_by_one(integration, scene), [integration] { return integration->evaluations(); }, {}};
}

}  // namespace

Solving solving_of(const Contestant& contestant, const Scene& scene, long max_steps) {
  if (scene.friction == Friction::coulomb) return make_slipping(contestant, scene, max_steps);
  const IntegrationOptions options = options_of(contestant, max_steps);
  switch (contestant.model) {
    case RollingModel::energy_integral:
      return {rolling::exact(scene, contestant.setting, {}), {}, {}};
    case RollingModel::multipliers:
      return integrate<Multipliers<false, false>>(options, scene);
    case RollingModel::multipliers_projected:
      return integrate<Multipliers<false, true>>(options, scene);
    case RollingModel::centre_of_mass:
      return integrate<Multipliers<true, false>>(options, scene);
    case RollingModel::centre_of_mass_projected:
      return integrate<Multipliers<true, true>>(options, scene);
    case RollingModel::one_coordinate:
      break;
  }
  return integrate<OneCoordinate>(options, scene);
}

}  // namespace leapmap
