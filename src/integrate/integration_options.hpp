// SPDX-License-Identifier: GPL-3.0-or-later
/// How a design is integrated in time.
#pragma once

#include <string_view>

#include "numerics/gsl_integrator.hpp"

namespace leapmap {

struct IntegrationOptions {
  const GslStepper* stepper = nullptr;  ///< never null when used
  StepControl control;
  long max_steps = 1'000'000;  ///< a design that needs more is given up as failed
};

/// Adaptive steps of the stepper of that name, which must be one of GSL's, with both tolerances the same.
inline IntegrationOptions adaptive(std::string_view stepper, double tolerance) {
  IntegrationOptions options;
  options.stepper = find_gsl_stepper(stepper);
  options.control.relative = options.control.absolute = tolerance;
  return options;
}

}  // namespace leapmap
