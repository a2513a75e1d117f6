// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

namespace leapmap {

/// The angle in radians of one given in degrees.
constexpr double degrees(double angle) { return angle * std::numbers::pi / 180.0; }

}  // namespace leapmap
