// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/gsl_integrator.hpp"

#include <gsl/gsl_errno.h>

#include <algorithm>
#include <array>

namespace leapmap {

std::span<const GslStepper> gsl_steppers() {
  static const std::array<GslStepper, 11> steppers{{
      {"gsl-rk2", gsl_odeiv2_step_rk2, false, false, 3},
      {"gsl-rk4", gsl_odeiv2_step_rk4, false, false, 4},
      {"gsl-rkf45", gsl_odeiv2_step_rkf45, false, false, 5},
      {"gsl-rkck", gsl_odeiv2_step_rkck, false, false, 5},
      {"gsl-rk8pd", gsl_odeiv2_step_rk8pd, false, false, 8},
      {"gsl-rk1imp", gsl_odeiv2_step_rk1imp, true, false, 1},
      {"gsl-rk2imp", gsl_odeiv2_step_rk2imp, true, false, 2},
      {"gsl-rk4imp", gsl_odeiv2_step_rk4imp, true, false, 4},
      {"gsl-bsimp", gsl_odeiv2_step_bsimp, true, false, 0},
      {"gsl-msadams", gsl_odeiv2_step_msadams, false, true, 0},
      {"gsl-msbdf", gsl_odeiv2_step_msbdf, true, true, 0},
  }};
  return steppers;
}

const GslStepper* find_gsl_stepper(std::string_view name) {
  const auto steppers = gsl_steppers();
  const auto found = std::ranges::find(steppers, name, &GslStepper::name);
  return found == steppers.end() ? nullptr : &*found;
}

void silence_gsl() {
  static const bool silenced = (gsl_set_error_handler_off(), true);
  static_cast<void>(silenced);
}

}  // namespace leapmap
