// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "integrate/contestant.hpp"
#include "integrate/rolling_integration.hpp"
#include "noslip/model.hpp"

namespace leapmap {
namespace {

template <class Model>
Solving integrate(const IntegrationOptions& options, const Scene& scene) {
  const auto integration = std::make_shared<Integration<Model>>(options);
  Solving solving{scene.jumps > 1 ? in_sequence(jumps_one_by_one<double>(integration, scene), scene)
                                  : one_by_one(integration, scene),
                  [integration] { return integration->evaluations(); },
                  {}};
  if constexpr (Model::dimension > 2)
    solving.drift = [integration, scene](const Design& design) {
      Model model;
      model.set(reduce<double>(design, scene));
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

}  // namespace

Solving noslip::solving(const Contestant& contestant, const Scene& scene, long max_steps) {
  const IntegrationOptions options = options_of(contestant, max_steps);
  switch (contestant.model) {
    case RollingModel::energy_integral:
      return {noslip::exact(scene, contestant.setting, {}), {}, {}};
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
