// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves designs by the method of a request.
#pragma once

#include "integrate/integration_options.hpp"
#include "leapmap/motion.hpp"
#include "request/request.hpp"
#include "tolerance/scatter_solver.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// The stepper and its controls that numerics asks for, where the method is one of GSL's.
IntegrationOptions integration_options(const Numerics& numerics, const Scene& scene);

/// The solver of the request's method, for all but derivatives and statistics.
Solver make_solver(const Request& request);

/// Fills in what comes of whole flights and sequences, once the designs are solved; empty: nothing of that is
/// asked for.
Solver follow_up(const Request& request);

/// The same with the derivatives among the columns, if any.
GradientSolver make_gradient_solver(const Request& request);

/// Whether manufactured hoops may be interpolated along an axis: if one takes long to solve, and its phases
/// help to find discontinuities. If the worst case is asked for, all are solved.
bool can_be_interpolated(const Request& request);
/// The axis along which they are in a spec's map; empty: every hoop is solved.
std::string_view interpolated_along(const Spec& spec, const Request& request);

/// A solver for the request's statistics of manufactured hoops, after these points. make: of what solves the
/// hoops.
ScatterSolver scatter_solver_of(const Request& request, std::shared_ptr<const SobolPoints> points,
                                const std::function<Solver(const Request&)>& make = make_solver);

/// The motion of a design by the request's method, sampled every `interval` [s]; 0: not sampled.
Motion tell(const Design& design, const Request& request, double interval);

}  // namespace leapmap
