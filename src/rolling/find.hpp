// SPDX-License-Identifier: GPL-3.0-or-later
/// Stages of the exact solver: scan all designs for intervals that may hold a lift-off, and tell what they
/// hold.
#pragma once

#include <vector>

#include "rolling/block.hpp"

namespace leapmap {

/// Flags the intervals of each design's next revolutions (lift_off_scan.hpp).
template <class T>
struct Scan {
  ScanNodes<ScalarOf<T>> nodes = scan_nodes<ScalarOf<T>>();

  void run(Block<T>& block, const DesignList& designs) const;
};

/// Tells what intervals hold that are not clear from the scan.
template <class T>
struct Classify {
  using Intervals = std::vector<Interval<ScalarOf<T>>>;
  Intervals intervals;  ///< to look at, at most one a design

  /// Adds those with a lift-off to `falls`, and designs whose search goes on without one to `going_on`.
  void run(Block<T>& block, Intervals& falls, DesignList& going_on);
};

/// The intervals in the lanes of a batch.
template <class T>
struct IntervalLanes {
  DesignLanes<T> index;
  T from, to, turn, guess, from_side, to_side;
};
template <class T>
IntervalLanes<T> lanes_from(const std::vector<Interval<ScalarOf<T>>>& intervals, std::size_t first) {
  IntervalLanes<T> lanes;
  LaneArray<T> from, to, turn, guess, from_side, to_side;
  for (std::size_t i = 0; i < lanes.index.size(); ++i) {
    const auto& interval = intervals[first + i < intervals.size() ? first + i : first];
    lanes.index[i] = interval.design, from[i] = interval.from, to[i] = interval.to, turn[i] = interval.turn;
    guess[i] = interval.guess;
    from_side[i] = ScalarOf<T>(static_cast<int>(interval.from_side));
    to_side[i] = ScalarOf<T>(static_cast<int>(interval.to_side));
  }
  using Load = Lanes<T>;
  lanes.from = Load::load(from.data()), lanes.to = Load::load(to.data());
  lanes.turn = Load::load(turn.data()), lanes.guess = Load::load(guess.data());
  lanes.from_side = Load::load(from_side.data()), lanes.to_side = Load::load(to_side.data());
  return lanes;
}

}  // namespace leapmap
