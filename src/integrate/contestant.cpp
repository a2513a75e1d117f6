// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrate/contestant.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/game_steppers.hpp"

namespace leapmap {

std::string_view name_of(RollingModel model) {
  constexpr std::array<std::string_view, 6> names{"energy integral", "one coordinate",
                                                  "multipliers",     "multipliers, projected",
                                                  "centre of mass",  "centre of mass, projected"};
  return names[static_cast<std::size_t>(model)];
}

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

}  // namespace leapmap
