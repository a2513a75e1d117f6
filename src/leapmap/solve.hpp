// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Solving designs: one, or many on all cores.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// Options of solve and gradient.
struct SolveOptions {
  std::string method = "auto";  ///< "auto", "exact" or a stepper's name, for example "gsl-rk8pd"
  double tolerance = 1e-10;     ///< exact: relative error allowed in times; stepper: per step; in (0, 0.1]
  long max_steps = 1'000'000;   ///< of a stepper; a design that needs more gets status failed
  int threads = 0;              ///< number of threads; 0: all that OpenMP offers
  /// Polled from any thread; if it returns true, solve throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Solves one design.
/// @return  the outcome; a design that the method cannot solve has status failed and a reason
/// @throws InputError, with parameter, value and what is allowed, for an invalid design, scene or option;
///         Stopped
/// @note Thread-safe.
Outcome solve(const Design& design, const Scene& scene = {}, const SolveOptions& options = {});

/// Solves many designs on all cores.
///
/// The result does not depend on the number of threads in any bit. Times may differ, within the tolerance,
/// from those of a design that is solved alone.
/// @return  one outcome for each design, in their order
/// @throws InputError as for one design, with the design's number; Stopped
std::vector<Outcome> solve(std::span<const Design> designs, const Scene& scene = {},
                           const SolveOptions& options = {});

/// Solves many designs into existing outcomes.
/// @param outcomes  of the same size as `designs`
/// @throws InputError as for one design, with the design's number, or if the sizes differ; Stopped, after
///   which the outcomes mean nothing
void solve_into(std::span<Outcome> outcomes, std::span<const Design> designs, const Scene& scene = {},
                const SolveOptions& options = {});

}  // namespace leapmap
