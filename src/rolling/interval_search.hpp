// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's search for lift-offs: which intervals of its revolutions to look at, in order of angle.
#pragma once

#include <cstdint>

#include "rolling/lift_off_scan.hpp"

namespace leapmap {

/// An end of an interval at the release or at a node has a sign of G that was decided before; elsewhere it is
/// asked.
enum class Side : std::int8_t { below = -1, asked = 0, above = 1 };

template <class S>
struct Interval {
  std::uint32_t design;  ///< of the block
  S turn;                ///< the revolution it lies in
  S from, to, guess;     ///< guess: of the lift-off in it
  bool falls;            ///< it surely holds one fall of G, and nothing else
  Side from_side, to_side;
};

/// Each interval between two nodes that the scan flagged is looked at as a whole, then, where that is
/// unclear, in 2^halvings equal parts, now part `part`.
template <class S>
struct IntervalSearch {
  static constexpr int most_halvings = 40;  ///< a part is then 1e-13 rad long

  S release, end;                   ///< where the search begins and ends [rad]
  S first_turn;                     ///< revolution that the scan began with
  std::uint32_t node_past_release;  ///< the first one of the first scan; 0 in later scans
  bool released_on_node;            ///< on that one, but for rounding
  bool last_above;                  ///< whether G > 0 at the last node of the scan
  ScanFlags flags;
  int turn, node, halvings;
  std::uint64_t part;

  /// Begins at the release, `from`, to end at `to`. past: the scan's first node past the release; on_node:
  /// whether that is the same place.
  void begin(const S& from, const S& to, const S& turn_of_release, std::uint32_t past, bool on_node);

  /// Takes over what a scan of `turns` revolutions found in a lane.
  void take(const ScanFlags& scanned, const NodeSigns& signs, std::size_t lane, int turns);

  /// On to the revolutions after the scan; false if the search ends before them.
  bool scan_on();

  /// The next interval to look at, of `design`; false if none of the scan is left.
  bool next(std::uint32_t design, Interval<S>& interval);

  /// On to the interval after this one.
  void advance();

  /// Looks at both halves of this interval in its place.
  void halve() { ++halvings, part *= 2; }

 private:
  void hand_on_signs(const NodeSigns& signs, std::size_t lane, int turns);
};

}  // namespace leapmap
