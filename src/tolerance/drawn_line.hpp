// SPDX-License-Identifier: GPL-3.0-or-later
/// Lines of drawings in a map.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "leapmap/design.hpp"

namespace leapmap {

/// The drawings of a line are those from the first on that differ in one parameter, which ascends or
/// descends.
struct DrawnLine {
  std::size_t count = 1;
  std::size_t place = 0;      ///< of the parameter among a design's numbers
  std::vector<double> along;  ///< its values; empty: there is but one drawing
};
DrawnLine line_of(std::span<const Design> drawings);

}  // namespace leapmap
