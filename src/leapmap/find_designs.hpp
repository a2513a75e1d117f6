// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Search for the designs that reach given goals best.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "leapmap/boundaries.hpp"
#include "leapmap/design.hpp"
#include "leapmap/estimate.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"
#include "leapmap/worst_case.hpp"

namespace leapmap {

/// The derivatives of one field by every parameter; see leapmap/gradient.hpp.
struct FieldGradient {
  std::string of{};               ///< name of the field
  Design by{};                    ///< each member holds the derivative by that parameter
  std::vector<double> by_free{};  ///< those by the free parameters, in the spec's order
};

/// One design that the search found. Of parameters in design.nominal_units, `free` and FieldGradient::by_free
/// are in units of the nominal hoop, `design` and FieldGradient::by in its own.
struct FoundDesign {
  Design design{};                   ///< its parameters
  std::vector<double> free{};        ///< its values of the free parameters, in the spec's order
  Outcome outcome{};                 ///< its nominal outcome
  std::vector<double> objectives{};  ///< in the spec's order, those to maximize first, in their own units
  Estimate yield{};  ///< with [scatter] and goals: fraction of manufactured hoops that reach all goals
  std::optional<WorstCase> worst{};  ///< if worst_case is a goal or an objective: what is proved of it
  std::vector<std::string> binds{};  ///< active constraints in words: bounds, goals, discontinuities
  // With one objective:
  std::vector<NearCliff> cliff{};          ///< the nearest discontinuity within the bounds, if any
  std::vector<FieldGradient> gradients{};  ///< of the fields that objectives and goals name
};

/// Result of find_designs.
struct FoundDesigns {
  /// With one objective: the best design of each separate region, best first. With two: the Pareto front, in
  /// the order of the first objective.
  std::vector<FoundDesign> designs{};
  bool reached = false;  ///< false: no design reaches every goal, and `designs` holds the nearest miss
  std::vector<double> missed{};  ///< values of the goals' fields at the nearest miss, in the units of their
                                 ///< limits and the order of goals
  std::size_t evaluations = 0;   ///< number of designs solved
  double seconds = 0.0;          ///< duration [s]
  /// With two objectives: fraction of the rectangle between the front's ends that the front dominates.
  double hypervolume = std::numeric_limits<double>::quiet_NaN();
};

/// Options of find_designs.
struct FindOptions {
  std::uint64_t seed = 1;  ///< equal seeds give equal designs, for any number of threads
  std::size_t most = 0;    ///< largest number of designs returned; 0: 8, or 2,048 for a front
  std::size_t sample = 0;  ///< designs in the initial sample; 0: 2^21, with friction 2^18,
                           ///< fewer with tolerances
  int threads = 0;         ///< number of threads; 0: all that OpenMP offers
  /// Receives the number of steps done and their total, from the caller's thread.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Polled from any thread; if it returns true, find_designs throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Searches the bounds of the spec's free parameters for the designs that reach its goals best.
///
/// Starts with a dense Sobol' sample. From its best points it continues by NLopt's SLSQP with exact
/// derivatives, and by random steps whose shape follows past successes. Then it steps along discontinuities
/// and goals, and never crosses them. Every design returned reaches every goal when it is solved alone.
/// @throws InputError for a spec without a free parameter, without an objective or with goals that contradict
///         each other, and as check_spec does; Stopped
FoundDesigns find_designs(const Spec& spec, const FindOptions& options = {});

/// The designs found as a spec that sweep takes: a list, in the scene of the design problem.
Spec list_of(const Spec& question, const FoundDesigns& found);

}  // namespace leapmap
