// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/find.hpp"

#include <cmath>
#include <limits>

namespace leapmap {

template <class T>
void Scan<T>::run(Block<T>& block, const DesignList& designs) const {
  using S = ScalarOf<T>;
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const DesignLanes<T> index = lanes_from<T>(designs, first);
    int turns = 1;
    std::size_t from = nodes_a_turn;
    LaneArray<T> first_turns;
    for (std::size_t i = 0; i < index.size(); ++i) {
      const IntervalSearch<S>& search = block.searches[index[i]];
      first_turns[i] = search.first_turn;
      from = std::min(from, search.scan_from());
      while (turns < turns_a_scan && search.end > S(2) * pi_of<S> * (search.first_turn + S(turns))) ++turns;
    }
    std::array<ScanFlags, Lanes<T>::count> flags;
    scan_turns(nodes, block.template load_path<T>(index.data()), Lanes<T>::load(first_turns.data()), turns,
               from, flags.data());
    const std::size_t count = std::min(Lanes<T>::count, designs.size() - first);
    for (std::size_t i = 0; i < count; ++i) block.searches[index[i]].take(flags[i], turns);
  }
}

template <class T>
void Classify<T>::run(Block<T>& block, std::vector<SureFall<ScalarOf<T>>>& falls, DesignList& going_on) {
  using S = ScalarOf<T>;
  for (std::size_t first = 0; first < intervals.size(); first += Lanes<T>::count) {
    const std::size_t count = std::min(Lanes<T>::count, intervals.size() - first);
    const IntervalLanes<T> lanes = lanes_from<T>(intervals, first);
    const T &a = lanes.from, &b = lanes.to;
    const Roll<T> roll = block.template load_path<T>(lanes.index.data());
    const CurvedSample<T> at_a = lift(roll, a), at_b = lift(roll, b);
    const T turn = lanes_from<T>(intervals, first, [](const Interval<S>& interval) { return interval.turn; });
    const auto is_up = [&](GapSign Interval<S>::*side, const T& value) {
      const T decided = lanes_from<T>(
          intervals, first, [&](const Interval<S>& interval) { return S(static_cast<int>(interval.*side)); });
      return (decided > T(0)) | ((decided == T(0)) & (value > T(0)));
    };
    const MaskOf<T> up_a = is_up(&Interval<S>::from_side, at_a.value),
                    up_b = is_up(&Interval<S>::to_side, at_b.value);
    const IntervalKind<T> kind =
        classify(at_a, at_b, up_a, up_b, lift_bounds(roll, lift_harmonics(roll.hoop), turn), b - a);
    const unsigned fall = Lanes<T>::bits(kind.fall), unclear = Lanes<T>::bits(kind.unclear),
                   sinking = Lanes<T>::bits(up_a & !up_b);
    const auto guess = lanes_of(a + (b - a) * at_a.value / (at_a.value - at_b.value));
    for (std::size_t i = 0; i < count; ++i) {
      const Interval<S>& interval = intervals[first + i];
      IntervalSearch<S>& search = block.searches[interval.design];
      const bool short_of_digits =
          interval.to - interval.from <= S(16) * std::numeric_limits<S>::epsilon() * std::abs(interval.to);
      const bool at_last =
          (unclear >> i & 1u) && (search.halvings == IntervalSearch<S>::most_halvings || short_of_digits);
      if ((fall >> i & 1u) || (at_last && (sinking >> i & 1u))) {
        falls.push_back({interval.design, interval.from, interval.to, guess[i]});
        continue;
      }
      if ((unclear >> i & 1u) && !at_last) {
        search.halve();
      } else {
        search.advance();
      }
      going_on.push_back(interval.design);
    }
  }
}

#ifdef LEAPMAP_KERNELS
template struct Scan<Batch>;
template struct Classify<Batch>;
#endif
#ifdef LEAPMAP_SCALARS
template struct Scan<double>;
template struct Scan<long double>;
template struct Classify<double>;
template struct Classify<long double>;
#endif

}  // namespace leapmap
