// SPDX-License-Identifier: GPL-3.0-or-later
/// The model with Coulomb friction and Poisson restitution: a hoop rolls, slides, flies, lands and hops on
/// until a flight reaches hop_height (contact_phases.hpp).
#pragma once

#include <functional>

#include "leapmap/motion.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/recorded_way.hpp"
#include "trajectory/sequence_gradient.hpp"
#include "trajectory/solver.hpp"

namespace leapmap::friction {

/// Rolling by its energy integral, sliding by quadratures, flights in closed form. tolerance: relative, of
/// times.
Solver exact(const Scene& scene, double tolerance, const Wanted& wanted);

/// The same from any state to the next jump's landing.
JumpSolver<double> jumps(const Scene& scene, double tolerance, const Wanted& wanted);

/// The same from landing to landing, each design as fast as it goes.
LongJumpSolver<double> long_jumps(const Scene& scene, double tolerance, const Wanted& wanted);

/// The same with derivatives (gradient.hpp).
GradientSolver gradients(const Scene& scene, double tolerance, const Wanted& wanted,
                         const GradientWanted& asked);

/// One jump after the other with derivatives.
DualJumpSolver<DesignDual> dual_jumps(const Scene& scene, double tolerance);
DualJumpSolver<StateDual> state_jumps(const Scene& scene, double tolerance);

/// A design's share of the work (model/model.hpp).
std::function<double(const Design&)> effort(const Scene& scene, bool derivatives);

/// By integration in time (coulomb_integration.hpp).
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

/// The same by integration in time.
Motion tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                           double interval = 0.0);

/// For studies, with two models: the energy integral and what else exact solves in closed form, and one
/// coordinate and the slip, integrated. max_steps: a design that needs more is given up as failed.
Solving solving(const Contestant& contestant, const Scene& scene, long max_steps);

}  // namespace leapmap::friction
