// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the normal force of a rolling hoop may fall through zero: no interval is passed over that could hold
/// a fall.
///
/// A revolution is divided at 48 nodes whose sines and cosines all designs share. Between two nodes, h apart,
/// G (physics/rolling_by_angle.hpp) differs from its chord by at most m = |G''| h^2 / 8, and G' from the
/// chord's slope by at most 4 m / h. So an interval is plain if its values differ by more than 4 m, for then
/// G is monotone, or if one of them is beyond 5 m, for then G is monotone or keeps off zero. A plain interval
/// holds one fall or none, as its signs tell. The others, or parts of them, are told by values and slopes at
/// their ends and the bounds of |G''| and |G'''|: one fall, nothing, or unclear; an unclear one is halved
/// until it is clear. So pairs a hair apart are found by a bound, not by luck.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <numbers>

#include "physics/rolling_by_angle.hpp"

namespace leapmap {

inline constexpr int nodes_a_turn = 48;
inline constexpr int turns_a_scan = 3;  ///< each further one costs a third of the first

/// Intervals of one design: bit k of turn t is the one from node k to k + 1 of revolution first_turn + t.
using IntervalBits = std::array<std::uint64_t, turns_a_scan>;

struct ScanFlags {
  IntervalBits looks;                    ///< intervals that may hold a fall
  IntervalBits falls;                    ///< those of them that surely hold one, and nothing else
  IntervalBits above_left, above_right;  ///< of those that only may hold one: whether G > 0 at either end
};

/// Whether G > 0 at the nodes of each revolution, the first of the next one included: a byte a node, a bit a
/// lane. The sign at a node is computed once, and decides for the intervals on both sides of it: were it
/// computed twice, a root on a node could be lost by rounding, or counted twice.
using NodeSigns = std::array<std::array<std::uint64_t, nodes_a_turn / 8 + 1>, turns_a_scan>;
inline bool is_above(const NodeSigns& signs, std::size_t turn, std::size_t node, std::size_t lane) {
  return signs[turn][node / 8] >> (8 * (node % 8) + lane) & 1u;
}

/// The nodes 0 to 24; the others mirror them.
template <class S>
using ScanNodes = std::array<Trig<S>, nodes_a_turn / 2 + 1>;

template <class S>
ScanNodes<S> scan_nodes() {
  ScanNodes<S> nodes;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    nodes[k] = trig(S(2) * std::numbers::pi_v<S> * S(k) / S(nodes_a_turn));
  return nodes;
}

/// Flags the intervals of `turns` <= turns_a_scan revolutions that may hold a fall of G, one ScanFlags a
/// lane, and tells the signs at their nodes.
template <class T>
void scan_turns(const ScanNodes<ScalarOf<T>>& nodes, const Roll<T>& roll, const T& first_turn, int turns,
                ScanFlags* flags, NodeSigns& signs) {
  using std::abs;
  using S = ScalarOf<T>;
  const Hoop<T>& h = roll.hoop;
  const S two_pi = S(2) * std::numbers::pi_v<S>, step = two_pi / S(nodes_a_turn);
  const T gain = T(S(2) * two_pi) * h.thrust;  // of E, a revolution

  // G at the nodes of the first revolution, and what each further one adds.
  std::array<T, nodes_a_turn + 1> first, more;
  const T level = roll.level + gain * first_turn;
  const T pull = h.rho * h.sin_slope, rho2 = h.rho * h.rho, rho_J = h.rho * h.J_min;
  const T swing = T(S(2)) * h.rho * h.cos_slope, sway = T(S(2)) * pull, climb = T(S(2) * step) * h.thrust,
          drive = h.rho * h.drive;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Trig<S>& phi = nodes[k];
    const std::size_t mirrored = nodes_a_turn - k;
    const T q = h.clearance + h.rho * T(phi.versine), J = h.J_min + T(S(2)) * h.rho * T(phi.versine);
    const T even = h.cos_slope * (h.Ic + q * q) * J, odd = (pull * q + drive) * J * T(phi.sin);
    const T rho_K = rho_J * T(phi.cos) - rho2 * T(phi.versine * phi.versine);
    const T E = level + swing * T(phi.cos), E_odd = sway * T(phi.sin);
    first[k] = even + odd + rho_K * (E - E_odd + climb * T(S(k)));
    first[mirrored] = even - odd + rho_K * (E + E_odd + climb * T(S(mirrored)));
    more[k] = more[mirrored] = rho_K * gain;
  }

  std::array<T, turns_a_scan + 1> start;  // G at the first node of each revolution
  for (std::size_t u = 0; u < start.size(); ++u) start[u] = first[0] + T(S(u)) * more[0];

  for (std::size_t i = 0; i < Lanes<T>::count; ++i) flags[i] = {};
  for (std::size_t u = 0; u < static_cast<std::size_t>(turns); ++u) {
    const T turn = T(S(u)), margin = lift_bounds(roll, first_turn + turn).second * T(step * step / S(8));
    T G = start[u];
    for (std::size_t k = 0; k < nodes_a_turn; k += 8) {
      std::uint64_t positive = 0, plain = 0;  // one byte a node, one bit a lane
      for (std::size_t j = 0; j < 8; ++j) {
        const T next = k + j + 1 == nodes_a_turn ? start[u + 1] : first[k + j + 1] + turn * more[k + j + 1];
        positive |= std::uint64_t{Lanes<T>::bits(G > T(0))} << (8 * j);
        plain |= std::uint64_t{Lanes<T>::bits(larger(abs(G) - margin, abs(next - G)) > T(4) * margin)}
                 << (8 * j);
        G = next;
      }
      const std::uint64_t next_positive = positive >> 8 | std::uint64_t{Lanes<T>::bits(G > T(0))} << 56;
      const std::uint64_t sinks = positive & ~next_positive;
      signs[u][k / 8] = positive;
      signs[u][k / 8 + 1] = next_positive >> 56;
      constexpr std::uint64_t lanes = ((std::uint64_t{1} << Lanes<T>::count) - 1) * 0x0101010101010101u;
      for (std::uint64_t fall = plain & sinks & lanes; fall != 0; fall &= fall - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(fall)), lane = bit % 8;
        flags[lane].falls[u] |= std::uint64_t{1} << (k + bit / 8);
      }
      for (std::uint64_t look = ~plain & lanes; look != 0; look &= look - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(look)), lane = bit % 8;
        flags[lane].looks[u] |= std::uint64_t{1} << (k + bit / 8);
        flags[lane].above_left[u] |= positive >> bit << 63 >> (63 - k - bit / 8);
        flags[lane].above_right[u] |= next_positive >> bit << 63 >> (63 - k - bit / 8);
      }
    }
    for (std::size_t i = 0; i < Lanes<T>::count; ++i) flags[i].looks[u] |= flags[i].falls[u];
  }
}

/// What an interval holds.
template <class T>
struct IntervalKind {
  MaskOf<T> fall;     ///< one root, where G falls
  MaskOf<T> unclear;  ///< cannot tell: halve it
};

/// G' is monotone, or has no root, where its values at both ends are beyond |G'''| length^2 / 8 and on one
/// side; then G is monotone too. Without a change of sign between the ends, a zero needs a turning point that
/// comes within |G''| length^2 / 8 of zero. up_a, up_b: whether G > 0 at the ends, as was decided for them.
template <class T>
IntervalKind<T> classify(const CurvedSample<T>& a, const CurvedSample<T>& b, const MaskOf<T>& up_a,
                         const MaskOf<T>& up_b, const LiftBounds<T>& bounds, const T& length) {
  using std::abs;
  const T square = length * length * T(0.125);
  const MaskOf<T> down_a = a.rate < T(0), down_b = b.rate < T(0);
  // neither != nor ^, which xsimd 8 gets wrong for SSE2's and AVX-512's masks
  const MaskOf<T> changes = (up_a & !up_b) | (up_b & !up_a);
  const MaskOf<T> monotone = (down_a == down_b) & (smaller(abs(a.rate), abs(b.rate)) > bounds.third * square);
  const MaskOf<T> near = !(smaller(abs(a.value), abs(b.value)) > bounds.second * square);
  const MaskOf<T> fall = changes & up_a & monotone, unclear = (changes | near) & !monotone;
  return {fall, unclear};
}

}  // namespace leapmap
