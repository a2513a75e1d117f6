// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves designs by the method that a spec asks for.
#pragma once

#include <string_view>

#include "leapmap/motion.hpp"
#include "sweep/spec.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/integration_options.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// The stepper and its controls that numerics asks for, where the method is one of GSL's.
IntegrationOptions integration_options(const Numerics& numerics);

/// The solver of spec.numerics.method. What spec.output.fields leaves out need not be computed, and may be
/// NaN.
Solver make_solver(const Spec& spec);

/// The spec's scene; of the first jump alone, where nothing is asked for of later ones.
Scene scene_asked(const Spec& spec);

/// The same with as many jumps as are followed in all: of those asked for gaits until they have settled.
Scene scene_followed(const Spec& spec);

/// Which derivatives the spec asks for.
GradientWanted gradients_of(const Spec& spec);

/// The same with the derivatives that the spec asks for, if any.
GradientSolver make_gradient_solver(const Spec& spec);

/// The solver of a method other than the spec's: exact at that tolerance, or one of GSL's steppers.
Solver make_solver(const Spec& spec, std::string_view method, double tolerance);

/// The motion of the spec's design by its method, with every field of its outcome, sampled every `interval`
/// [s]; 0: not sampled.
Motion tell(const Spec& spec, double interval);

/// Its phases and lift-offs by another method, as make_solver has it.
Motion tell(const Spec& spec, std::string_view method, double tolerance);

}  // namespace leapmap
