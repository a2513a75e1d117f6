// SPDX-License-Identifier: GPL-3.0-or-later
/// One design as made, many times over: how likely it does what it must, and which tolerance matters.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/estimate.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// A quantity of the made hoops that jump, in the map's unit.
struct MadeQuantity {
  std::string field{};
  Estimate mean{}, sd{}, q05{}, q50{}, q95{};
};

/// How much of something's variance the scattered parameters bring.
struct Importance {
  /// "yield": every goal is reached or not; "jumps": it jumps or not; or a quantity, of the hoops that jump.
  std::string of{};
  std::vector<Estimate> first{};  ///< of each spread: by itself. NaN: nothing varies
  std::vector<Estimate> total{};  ///< of each spread: with all that it does together with others
  /// The least share of pairs of hoops that could be compared. Below 1 the indices of a quantity are of the
  /// variance among pairs that both jump.
  double pairs = 1.0;
};

struct ScatterReport {
  std::size_t samples = 0;
  Estimate yield{};                        ///< share that reaches every goal; NaN without goals
  Estimate jumps{};                        ///< share that jumps
  std::vector<Estimate> missed{};          ///< of each goal: the share that misses it
  std::vector<double> cut_off{};           ///< of each spread: the share of its law that no hoop can have
  std::vector<MadeQuantity> quantities{};  ///< those that output.fields names; by default height and time
  std::vector<Importance> importance{};
  double unsolved = 0.0;  ///< share that the method gave up on, of which nothing is known
  /// Of each spread: to what share of its width it has to shrink, the others staying as they are, for 99 %
  /// yield. 1: it need not; 1e-6: to less than that; 0: not even without it. Empty without goals.
  std::vector<double> shrink{};
  std::vector<double> without{};  ///< of each spread: the yield if it did not scatter, the others staying
  double shrink_all = std::numeric_limits<double>::quiet_NaN();  ///< the same of all spreads together
  // The hoops, in the order of their replicates.
  std::vector<Design> made{};
  std::vector<Outcome> outcomes{};  ///< status, heights, and what goals and quantities need
};

struct ScatterOptions {
  int threads = 0;  ///< 0: as many as OpenMP offers
  /// Asked now and then, from any thread; true: scatter throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Makes spec.scatter.samples hoops after spec.design, and as many again for each spread and once more, and
/// solves them. Sobol' points, moved at random in 16 replicates, which tell the errors. Order of everything:
/// as spec.scatter.spreads and spec.goals have it. Throws InputError for a spec with axes or without
/// scatter, and as check_spec does.
ScatterReport scatter(const Spec& spec, const ScatterOptions& options = {});

}  // namespace leapmap
