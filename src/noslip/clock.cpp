// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {

template <class T>
void Clock<T>::start(const Block<T>& block, const DesignList& designs) {
  dials_.resize(std::max(dials_.size(), block.found.size()));
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const DesignLanes<T> index = lanes_from<T>(designs, first);
    MaskOf<T> hard(false);
    const NodesNeeded<T> needed = time_.needed(block.template load_path<T>(index.data()),
                                               block.template load_quiet<T>(index.data()), hard);
    const unsigned by_halving = Lanes<T>::bits(hard);
    const auto nodes = lanes_of(needed.panel), needles = lanes_of(needed.needle),
               strips = lanes_of(needed.strip);
    for (std::size_t i = 0; i < index.size(); ++i)
      dials_[index[i]] = {.panel = 0,
                          .time = S(0),
                          .before = S(0),
                          .needle = needles[i],
                          .strip = strips[i],
                          .nodes = by_halving >> i & 1u ? 0 : static_cast<int>(nodes[i])};
  }
  designs_ = designs;
  sort(designs_, sorted_designs_, [&](std::uint32_t design) { return dials_[design].nodes; });
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const DesignLanes<T> index = lanes_from<T>(designs_, first);
    const Roll<T> roll = block.template load_roll<T>(index.data());
    const Quiet<T> quiet = block.template load_quiet<T>(index.data());
    MaskOf<T> hard = roll.push != roll.push;
    const NodesNeeded<T> needed = needed_by(index);
    const T panel = time_.first_panel(roll), span = panel * T(pi_of<S>) - roll.release,
            time = time_.stretch(roll, quiet, needed, span, hard);
    const unsigned by_halving = Lanes<T>::bits(hard);
    const LaneArray<T> before = before_legs(block, index, roll, quiet, needed, span, hard);
    const auto panels = lanes_of(panel), times = lanes_of(time);
    for (std::size_t i = 0; i < index.size(); ++i) {
      Dial& dial = dials_[index[i]];
      dial.panel = static_cast<long>(panels[i]), dial.time = times[i], dial.before = before[i];
      if (by_halving >> i & 1u) dial.nodes = 0;
    }
  }
}

template <class T>
NodesNeeded<T> Clock<T>::needed_by(const DesignLanes<T>& designs) const {
  LaneArray<T> nodes, needles, strips;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Dial& dial = dials_[designs[i]];
    nodes[i] = S(dial.nodes), needles[i] = dial.needle, strips[i] = dial.strip;
  }
  return {Lanes<T>::load(nodes.data()), Lanes<T>::load(needles.data()), Lanes<T>::load(strips.data())};
}

/// How long the legs before took. A short way back from the first turn is timed in lanes, unless it is hard.
template <class T>
LaneArray<T> Clock<T>::before_legs(const Block<T>& block, const DesignLanes<T>& index, const Roll<T>& roll,
                                   const Quiet<T>& quiet, const NodesNeeded<T>& needed, const T& span,
                                   MaskOf<T> hard) {
  LaneArray<T> before{}, reaches;
  bool turned = false;
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    const auto& found = block.found[index[i]];
    reaches[i] = found.leg == 2 ? found.reach : S(0.1L);
    turned = turned || found.leg > 1;
  }
  if (!turned) return before;
  const T reach = Lanes<T>::load(reaches.data());
  hard = hard | !(reach <= span);
  const auto back = lanes_of(time_.stretch(roll, quiet, needed, smaller(reach, span), hard));
  const unsigned by_halving = Lanes<T>::bits(hard);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const int leg = block.found[index[i]].leg;
    if (leg > 1) before[i] = leg == 2 && !(by_halving >> i & 1u) ? back[i] : before_leg(block, index[i]);
  }
  return before;
}

/// From the release to the beginning of the leg.
template <class T>
ScalarOf<T> Clock<T>::before_leg(const Block<T>& block, std::uint32_t design) const {
  const auto& found = block.found[design];
  if (found.leg == 1) return S(0);
  const Roll<S> now = block.template load_roll<S>(&design);
  // As seen on the second leg.
  const Hoop<S> hoop = found.leg == 2 ? now.hoop : seen(now.hoop, S(-1));
  const Roll<S> first_turn = begin_roll(hoop, -(found.release + found.reach), S(0));
  Roll<S> release = begin_roll(seen(hoop, S(-1)), found.release, S(0));
  release.released = found.released;
  const S first = time_.halving_to_rest(release, found.reach);
  return found.leg == 2 ? first
                        : first + time_.halving_to_rest(first_turn, -now.release - first_turn.release);
}

template <class T>
ScalarOf<T> Clock<T>::time(const Block<T>& block, std::uint32_t design, const S& angle) const {
  return before_leg(block, design) + halve(block, design, angle);
}

template <class T>
void Clock<T>::read(const Block<T>& block, std::vector<Reading<S>>& readings) {
  early_.clear(), due_.clear();
  for (Reading<S>& reading : readings) {
    const Dial& dial = dials_[reading.design];
    if (dial.nodes == 0) {
      reading.time = dial.before + halve(block, reading.design, reading.angle);
      continue;
    }
    const long panel = static_cast<long>(std::floor(reading.angle * (S(1) / pi_of<S>)));
    if (panel < dial.panel)
      early_.push_back({0, dial.nodes, &reading});
    else
      due_.push_back({panel, dial.nodes, &reading});
  }
  const auto key_of = [](const Due& due) { return (RollingTime<T>::most_nodes + 1) * due.panel + due.nodes; };
  sort(early_, sorted_, key_of);
  sort(due_, sorted_, key_of);
  read_early(block);
  read_due(block);
}

/// Sorts by whole numbers, by counting where their range is small.
template <class T>
template <class Item, class Key>
void Clock<T>::sort(std::vector<Item>& items, std::vector<Item>& sorted, const Key& key_of) {
  if (items.empty()) return;
  // Not by std::ranges: the page's compiler has no such algorithms yet.
  const auto before = [&](const Item& a, const Item& b) { return key_of(a) < key_of(b); };
  const auto [least, most] = std::minmax_element(items.begin(), items.end(), before);
  const long base = key_of(*least);
  const auto range = static_cast<std::size_t>(key_of(*most) - base) + 1;
  if (range > Block<T>::most_designs) {
    std::stable_sort(items.begin(), items.end(), before);
    return;
  }
  places_.assign(range + 1, 0);
  for (const Item& item : items) ++places_[static_cast<std::size_t>(key_of(item) - base) + 1];
  for (std::size_t i = 1; i < range; ++i) places_[i] += places_[i - 1];
  sorted.resize(items.size());
  for (const Item& item : items) sorted[places_[static_cast<std::size_t>(key_of(item) - base)]++] = item;
  std::swap(items, sorted);
}

template <class T>
typename Clock<T>::Together Clock<T>::together(const std::vector<Due>& due, std::size_t first) const {
  Together found;
  found.nodes = 0;
  LaneArray<T> to;
  for (found.count = 0; found.count < to.size() && first + found.count < due.size(); ++found.count) {
    const Due& next = due[first + found.count];
    if (next.panel != due[first].panel) break;
    found.designs[found.count] = next.reading->design, to[found.count] = next.reading->angle;
    found.nodes = std::max(found.nodes, next.nodes);
  }
  for (std::size_t i = found.count; i < to.size(); ++i) found.designs[i] = found.designs[0], to[i] = to[0];
  found.to = Lanes<T>::load(to.data());
  found.needed = needed_by(found.designs);
  return found;
}

template <class T>
void Clock<T>::read_early(const Block<T>& block) {
  for (std::size_t first = 0, count = 0; first < early_.size(); first += count) {
    const Together lanes = together(early_, first);
    count = lanes.count;
    const Roll<T> roll = block.template load_roll<T>(lanes.designs.data());
    MaskOf<T> hard(false);
    const auto times = lanes_of(time_.stretch(roll, block.template load_quiet<T>(lanes.designs.data()),
                                              lanes.needed, lanes.to - roll.release, hard));
    const unsigned by_halving = Lanes<T>::bits(hard);
    for (std::size_t i = 0; i < count; ++i) {
      Reading<S>& reading = *early_[first + i].reading;
      reading.time = dials_[reading.design].before +
                     (by_halving >> i & 1u ? halve(block, reading.design, reading.angle) : times[i]);
    }
  }
}

template <class T>
void Clock<T>::read_due(const Block<T>& block) {
  for (std::size_t first = 0, count = 0; first < due_.size(); first += count) {
    const Together lanes = together(due_, first);
    count = lanes.count;
    const long end = due_[first].panel;
    long begin = end;
    LaneArray<T> panels, so_far;
    for (std::size_t i = 0; i < panels.size(); ++i) {
      const Dial& dial = dials_[lanes.designs[i]];
      panels[i] = S(dial.panel), so_far[i] = dial.time;
      begin = std::min(begin, dial.panel);
    }
    const Roll<T> roll = block.template load_path<T>(lanes.designs.data());
    const T first_panel = Lanes<T>::load(panels.data());
    T taken = Lanes<T>::load(so_far.data());
    for (long panel = begin; panel < end; ++panel)
      taken = taken + select(T(S(panel)) >= first_panel, time_.panel(roll, panel, lanes.nodes), T(0));
    const auto at_edge = lanes_of(taken);
    const auto times =
        lanes_of(taken + time_.rest(roll, lanes.needed, T(S(end)), lanes.to - T(S(end) * pi_of<S>)));
    for (std::size_t i = 0; i < count; ++i) {
      Dial& dial = dials_[lanes.designs[i]];
      dial.panel = end, dial.time = at_edge[i];
      due_[first + i].reading->time = dial.before + times[i];
    }
  }
}

#ifdef LEAPMAP_KERNELS
template class Clock<Batch>;
#endif
#ifdef LEAPMAP_SCALARS
template class Clock<double>;
template class Clock<long double>;
#endif

}  // namespace leapmap
