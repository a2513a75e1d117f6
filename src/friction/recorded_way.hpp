// SPDX-License-Identifier: GPL-3.0-or-later
/// Records the phases of a design with friction.
#pragma once

#include "friction/coulomb.hpp"
#include "trajectory/recorded_way.hpp"

namespace leapmap {

/// On the way to a jump from `at`, which is moved to just after its landing. Adds its phases to those that
/// are recorded.
Outcome recorded_way(CoulombSolver<double>& solver, Start start, const Design& design,
                     ContactState<double>& at, const Scene& scene, RecordedWay& recorded);

}  // namespace leapmap
