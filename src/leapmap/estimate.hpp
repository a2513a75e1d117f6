// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// A number with its standard error.
#pragma once

#include <limits>

namespace leapmap {

/// A statistical estimate.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< the estimate; NaN: does not apply
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: not determined
};

}  // namespace leapmap
