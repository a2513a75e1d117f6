// SPDX-License-Identifier: GPL-3.0-or-later
/// Sobol's sequence of points that fill a cube evenly, as GSL has it.
#pragma once

#include <cstddef>
#include <vector>

namespace leapmap {

inline constexpr std::size_t most_sobol_dimensions = 40;

/// The sequence's first points, of which the very first is zero: the coordinates of a point one after the
/// other, in [0, 1) and whole numbers of 2^-30. dimensions: 1 to most_sobol_dimensions.
std::vector<double> sobol_sequence(std::size_t dimensions, std::size_t count);

}  // namespace leapmap
