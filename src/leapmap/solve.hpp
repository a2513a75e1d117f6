// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves designs: one, or many on all cores.
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

struct SolveOptions {
  std::string method = "auto";  ///< "auto", "exact" or a stepper's name, for example "gsl-rk8pd"
  double tolerance = 1e-10;     ///< exact: relative error allowed in times; a stepper: per step
  long max_steps = 1'000'000;   ///< of a stepper; a design that needs more has status failed
  int threads = 0;              ///< 0: as many as OpenMP offers
  /// Asked now and then, from any thread; true: solve throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Solves one design. A design that cannot be solved has status failed and a reason; an input that is no hoop
/// throws InputError, naming the parameter, its value and what is allowed.
Outcome solve(const Design& design, const Scene& scene = {}, const SolveOptions& options = {});

/// Solves many, outcomes in the order of the designs. How many threads there were does not show in any bit;
/// times may differ within the tolerance from those of a design solved alone. Throws InputError, naming the
/// design's number too.
std::vector<Outcome> solve(std::span<const Design> designs, const Scene& scene = {},
                           const SolveOptions& options = {});

/// The same into outcomes, as many as designs.
void solve_into(std::span<Outcome> outcomes, std::span<const Design> designs, const Scene& scene = {},
                const SolveOptions& options = {});

}  // namespace leapmap
