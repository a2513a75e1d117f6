// SPDX-License-Identifier: GPL-3.0-or-later
/// The model that never slips (the paper's): a hoop rolls until the plane would have to pull, and flies on
/// from there. A lift-off that stays below hop_height is counted, and the hoop taken to roll on.
#pragma once

#include <functional>

#include "leapmap/motion.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/recorded_way.hpp"
#include "trajectory/sequence_gradient.hpp"
#include "trajectory/solver.hpp"

namespace leapmap::noslip {

/// By the energy integral (exact.hpp), in lanes. tolerance: relative, of times.
Solver exact(const Scene& scene, double tolerance, const Wanted& wanted);

/// The same from any state to the next jump's landing.
JumpSolver<double> jumps(const Scene& scene, double tolerance, const Wanted& wanted);

/// The same with derivatives (gradient.hpp).
GradientSolver gradients(const Scene& scene, double tolerance, const Wanted& wanted,
                         const GradientWanted& asked);

/// One jump after the other with derivatives.
DualJumpSolver<DesignDual> dual_jumps(const Scene& scene, double tolerance);
DualJumpSolver<StateDual> state_jumps(const Scene& scene, double tolerance);

/// A design's share of the work (model/model.hpp).
std::function<double(const Design&)> effort(const Scene& scene, bool derivatives);

/// By integration in time (rolling_integration.hpp).
Solver integration(const Scene& scene, const IntegrationOptions& options);

/// The same from any state to the next jump's landing.
JumpSolver<double> integrated_jumps(const Scene& scene, const IntegrationOptions& options);

/// The exact solver in long double: a reference for studies and tests.
Outcome refined(const Design& design, const Scene& scene);

/// As `jumps`, and tells what the way to each jump asks of hoop and motor.
JumpSolver<double> ways(const Scene& scene, double tolerance);

/// One design's motion by the exact solver, no integrator needed. interval > 0: sampled that often [s], and
/// at the jump's lift-off and landing; infinite: those two only. Throws InputError if that would be more than
/// 10^7 samples.
Motion tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval = 0.0);

/// One design's phases, up to the last jump asked for or to where the search ends.
Outcome record(const Design& design, const Scene& scene, double tolerance, RecordedWay& recorded);

/// The same by integration in time, with grazes whose normal force is below graze_limit [weights].
Motion tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                           double interval = 0.0, double graze_limit = 1e-6);

/// For studies. max_steps: a design that needs more is given up as failed.
Solving solving(const Contestant& contestant, const Scene& scene, long max_steps);

}  // namespace leapmap::noslip
