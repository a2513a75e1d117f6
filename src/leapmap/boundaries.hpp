// SPDX-License-Identifier: GPL-3.0-or-later
/// Cliffs: where the outcome of a grid of designs jumps, to rounding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// What happens at a cliff.
enum class CliffKind : std::uint8_t {
  threshold,   ///< a lift-off's height passes hop_height: the jump passes to another lift-off
  fold,        ///< a lift-off is born: the normal force touches zero
  runway,      ///< a lift-off passes the runway's end
  turn,        ///< the hoop just turns round
  release,     ///< the plane just has to pull at the release
  phase,       ///< with friction: a phase appears or vanishes
  painleve,    ///< with friction: sliding comes to where rigid bodies have no answer or two
  unresolved,  ///< above it the method gives up: where it does is not looked for
};
inline constexpr int cliff_kinds = 8;
std::string_view name_of(CliffKind kind);

/// A design's outcome as far as it is discrete.
struct Discrete {
  Status status = Status::not_computed;
  std::uint8_t jumps_on = 0;  ///< the number of the lift-off that is the jump; 0: none is
  std::uint8_t spurious_first_jump = Outcome::no_lift_off;
  std::uint64_t phase_sequence = 0;  ///< where sequences are told apart; else 0

  bool operator==(const Discrete&) const = default;
};

/// One place on an edge of the grid: below it, towards the lesser value, the outcome is one, above another.
struct Cliff {
  std::size_t design;  ///< the grid's design below the edge, in C order
  std::size_t axis;    ///< along which the edge leads to its neighbour
  double value;        ///< of that axis's parameter: the last below
  CliffKind kind;
  Discrete below, above;
};

/// A curve in the plane of two axes: cliffs of one kind between the same two outcomes, one after the
/// other.
struct CliffCurve {
  CliffKind kind;
  /// Places in Boundaries::cliffs. An end where three outcomes meet is `meeting`, which is known only to
  /// its cell of the grid: the middle of what leads to it.
  std::vector<std::size_t> cliffs;
  std::vector<double> meeting_from, meeting_to;  ///< there, along the plane's axes; empty: it just ends
};

struct Boundaries {
  std::vector<Axis> axes;
  std::vector<std::size_t> plane;  ///< the two axes with the most values, in their order; empty: there is one
  std::vector<Cliff> cliffs;       ///< in order of axis, design and value
  std::vector<CliffCurve> curves;  ///< in that plane, for all values of the other axes, in the grid's order
};

/// Where along its axes a cliff lies.
std::vector<double> place_of(const Boundaries& boundaries, const Cliff& cliff);

struct BoundaryOptions {
  bool phases = false;  ///< with friction: sequences of phases are told apart, too
  int threads = 0;      ///< 0: as many as OpenMP offers
  /// Called now and then with designs and edges done and their number, from one thread at a time.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Asked now and then, from any thread; true: find_boundaries throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Most designs of a grid whose cliffs are looked for: their outcomes are kept in memory.
inline constexpr std::size_t most_bounded_designs = 200'000'000;

/// Solves the grid of the spec, and bisects every edge between neighbours whose discrete outcomes differ
/// until no number is left between. Where the outcomes beside a cliff are not those of the two designs, there
/// are more on that edge, and they are found too. What begins and ends between two neighbours with the same
/// outcome is not seen. Throws InputError for a list, for a grid without two values along some axis or with
/// too many designs, and as sweep does.
Boundaries find_boundaries(const Spec& spec, const BoundaryOptions& options = {});

/// A cliff seen from a design: how far it is and what lies beyond.
struct NearCliff {
  std::vector<double> at;  ///< along the spec's axes
  double distance;         ///< in shares of the axes' ranges; of logarithms, where values are spaced so
  CliffKind kind;
  Discrete beyond;
};

/// The cliffs nearest to a design within the ranges of the spec's axes: along each axis, and over all
/// directions. A band narrower than a thousandth of a range, or in all some hundredths of the way, may be
/// passed over.
struct NearCliffs {
  std::vector<std::vector<NearCliff>> along;  ///< of each axis: none, one or two, nearest first
  std::vector<NearCliff> nearest;             ///< none or one
};
NearCliffs near_cliffs(const Spec& spec, const Design& design);

}  // namespace leapmap
