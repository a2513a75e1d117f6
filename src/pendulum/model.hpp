// SPDX-License-Identifier: GPL-3.0-or-later
/// The model of a hoop with a driven pendulum on its axis, without slip and with friction. It is integrated;
/// there is no exact solver, and there are no derivatives.
#pragma once

#include <string_view>

#include "leapmap/motion.hpp"
#include "trajectory/sequence.hpp"
#include "trajectory/solver.hpp"

namespace leapmap::pendulum {

/// With which method = "auto" integrates.
inline constexpr std::string_view usual_stepper = "gsl-rk8pd";

/// By integration in time (solver.hpp).
leapmap::Solver integration(const Scene& scene, const IntegrationOptions& options);

/// The same to a tolerance, and what the way to the jump asks of motor and plane. The states are not used:
/// there is no jump after the first.
JumpSolver<double> ways(const Scene& scene, double tolerance);

/// One design's motion, sampled every `interval` [s]; 0: not sampled.
Motion tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                           double interval);

}  // namespace leapmap::pendulum
