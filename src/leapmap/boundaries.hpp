// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Discontinuities of the outcome over a grid of designs ("cliffs"), located to machine precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// Cause of a discontinuity.
enum class CliffKind : std::uint8_t {
  threshold,   ///< a lift-off's height crosses hop_height, so that another lift-off becomes the jump
  fold,        ///< a lift-off appears: a minimum of the normal force touches zero
  runway,      ///< a lift-off crosses the rolling limit
  turn,        ///< the hoop barely reverses its direction
  release,     ///< the normal force at the release is zero
  phase,       ///< with friction: a contact phase appears or vanishes
  painleve,    ///< with friction: sliding reaches Painleve's paradox
  unresolved,  ///< the method fails beyond it: the cause is unknown
};
/// Number of kinds of discontinuities.
inline constexpr int cliff_kinds = 8;
/// The kind's name in files and messages, for example "fold".
std::string_view name_of(CliffKind kind);

/// The discrete part of an outcome.
struct Discrete {
  Status status = Status::not_computed;                     ///< how the design ended
  std::uint8_t jumps_on = 0;                                ///< number of the lift-off that jumps; 0: none
  std::uint8_t spurious_first_jump = Outcome::no_lift_off;  ///< as in Outcome
  std::uint64_t phase_sequence = 0;                         ///< 0 unless BoundaryOptions::phases

  /// Whether all four are equal.
  bool operator==(const Discrete&) const = default;
};

/// One discontinuity on an edge of the grid, between two neighbouring designs.
struct Cliff {
  std::size_t design;  ///< number of the design at the edge's lower end, in C order
  std::size_t axis;    ///< axis along which the edge runs
  double value;        ///< largest value of that axis's parameter with the outcome `below`
  CliffKind kind;      ///< cause
  Discrete below;      ///< outcome at `value`
  Discrete above;      ///< outcome at the next larger double
};

/// A curve of discontinuities of one kind between the same two outcomes, in the plane of two axes.
struct CliffCurve {
  CliffKind kind;  ///< cause
  /// Positions in Boundaries::cliffs, in the order of the curve. An end at which three outcomes meet is given
  /// by meeting_from or meeting_to, which are known only to one cell of the grid.
  std::vector<std::size_t> cliffs;
  std::vector<double> meeting_from;  ///< point before the first, along the plane's two axes; empty: none
  std::vector<double> meeting_to;    ///< point after the last, along the plane's two axes; empty: none
};

/// All discontinuities of a grid.
struct Boundaries {
  std::vector<Axis> axes;          ///< axes of the grid
  std::vector<std::size_t> plane;  ///< the two axes with the most values, in order; empty: only one axis
  std::vector<Cliff> cliffs;       ///< ordered by axis, design and value
  std::vector<CliffCurve> curves;  ///< in that plane, for every value of the other axes in grid order
};

/// Coordinates of a discontinuity along the grid's axes, in the parameters' units.
std::vector<double> place_of(const Boundaries& boundaries, const Cliff& cliff);

/// Options of find_boundaries.
struct BoundaryOptions {
  bool phases = false;  ///< with friction: phase sequences count as outcomes too
  int threads = 0;      ///< number of threads; 0: all that OpenMP offers
  /// Receives the number of designs and edges done and their total, from one thread at a time.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Polled from any thread; if it returns true, find_boundaries throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Largest grid that find_boundaries takes: it keeps all outcomes in memory.
inline constexpr std::size_t most_bounded_designs = 200'000'000;

/// Finds the discontinuities of the grid of a spec.
///
/// Solves the grid and bisects every edge between neighbours with different discrete outcomes, until no
/// double is left between. Several discontinuities on one edge are found if the outcomes beside the first
/// one are not those of the edge's ends. An outcome that appears and vanishes between two neighbours with
/// equal outcomes is missed.
/// @param spec  a grid with at least two values along some axis
/// @throws InputError for a list of designs, a grid without an axis or a grid of more than
///         most_bounded_designs; Stopped; otherwise as sweep does
Boundaries find_boundaries(const Spec& spec, const BoundaryOptions& options = {});

/// A discontinuity near a design.
struct NearCliff {
  std::vector<double> at;  ///< its coordinates along the spec's axes, in the parameters' units
  double distance;         ///< as a fraction of the axes' ranges, logarithmic for logarithmic axes
  CliffKind kind;          ///< cause
  Discrete beyond;         ///< outcome on its other side
};

/// The discontinuities nearest to a design.
struct NearCliffs {
  std::vector<std::vector<NearCliff>> along;  ///< for each axis none, one or two, nearest first
  std::vector<NearCliff> nearest;             ///< over all directions: none or one
};

/// Finds the discontinuities nearest to a design, within the ranges of the spec's axes.
///
/// An outcome whose extent along an axis is below a thousandth of the range may be missed; over all
/// directions, below some hundredths of the distance.
/// @param place  the design's values along the spec's axes; the rest is the spec's
/// @throws InputError if the spec has no axes or the design is not allowed
NearCliffs near_cliffs(const Spec& spec, const std::vector<double>& place);

/// The same of a design, for a spec without [hoop].
NearCliffs near_cliffs(const Spec& spec, const Design& design);

}  // namespace leapmap
