// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives of outcomes by the parameters of a design, to rounding: by dual numbers, not by differences.
#pragma once

#include <span>
#include <vector>

#include "leapmap/solve.hpp"

namespace leapmap {

/// The derivatives of one quantity of an outcome, &Outcome::jump_height say, by each parameter of the design,
/// in the place where the design has that parameter: in the quantity's unit (hoop diameters, s, ...) over the
/// parameter's (rad, ...). Of a parameter that is at the end of its range it is the one-sided derivative.
///
/// NaN where the quantity does not apply; where the derivative is infinite, as on a fold, where a lift-off
/// appears, or so nearly that it is not known to six digits; by parameters that the scene's model has not;
/// and by mu_kinetic where that is not given or equal to mu_static, which it then follows: the derivative by
/// mu_static is of both. Method exact only.
/// Throws as solve does.
Design gradient(const Design& design, const OutcomeNumber& of, const Scene& scene = {},
                const SolveOptions& options = {});

/// Those of many designs, on all cores, in their order.
std::vector<Design> gradient(std::span<const Design> designs, const OutcomeNumber& of,
                             const Scene& scene = {}, const SolveOptions& options = {});

}  // namespace leapmap
