// SPDX-License-Identifier: GPL-3.0-or-later
/// A method that judges another's outcomes, and what it is itself unsure about.
#pragma once

#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "spec/spec.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// Of the integrations that audit exact.
inline constexpr double audit_tolerance = 1e-13, coarser_tolerance = 1e-12;
/// How much errors may have grown: an integration's own, 1e-11, then leaves six digits.
inline constexpr double audited_growth = 1e5;

/// A method at a fine tolerance, and at a coarser one.
struct AuditSolver {
  Solver solve, coarser;
};

/// Solves one design.
Outcome solved(const Solver& solve, const Design& design);

/// What a judge itself makes of the design with one unit in the last place of each input changed, and at a
/// coarser tolerance; with `farther` also with the inputs changed by as much as its own error, by which it
/// may see a flag flip. The solver under audit has no say in it.
std::vector<Outcome> outcomes_beside(const AuditSolver& judge, const Design& design, const Spec& spec,
                                     bool farther);

}  // namespace leapmap
