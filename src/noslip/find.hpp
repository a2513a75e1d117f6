// SPDX-License-Identifier: GPL-3.0-or-later
/// Stages of the exact solver: scan all designs for intervals that may hold a lift-off, and tell what they
/// hold.
#pragma once

#include <vector>

#include "noslip/block.hpp"

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
  std::vector<Interval<ScalarOf<T>>> intervals;  ///< to look at, at most one a design

  /// Adds those with a lift-off to `falls`, and designs whose search goes on without one to `going_on`.
  void run(Block<T>& block, std::vector<SureFall<ScalarOf<T>>>& falls, DesignList& going_on);
};

/// A number of each item in the lanes, number_of(item); lanes to spare repeat the first.
template <class T, class Item, class F>
T lanes_from(const std::vector<Item>& items, std::size_t first, const F& number_of) {
  return gathered<T>(
      [&](std::size_t i) { return number_of(items[first + i < items.size() ? first + i : first]); });
}

/// The designs, and ends, of the intervals in the lanes.
template <class T>
struct IntervalLanes {
  DesignLanes<T> index;
  T from, to;
};

template <class T, class Item>
IntervalLanes<T> lanes_from(const std::vector<Item>& items, std::size_t first) {
  DesignLanes<T> index;
  for (std::size_t i = 0; i < index.size(); ++i)
    index[i] = items[first + i < items.size() ? first + i : first].design;
  return {index, lanes_from<T>(items, first, [](const Item& item) { return item.from; }),
          lanes_from<T>(items, first, [](const Item& item) { return item.to; })};
}

}  // namespace leapmap
