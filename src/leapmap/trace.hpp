// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// The motion of one design over time.
#pragma once

#include <string>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/motion.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// Options of trace.
struct TraceOptions {
  double interval = 1e-3;       ///< between samples [s], >= 0; 0: phases and lift-offs only
  std::string method = "auto";  ///< "auto", "exact" or a stepper's name, for example "gsl-rk8pd"
  double tolerance = 1e-10;     ///< exact: relative error allowed in times; stepper: per step; in (0, 0.1]
  long max_steps = 1'000'000;   ///< of a stepper
};

/// Solves one design and samples its motion at every interval, and at the jump's lift-off and landing.
/// @throws InputError as solve does, and for more than 10^7 samples
/// @note Thread-safe.
Motion trace(const Design& design, const Scene& scene = {}, const TraceOptions& options = {});

}  // namespace leapmap
