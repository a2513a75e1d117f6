// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {

template <class T>
void Clock<T>::start(const Block<T>& block, const DesignList& designs) {
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const std::size_t count = std::min(Lanes<T>::count, designs.size() - first);
    const DesignLanes<T> index = lanes_from<T>(designs, first);
    const Roll<T> roll = block.template load_roll<T>(index.data());
    const Quiet<T> quiet = block.load_quiet(index.data());
    MaskOf<T> hard = roll.push != roll.push;
    const NodesNeeded<T> needed = time_.needed(roll, quiet, hard);
    const T panel = time_.first_panel(roll), span = panel * T(pi_of<S>) - roll.release,
            time = time_.stretch(roll, quiet, needed, span, hard);
    const unsigned by_halving = Lanes<T>::bits(hard);
    const LaneArray<T> before = before_legs(block, index, roll, quiet, needed, span, hard);
    const auto panels = lanes_of(panel), times = lanes_of(time), panel_nodes = lanes_of(needed.panel),
               rest_nodes = lanes_of(needed.rest);
    for (std::size_t i = 0; i < count; ++i)
      dials_[index[i]] = {.panel = static_cast<long>(panels[i]),
                          .time = times[i],
                          .before = before[i],
                          .panel_nodes = by_halving >> i & 1u ? 0 : static_cast<int>(panel_nodes[i]),
                          .rest_nodes = static_cast<int>(rest_nodes[i])};
  }
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
    if (dial.panel_nodes == 0) {
      reading.time = dial.before + halve(block, reading.design, reading.angle);
      continue;
    }
    const long part = static_cast<long>(std::floor(reading.angle * (S(parts_a_panel) / pi_of<S>)));
    (part < dial.panel * parts_a_panel ? early_ : due_).push_back({part, &reading});
  }
  sort(early_);
  sort(due_);
  read_early(block);
  read_due(block);
}

/// Sorts parts by part, by counting where they are few.
template <class T>
void Clock<T>::sort(std::vector<Part>& parts) {
  if (parts.empty()) return;
  // Not by std::ranges: the page's compiler has no such algorithms yet.
  const auto before = [](const Part& a, const Part& b) { return a.number < b.number; };
  const auto [least, most] = std::minmax_element(parts.begin(), parts.end(), before);
  const auto range = static_cast<std::size_t>(most->number - least->number) + 1;
  if (range > Block<T>::most_designs) {
    std::sort(parts.begin(), parts.end(), before);
    return;
  }
  places_.assign(range + 1, 0);
  const long base = least->number;
  for (const Part& part : parts) ++places_[static_cast<std::size_t>(part.number - base) + 1];
  for (std::size_t i = 1; i < range; ++i) places_[i] += places_[i - 1];
  sorted_.resize(parts.size());
  for (const Part& part : parts) sorted_[places_[static_cast<std::size_t>(part.number - base)]++] = part;
  std::swap(parts, sorted_);
}

template <class T>
typename Clock<T>::Together Clock<T>::together(const std::vector<Part>& parts, std::size_t first) {
  const Reading<S>& leader = *parts[first].reading;
  Together found{.count = 1, .designs = {}, .to = T(leader.angle)};
  found.designs.fill(leader.design);
  LaneArray<T> to;
  to.fill(leader.angle);
  for (; found.count < to.size() && first + found.count < parts.size(); ++found.count) {
    const Part& part = parts[first + found.count];
    if (part.number != parts[first].number) break;
    found.designs[found.count] = part.reading->design, to[found.count] = part.reading->angle;
  }
  found.to = Lanes<T>::load(to.data());
  return found;
}

template <class T>
void Clock<T>::read_early(const Block<T>& block) {
  const int nodes_near_release = time_.rest_nodes_near_release();
  for (std::size_t first = 0, count = 0; first < early_.size(); first += count) {
    const Together lanes = together(early_, first);
    count = lanes.count;
    int rest_nodes = nodes_near_release;
    for (const std::uint32_t design : lanes.designs)
      rest_nodes = std::max(rest_nodes, dials_[design].rest_nodes);
    const Roll<T> roll = block.template load_roll<T>(lanes.designs.data());
    const Quiet<T> quiet = block.load_quiet(lanes.designs.data());
    const T edge(S(early_[first].number) * (pi_of<S> / S(parts_a_panel)));
    MaskOf<T> hard = lanes.to != lanes.to;
    const NodesNeeded<T> needed = time_.needed(roll, quiet, hard);
    const bool with_rest = all(edge > roll.release + T(0.4));
    T taken = time_.stretch(roll, quiet, needed, (with_rest ? edge : lanes.to) - roll.release, hard);
    if (with_rest) taken = taken + time_.rest(roll, lanes_of(edge)[0], lanes.to - edge, rest_nodes);
    const auto times = lanes_of(taken);
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
    int panel_nodes = 0, rest_nodes = 0;
    long begin = std::numeric_limits<long>::max();
    LaneArray<T> panels, so_far;
    for (std::size_t i = 0; i < panels.size(); ++i) {
      const Dial& dial = dials_[lanes.designs[i]];
      panels[i] = S(dial.panel), so_far[i] = dial.time;
      begin = std::min(begin, dial.panel);
      panel_nodes = std::max(panel_nodes, dial.panel_nodes);
      rest_nodes = std::max(rest_nodes, dial.rest_nodes);
    }
    const Roll<T> roll = block.template load_path<T>(lanes.designs.data());
    const T first_panel = Lanes<T>::load(panels.data());
    T taken = Lanes<T>::load(so_far.data());
    const long part = due_[first].number;
    const long end = (part - (part % parts_a_panel + parts_a_panel) % parts_a_panel) / parts_a_panel;
    for (long panel = begin; panel < end; ++panel)
      taken = taken +
              select(T(S(panel)) >= first_panel, time_.panel(roll, panel, parts_a_panel, panel_nodes), T(0));
    auto times = lanes_of(taken);
    for (std::size_t i = 0; i < count; ++i)
      dials_[lanes.designs[i]].panel = end, dials_[lanes.designs[i]].time = times[i];
    if (const int parts = static_cast<int>(part - end * parts_a_panel); parts > 0)
      taken = taken + time_.panel(roll, end, parts, panel_nodes);
    const S edge = S(part) * (pi_of<S> / S(parts_a_panel));
    times = lanes_of(taken + time_.rest(roll, edge, lanes.to - T(edge), rest_nodes));
    for (std::size_t i = 0; i < count; ++i)
      due_[first + i].reading->time = dials_[lanes.designs[i]].before + times[i];
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
