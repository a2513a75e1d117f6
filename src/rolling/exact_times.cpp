// SPDX-License-Identifier: GPL-3.0-or-later
/// The last stage of the exact solver: the times of the lift-offs it found.
#include <cmath>

#include "rolling/exact.hpp"

namespace leapmap {
namespace {

/// A time that the quadrature could not tell makes the design failed: no field of it is to be believed.
template <class S>
void note_time(Outcome& outcome, double Outcome::*time, const S& taken) {
  if (std::isfinite(taken)) {
    outcome.*time = static_cast<double>(taken);
  } else {
    outcome = failed_outcome("a time could not be told: too near a stall");
  }
}

}  // namespace

/// The times of all first lift-offs and jumps.
template <class T>
void ExactSolver<T>::take_times(std::span<Outcome> outcomes) {
  start_clocks();
  const auto is_later = [&](std::uint32_t design) {
    return searches_[design].jump_angle > searches_[design].first_angle;
  };
  if (!wanted_.first_jump_time)
    std::erase_if(lifted_, [&](std::uint32_t design) {
      return outcomes[design].status != Status::jumped || is_later(design);
    });
  take_times(lifted_, &Search::first_angle, &Outcome::first_jump_time, outcomes);
  later_.clear();
  for (const std::uint32_t design : jumped_) {
    if (outcomes[design].status == Status::failed) continue;
    if (is_later(design)) {
      later_.push_back(design);
    } else {
      outcomes[design].jump_time = outcomes[design].first_jump_time;
    }
  }
  if (wanted_.jump_time) take_times(later_, &Search::jump_angle, &Outcome::jump_time, outcomes);
}

template <class T>
void ExactSolver<T>::start_clocks() {
  for (std::size_t first = 0; first < lifted_.size(); first += width) {
    const std::size_t count = std::min(width, lifted_.size() - first);
    const Index index = index_of(lifted_, first);
    const Roll<T> roll = rows_.template load_roll<T>(index.data());
    const Quiet<T> quiet = rows_.load_quiet(index.data());
    MaskOf<T> hard = roll.push != roll.push;
    const NodesNeeded<T> needed = time_.needed(roll, quiet, hard);
    const T panel = time_.first_panel(roll),
            time = time_.stretch(roll, quiet, needed, panel * T(pi_of<S>), hard);
    const unsigned by_halving = Lanes<T>::bits(hard);
    const auto panels = lanes_of(panel), times = lanes_of(time), panel_nodes = lanes_of(needed.panel),
               rest_nodes = lanes_of(needed.rest);
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches_[index[i]];
      search.panel = static_cast<long>(panels[i]), search.panel_time = times[i];
      search.panel_nodes = by_halving >> i & 1u ? 0 : static_cast<int>(panel_nodes[i]);
      search.rest_nodes = static_cast<int>(rest_nodes[i]);
    }
  }
}

/// Sorts parts by part, by counting where they are few.
template <class T>
void ExactSolver<T>::sort_parts(std::vector<Part>& parts) {
  if (parts.empty()) return;
  // Not by std::ranges: the page's compiler has no such algorithms yet.
  const auto before = [](const Part& a, const Part& b) { return a.number < b.number; };
  const auto [least, most] = std::minmax_element(parts.begin(), parts.end(), before);
  const auto range = static_cast<std::size_t>(most->number - least->number) + 1;
  if (range > block) {
    std::sort(parts.begin(), parts.end(), before);
    return;
  }
  places_.assign(range + 1, 0);
  const long base = least->number;
  for (const Part& part : parts) ++places_[static_cast<std::size_t>(part.number - base) + 1];
  for (std::size_t i = 1; i < range; ++i) places_[i] += places_[i - 1];
  sorted_parts_.resize(parts.size());
  for (const Part& part : parts)
    sorted_parts_[places_[static_cast<std::size_t>(part.number - base)]++] = part;
  std::swap(parts, sorted_parts_);
}

/// One of the outcome's times. Designs are taken in order of angle, so that those in the lanes have panels in
/// common.
template <class T>
void ExactSolver<T>::take_times(const List& designs, S Search::*angle, double Outcome::*time,
                                std::span<Outcome> outcomes) {
  early_.clear(), due_.clear();
  for (const std::uint32_t design : designs) {
    const Search& search = searches_[design];
    if (search.panel_nodes == 0) {
      note_time(outcomes[design], time, halve_time(design, angle));
      continue;
    }
    const long part = static_cast<long>(std::floor(search.*angle * (S(parts_a_panel) / pi_of<S>)));
    (part < search.panel * parts_a_panel ? early_ : due_).push_back({part, design});
  }
  sort_parts(early_);
  sort_parts(due_);
  const int nodes_near_release = time_.rest_nodes_near_release();
  for (std::size_t first = 0, count = 0; first < early_.size(); first += count) {
    const Index index = index_of_part(early_, first, count);
    int rest_nodes = nodes_near_release;
    for (const std::uint32_t design : index) rest_nodes = std::max(rest_nodes, searches_[design].rest_nodes);
    const Roll<T> roll = rows_.template load_roll<T>(index.data());
    const T to = gather(index, angle), edge(S(early_[first].number) * (pi_of<S> / S(parts_a_panel)));
    const Quiet<T> quiet = rows_.load_quiet(index.data());
    MaskOf<T> hard = to != to;
    const NodesNeeded<T> needed = time_.needed(roll, quiet, hard);
    const bool with_rest = all(edge > roll.release + T(0.4));
    T taken = time_.stretch(roll, quiet, needed, with_rest ? edge : to, hard);
    if (with_rest) taken = taken + time_.rest(roll, lanes_of(edge)[0], to - edge, rest_nodes);
    auto times = lanes_of(taken);
    const unsigned by_halving = Lanes<T>::bits(hard);
    for (std::size_t i = 0; i < count; ++i) {
      if (by_halving >> i & 1u) times[i] = halve_time(index[i], angle);
      note_time(outcomes[index[i]], time, times[i]);
    }
  }
  for (std::size_t first = 0, count = 0; first < due_.size(); first += count) {
    const Index index = index_of_part(due_, first, count);
    int panel_nodes = 0, rest_nodes = 0;
    long begin = std::numeric_limits<long>::max();
    LaneArray<T> panels;
    for (std::size_t i = 0; i < width; ++i) {
      const Search& search = searches_[index[i]];
      panels[i] = S(search.panel);
      begin = std::min(begin, search.panel);
      panel_nodes = std::max(panel_nodes, search.panel_nodes);
      rest_nodes = std::max(rest_nodes, search.rest_nodes);
    }
    const Roll<T> roll = rows_.template load_motion<T>(index.data());
    const T to = gather(index, angle), first_panel = Lanes<T>::load(panels.data());
    T taken = gather(index, &Search::panel_time);
    const long part = due_[first].number;
    const long end = (part - (part % parts_a_panel + parts_a_panel) % parts_a_panel) / parts_a_panel;
    for (long panel = begin; panel < end; ++panel)
      taken = taken +
              select(T(S(panel)) >= first_panel, time_.panel(roll, panel, parts_a_panel, panel_nodes), T(0));
    auto times = lanes_of(taken);
    for (std::size_t i = 0; i < count; ++i)
      searches_[index[i]].panel = end, searches_[index[i]].panel_time = times[i];
    if (const int parts = static_cast<int>(part - end * parts_a_panel); parts > 0)
      taken = taken + time_.panel(roll, end, parts, panel_nodes);
    const S edge = S(part) * (pi_of<S> / S(parts_a_panel));
    times = lanes_of(taken + time_.rest(roll, edge, to - T(edge), rest_nodes));
    for (std::size_t i = 0; i < count; ++i) note_time(outcomes[index[i]], time, times[i]);
  }
}

template <class T>
ScalarOf<T> ExactSolver<T>::halve_time(std::uint32_t design, S Search::*angle) const {
  return time_.halving(rows_.template load_roll<S>(&design), searches_[design].*angle);
}

/// As many designs of one part as there are lanes.
template <class T>
typename ExactSolver<T>::Index ExactSolver<T>::index_of_part(const std::vector<Part>& parts,
                                                             std::size_t first, std::size_t& count) const {
  Index index;
  index.fill(parts[first].design);
  for (count = 1; count < width && first + count < parts.size(); ++count) {
    if (parts[first + count].number != parts[first].number) break;
    index[count] = parts[first + count].design;
  }
  return index;
}

// exact.cpp instantiates the rest of the class.
#define LEAPMAP_INSTANTIATE(T)                                                                               \
  template void ExactSolver<T>::take_times(std::span<Outcome>);                                              \
  template void ExactSolver<T>::start_clocks();                                                              \
  template void ExactSolver<T>::sort_parts(std::vector<Part>&);                                              \
  template void ExactSolver<T>::take_times(const List&, S Search::*, double Outcome::*, std::span<Outcome>); \
  template typename ExactSolver<T>::S ExactSolver<T>::halve_time(std::uint32_t, S Search::*) const;          \
  template typename ExactSolver<T>::Index ExactSolver<T>::index_of_part(const std::vector<Part>&,            \
                                                                        std::size_t, std::size_t&) const;
#ifdef LEAPMAP_KERNELS
LEAPMAP_INSTANTIATE(Batch)
#endif
#ifdef LEAPMAP_SCALARS
LEAPMAP_INSTANTIATE(double)
LEAPMAP_INSTANTIATE(long double)
#endif
#undef LEAPMAP_INSTANTIATE

}  // namespace leapmap
