// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "friction/coulomb_integration.hpp"
#include "friction/model.hpp"
#include "integrate/contestant.hpp"

namespace leapmap {

Solving friction::solving(const Contestant& contestant, const Scene& scene, long max_steps) {
  if (contestant.model == RollingModel::energy_integral)
    return {exact(scene, contestant.setting, {}), {}, {}};
  const auto integration = std::make_shared<CoulombIntegration>(options_of(contestant, max_steps));
  return {scene.jumps > 1 ? in_sequence(jumps_one_by_one<double>(integration, scene), scene)
                          : one_by_one(integration, scene),
          [integration] { return integration->evaluations(); },
          {}};
}

}  // namespace leapmap
