// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Derivatives of outcomes by the parameters of a design, by dual numbers, to machine precision.
#pragma once

#include <span>
#include <vector>

#include "leapmap/solve.hpp"

namespace leapmap {

/// Differentiates one quantity of an outcome by each parameter of the design.
///
/// A derivative is NaN if the quantity does not apply; if it is infinite or known to fewer than six digits,
/// as near a fold, at which a lift-off appears; and for parameters that the scene's model does not have. If
/// mu_kinetic is not given or equal to mu_static, the derivative by mu_static is of both, and that by
/// mu_kinetic is NaN. At the end of a parameter's range the derivative is one-sided.
/// @param of  the quantity, for example &Outcome::jump_height
/// @return  the derivative by each parameter, in the member of that parameter, in the quantity's unit over
///          the parameter's unit (angles in rad)
/// @throws InputError as solve does, and for any method but exact
/// @note Thread-safe.
Design gradient(const Design& design, const OutcomeNumber& of, const Scene& scene = {},
                const SolveOptions& options = {});

/// Differentiates for many designs on all cores.
/// @return  one element for each design, in their order
/// @throws InputError as for one design, with the design's number; Stopped
std::vector<Design> gradient(std::span<const Design> designs, const OutcomeNumber& of,
                             const Scene& scene = {}, const SolveOptions& options = {});

}  // namespace leapmap
