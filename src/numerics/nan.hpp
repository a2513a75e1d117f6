// SPDX-License-Identifier: GPL-3.0-or-later
/// The number of what does not apply or is not known.
#pragma once

#include <limits>

namespace leapmap {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace leapmap
