// SPDX-License-Identifier: GPL-3.0-or-later
/// Steps as game engines take them, as stepper types of gsl_odeiv2: for contrast in studies, not for sweeps.
#pragma once

#include <span>

#include "numerics/gsl_integrator.hpp"

namespace leapmap {

/// euler (explicit), semi-implicit-euler (velocities first, then positions by the new ones) and
/// velocity-verlet (with a predicted velocity where the acceleration depends on it). The state's first half
/// are positions, its second half their velocities. They estimate no error: for fixed steps only.
std::span<const GslStepper> game_steppers();

}  // namespace leapmap
