// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Conversion of units.
#pragma once

#include <numbers>

namespace leapmap {

/// Converts degrees to radians.
constexpr double degrees(double angle) { return angle * std::numbers::pi / 180.0; }

}  // namespace leapmap
