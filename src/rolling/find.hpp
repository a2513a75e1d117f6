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

/// The intervals in the lanes of a batch; lanes to spare repeat the first.
template <class T>
struct IntervalLanes {
  DesignLanes<T> index;
  T from, to, turn;
};

/// A number of each interval in the lanes: number_of(interval).
template <class T, class F>
T lanes_from(const std::vector<Interval<ScalarOf<T>>>& intervals, std::size_t first, const F& number_of) {
  LaneArray<T> lanes;
  for (std::size_t i = 0; i < lanes.size(); ++i)
    lanes[i] = number_of(intervals[first + i < intervals.size() ? first + i : first]);
  return Lanes<T>::load(lanes.data());
}

template <class T>
IntervalLanes<T> lanes_from(const std::vector<Interval<ScalarOf<T>>>& intervals, std::size_t first) {
  DesignLanes<T> index;
  LaneArray<T> from, to, turn;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const auto& interval = intervals[first + i < intervals.size() ? first + i : first];
    index[i] = interval.design, from[i] = interval.from, to[i] = interval.to, turn[i] = interval.turn;
  }
  return {index, Lanes<T>::load(from.data()), Lanes<T>::load(to.data()), Lanes<T>::load(turn.data())};
}

}  // namespace leapmap
