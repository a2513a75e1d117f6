// SPDX-License-Identifier: GPL-3.0-or-later
/// From a question to designs: which hoop reaches its goals best?
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "leapmap/boundaries.hpp"
#include "leapmap/design.hpp"
#include "leapmap/estimate.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// The derivatives of a field by every parameter (leapmap/gradient.hpp).
struct FieldGradient {
  std::string of{};
  Design by{};
};

struct FoundDesign {
  Design design{};
  Outcome outcome{};
  std::vector<double>
      objectives{};  ///< in the order of the spec, those to maximize first, in their own units
  Estimate yield{};  ///< with [scatter] and goals: share of the hoops made that reach them all
  /// What keeps it from being better, in words: bounds of parameters, goals, the kind of cliff.
  std::vector<std::string> binds{};
  // Of one objective:
  std::vector<NearCliff> cliff{};          ///< the nearest in the box, if there is one
  std::vector<FieldGradient> gradients{};  ///< of the quantities that objectives and goals name
};

struct FoundDesigns {
  /// Best first, each the best of a basin of its own; of two objectives the front, in order of the first.
  std::vector<FoundDesign> designs{};
  bool reached = false;  ///< false: no design met reaches every goal, and designs holds the nearest miss
  std::vector<double> missed{};  ///< of the nearest miss: each goal's field there, in the order of the goals
  std::size_t evaluations = 0;   ///< designs solved
  double seconds = 0.0;
  /// Of two objectives: the share of the box spanned by the front's ends that the front is better than.
  double hypervolume = std::numeric_limits<double>::quiet_NaN();
  bool engines = false;  ///< whether pagmo and NLopt took part: a build may be without
};

struct FindOptions {
  std::uint64_t seed = 1;  ///< the same seed, the same designs, whatever the number of threads
  std::size_t most = 0;    ///< designs told; 0: 8, of a front 2,048
  std::size_t sample = 0;  ///< designs of the first, dense sample; 0: as many as take about a second
  int threads = 0;         ///< 0: as many as OpenMP offers
  /// Told the steps done and their number, from the caller's thread.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Asked now and then, from any thread; true: find_designs throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Looks through the box of the spec's free axes: a dense Sobol' sample first, then from its best places by
/// pagmo's CMA-ES (of two objectives NSGA-II), NLopt's SLSQP with exact derivatives, and steps along cliffs
/// and goals that never pass them. Every design told reaches every goal, as the solver sees it alone. Throws
/// InputError for a spec that has nothing to choose, nothing to be best at, or goals that contradict each
/// other; and as check_spec does.
FoundDesigns find_designs(const Spec& spec, const FindOptions& options = {});

/// The designs found as a list that sweep takes, in the question's scene.
Spec list_of(const Spec& question, const FoundDesigns& found);

}  // namespace leapmap
