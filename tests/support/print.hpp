// SPDX-License-Identifier: GPL-3.0-or-later
/// How GoogleTest names parameters of tests.
#pragma once

#include <ostream>

#include "numerics/gsl_integrator.hpp"

namespace leapmap {

inline void PrintTo(const GslStepper& stepper, std::ostream* out) { *out << stepper.name; }

}  // namespace leapmap
