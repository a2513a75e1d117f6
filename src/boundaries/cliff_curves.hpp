// SPDX-License-Identifier: GPL-3.0-or-later
/// Cliffs on the edges of a grid as curves through its cells: marching squares.
#pragma once

#include "leapmap/boundaries.hpp"

namespace leapmap {

/// The curves in boundaries.plane, plane by plane.
std::vector<CliffCurve> curves_of(const Boundaries& boundaries);

}  // namespace leapmap
