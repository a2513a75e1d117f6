// SPDX-License-Identifier: GPL-3.0-or-later
/// A number known with an error.
#pragma once

#include <limits>

namespace leapmap {

struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  ///< a standard error; NaN: it cannot be told
};

}  // namespace leapmap
