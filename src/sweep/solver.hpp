// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves designs by the method that a spec asks for.
#pragma once

#include <functional>
#include <span>

#include "leapmap/outcome.hpp"
#include "sweep/spec.hpp"

namespace leapmap {

/// Solves designs[i] into outcomes[i]. Owns its workspace: one a thread.
using Solver = std::function<void(std::span<const Design> designs, std::span<Outcome> outcomes)>;

/// The solver of spec.numerics.method. What spec.output.fields leaves out need not be computed, and may be
/// NaN.
Solver make_solver(const Spec& spec);

/// The solver of a method other than the spec's: exact at that tolerance, or one of GSL's steppers.
Solver make_solver(const Spec& spec, std::string_view method, double tolerance);

}  // namespace leapmap
