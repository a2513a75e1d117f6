// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion over time.
#pragma once

#include <string>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/motion.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

struct TraceOptions {
  double interval = 1e-3;       ///< between samples [s]; 0: none, only phases and lift-offs
  std::string method = "auto";  ///< "auto", "exact" or a stepper's name, for example "gsl-rk8pd"
  double tolerance = 1e-10;     ///< exact: relative error allowed in times; a stepper: per step
  long max_steps = 1'000'000;   ///< of a stepper
};

/// Solves one design and samples its motion every interval, and at the jump's lift-off and landing. Throws
/// InputError for what is no hoop, and if that would be more than 10^7 samples.
Motion trace(const Design& design, const Scene& scene = {}, const TraceOptions& options = {});

}  // namespace leapmap
