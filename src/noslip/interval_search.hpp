// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's search for lift-offs: which intervals of its revolutions to look at, in order of angle. All
/// of it is here to be inlined: a search takes some nanoseconds a step, as much as a call.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "noslip/lift_off_scan.hpp"

namespace leapmap {

/// An end of an interval at the release or at a node has a sign of G that was decided before; elsewhere it is
/// asked.
enum class GapSign : std::int8_t { below = -1, asked = 0, above = 1 };

/// An interval that may hold a fall of G.
template <class S>
struct Interval {
  std::uint32_t design;  ///< of the block
  S turn;                ///< the revolution it lies in
  S from, to;
  GapSign from_side, to_side;
};

/// An interval that surely holds one fall of G, and nothing else.
template <class S>
struct SureFall {
  std::uint32_t design;  ///< of the block
  S from, to, guess;     ///< guess: of the lift-off in it
};

/// What the next interval is.
enum class Next { none, look, fall };

/// Each interval between two nodes that the scan flagged is looked at as a whole, then, where that is
/// unclear, in 2^halvings equal parts, now part `part`.
template <class S>
struct IntervalSearch {
  static constexpr int most_halvings = 40;  ///< a part is then 1e-13 rad long

  S release, end;                   ///< where the search begins and ends [rad]
  S first_turn;                     ///< revolution that the scan began with
  std::uint32_t node_past_release;  ///< the first one of the first scan; 0 in later scans
  bool released_on_node;            ///< on that one, but for rounding
  bool released_above;              ///< whether G > 0 at the release
  bool ends_above;                  ///< G > 0 at the end, as was decided before: the hoop set out from there
  bool last_above;                  ///< whether G > 0 at the last node of the scan
  ScanFlags flags;
  int turn, node, halvings;
  std::uint64_t part;

  /// Begins at the release, or where the hoop turned round, `from`, to end at `to`. past: the scan's first
  /// node past the release; on_node: whether that is the same place; above: whether G > 0 there; back: `to`
  /// is where the design set out.
  void begin(const S& from, const S& to, const S& turn_of_release, std::uint32_t past, bool on_node,
             bool above, bool back);

  /// The first node whose interval the next scan must tell of.
  std::size_t scan_from() const { return node_past_release == 0 ? 0 : node_past_release - 1; }

  /// Takes over what a scan of `turns` revolutions found.
  void take(const ScanFlags& scanned, int turns);

  /// On to the revolutions after the scan; false if the search ends before them.
  bool scan_on();

  /// The next interval of `design`: a look, a fall, or none of the scan is left.
  Next next(std::uint32_t design, Interval<S>& look, SureFall<S>& fall);

  /// On to the interval after this one.
  void advance();

  /// Looks at both halves of this interval in its place.
  void halve() { ++halvings, part *= 2; }

 private:
  void hand_on_signs(int turns);
  void distrust_falls_at_end();
  void look_at(std::size_t k);
};

/// Whether two angles are the same but for rounding.
template <class S>
bool is_same_place(const S& a, const S& b) {
  return std::abs(a - b) <= S(8) * std::numeric_limits<S>::epsilon() * std::max(S(1), std::abs(a));
}

/// Of an interval halved k times, relative to the whole.
template <class S>
inline constexpr auto part_lengths = [] {
  std::array<S, IntervalSearch<S>::most_halvings + 1> lengths{};
  for (std::size_t k = 0; k < lengths.size(); ++k) lengths[k] = S(1) / S(std::uint64_t{1} << k);
  return lengths;
}();

template <class S>
void IntervalSearch<S>::begin(const S& from, const S& to, const S& turn_of_release, std::uint32_t past,
                              bool on_node, bool above, bool back) {
  release = from, end = to;
  first_turn = turn_of_release;
  node_past_release = past;
  released_on_node = on_node;
  released_above = above;
  ends_above = back;
  turn = node = halvings = 0, part = 0;
}

template <class S>
void IntervalSearch<S>::take(const ScanFlags& scanned, int turns) {
  flags = scanned;
  hand_on_signs(turns);
  distrust_falls_at_end();
}

/// The interval from node k on is to be looked at, whatever the scan told.
template <class S>
void IntervalSearch<S>::look_at(std::size_t k) {
  const std::uint64_t bit = std::uint64_t{1} << k % nodes_a_turn;
  flags.looks[k / nodes_a_turn] |= bit, flags.falls[k / nodes_a_turn] &= ~bit;
}

/// At the release G has the sign that was told, and at a scan's first node the sign that the scan before
/// found there. Where this scan's sign differs, by rounding or because G has a root before the release, the
/// interval from there on is looked at.
template <class S>
void IntervalSearch<S>::hand_on_signs(int turns) {
  if (turns < 1) return;  // there always is one; without this g++ warns of an index of -1
  constexpr std::size_t nodes = nodes_a_turn;
  const auto scanned = static_cast<std::size_t>(turns) * nodes;  // of all turns, the last node not counted
  const auto above_at = [&](std::size_t k) -> bool {
    return k < scanned ? flags.above[k / nodes] >> k % nodes & 1u : flags.above[k / nodes - 1] >> nodes & 1u;
  };
  const auto begins_at = [&](std::size_t k, bool above) {
    if (above_at(k) == above) return;
    flags.above[k / nodes] ^= std::uint64_t{1} << k % nodes;
    look_at(k);
  };
  const bool first_above = last_above;
  last_above = above_at(scanned);
  const std::size_t k = node_past_release;
  node_past_release = 0;
  if (k == 0) {
    begins_at(0, first_above);
    return;
  }
  const std::size_t begin = released_on_node ? k : k - 1;
  flags.looks[0] &= ~std::uint64_t{0} << begin, flags.falls[0] &= ~std::uint64_t{0} << begin;
  if (!released_on_node) {
    if (above_at(k) != released_above || above_at(k - 1) != released_above) look_at(k - 1);
  } else if (k == scanned) {
    last_above = released_above;
  } else {
    begins_at(k, released_above);
  }
}

/// An interval that the end cuts short, or may for rounding, holds what is to be seen.
template <class S>
void IntervalSearch<S>::distrust_falls_at_end() {
  const S nodes_a_radian = S(nodes_a_turn / 2) / std::numbers::pi_v<S>;
  const S ends = end * nodes_a_radian - first_turn * S(nodes_a_turn);
  if (ends > S(turns_a_scan * nodes_a_turn + 2)) return;
  auto whole = static_cast<int>(ends) - 1;  // intervals that surely are
  for (std::uint64_t& falls : flags.falls) {
    if (whole < nodes_a_turn) falls &= (std::uint64_t{1} << std::max(whole, 0)) - 1;
    whole -= nodes_a_turn;
  }
}

template <class S>
bool IntervalSearch<S>::scan_on() {
  if (!(end > S(2) * std::numbers::pi_v<S> * (first_turn + S(turns_a_scan)))) return false;
  first_turn += S(turns_a_scan);
  turn = 0;
  return true;
}

template <class S>
Next IntervalSearch<S>::next(std::uint32_t design, Interval<S>& look, SureFall<S>& fall) {
  constexpr S step = S(2) * std::numbers::pi_v<S> / S(nodes_a_turn);
  while (turn < turns_a_scan) {
    const auto t = static_cast<std::size_t>(turn);
    if (flags.looks[t] == 0) {
      ++turn;
      continue;
    }
    node = std::countr_zero(flags.looks[t]);
    const S revolution = first_turn + S(turn), place = revolution * S(nodes_a_turn) + S(node);
    const S left_node = place * step, right_node = (place + S(1)) * step;
    if (flags.falls[t] >> node & 1u) {
      fall = {design, left_node, right_node, (left_node + right_node) * S(0.5)};
      return Next::fall;
    }
    const S length = part_lengths<S>[static_cast<std::size_t>(halvings)], at = place + S(part) * length;
    const S from = std::max(at * step, release), to = std::min((at + length) * step, end);
    if (from < to) {
      const auto side = [&](bool is_above) { return is_above ? GapSign::above : GapSign::below; };
      look = {design, revolution, from, to, GapSign::asked, GapSign::asked};
      if (from == release) {
        look.from_side = side(released_above);
      } else if (from == left_node) {
        look.from_side = side(flags.above[t] >> node & 1u);
      }
      if (to == right_node) look.to_side = side(flags.above[t] >> (node + 1) & 1u);
      if (ends_above && is_same_place(to, end)) look.to_side = GapSign::above;
      return Next::look;
    }
    if (from >= end) {
      turn = turns_a_scan;
    } else {
      advance();
    }
  }
  return Next::none;
}

template <class S>
void IntervalSearch<S>::advance() {
  ++part;
  while (halvings > 0 && part % 2 == 0) part /= 2, --halvings;
  if (halvings > 0) return;
  part = 0;
  flags.looks[static_cast<std::size_t>(turn)] &= ~(std::uint64_t{1} << node);
}

}  // namespace leapmap
