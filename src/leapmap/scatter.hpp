// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// One design as manufactured: yield, distribution of its outcomes, influence of each tolerance.
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

/// Distribution of one quantity over the manufactured hoops that jump, in the map's unit.
struct MadeQuantity {
  std::string field{};  ///< name of the quantity
  Estimate mean{};      ///< mean
  Estimate sd{};        ///< standard deviation
  Estimate q05{};       ///< 5 % quantile
  Estimate q50{};       ///< median
  Estimate q95{};       ///< 95 % quantile
};

/// Sobol' indices: the fractions of a variance that are due to each tolerance.
struct Importance {
  std::string of{};               ///< "yield": all goals reached or not; "jumps": jumps or not; or a quantity
  std::vector<Estimate> first{};  ///< first-order index of each tolerance; NaN: nothing varies
  std::vector<Estimate> total{};  ///< total index of each tolerance
  /// Fraction of pairs of hoops that could be compared. Below 1 the indices of a quantity describe the
  /// variance among pairs in which both hoops jump.
  double pairs = 1.0;
};

/// Result of scatter. Vectors over tolerances follow spec.scatter.spreads, those over goals spec.goals.
struct ScatterReport {
  std::size_t samples = 0;                 ///< number of manufactured hoops
  Estimate yield{};                        ///< fraction that reaches every goal; NaN without goals
  Estimate jumps{};                        ///< fraction that jumps
  std::vector<Estimate> missed{};          ///< for each goal: fraction that misses it
  std::vector<double> cut_off{};           ///< for each tolerance: fraction of its law outside the domain
  std::vector<MadeQuantity> quantities{};  ///< those in output.fields; default: height and time
  std::vector<Importance> importance{};    ///< Sobol' indices of yield, jumps and quantities
  double unsolved = 0.0;                   ///< fraction that the method could not solve
  /// For each tolerance: factor by which it must shrink, the others unchanged, for a yield of 99 %. 1: it
  /// need not; 1e-6: below that; 0: even without it the yield is lower. Empty without goals.
  std::vector<double> shrink{};
  std::vector<double> without{};  ///< for each tolerance: yield if it were zero, the others unchanged
  double shrink_all = std::numeric_limits<double>::quiet_NaN();  ///< the factor for all tolerances together
  std::vector<Design> made{};       ///< the manufactured hoops, in the order of their replicates
  std::vector<Outcome> outcomes{};  ///< theirs: status, heights, and what goals and quantities need
};

/// Options of scatter.
struct ScatterOptions {
  int threads = 0;  ///< number of threads; 0: all that OpenMP offers
  /// Polled from any thread; if it returns true, scatter throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Samples spec.scatter.samples manufactured hoops around spec.design and solves them.
///
/// Sobol' points in 16 randomised replicates, whose differences give the standard errors. The Sobol' indices
/// take the same number of hoops again for each tolerance, and once more.
/// @throws InputError for a spec with axes or without tolerances, and as check_spec does; Stopped
ScatterReport scatter(const Spec& spec, const ScatterOptions& options = {});

}  // namespace leapmap
