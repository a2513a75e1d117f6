// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the normal force of a rolling hoop may fall through zero: no interval is passed over that could hold a fall.
///
/// A revolution is divided at 48 nodes whose sines and cosines all designs share. Between two nodes, h apart, G
/// (physics/rolling_by_angle.hpp) differs from its chord by at most |G''| h^2 / 8, so that an interval with both
/// values beyond that, on the same side, holds no zero. The others are flagged. A flagged interval, or a part of it,
/// is then told by values and slopes at its ends and the bounds of |G''| and |G'''|: one fall, nothing, or unclear; an
/// unclear one is halved until it is clear. So pairs a hair apart are found by a bound, not by luck.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "physics/rolling_by_angle.hpp"

namespace leapmap {

inline constexpr int nodes_a_turn = 48;
inline constexpr int turns_a_scan = 3;  ///< each further one costs a third of the first

/// Flags of one design: bit k of turn t is the interval from node k to k + 1 of revolution first_turn + t.
using ScanFlags = std::array<std::uint64_t, turns_a_scan>;

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

/// Spreads eight bytes, one a node with one bit a lane, into eight bytes, one a lane with one bit a node.
inline std::uint64_t transpose_bits(std::uint64_t x) {
  std::uint64_t t = (x ^ (x >> 7)) & 0x00aa00aa00aa00aau;
  x ^= t ^ (t << 7);
  t = (x ^ (x >> 14)) & 0x0000cccc0000ccccu;
  x ^= t ^ (t << 14);
  t = (x ^ (x >> 28)) & 0x00000000f0f0f0f0u;
  return x ^ t ^ (t << 28);
}

/// Flags the intervals of `turns` <= turns_a_scan revolutions that may hold a zero of G, one ScanFlags a lane.
template <class T>
void scan_turns(const ScanNodes<ScalarOf<T>>& nodes, const Roll<T>& roll, const T& first_turn, int turns,
                ScanFlags* flags) {
  using S = ScalarOf<T>;
  constexpr int half = nodes_a_turn / 2;
  const Hoop<T>& h = roll.hoop;
  const S two_pi = S(2) * std::numbers::pi_v<S>, step = two_pi / S(nodes_a_turn);
  const T gain = T(S(2) * two_pi) * h.sin_slope;  // of E, a revolution

  std::array<T, turns_a_scan> margin;
  for (int t = 0; t < turns; ++t)
    margin[static_cast<std::size_t>(t)] = lift_bounds(roll, first_turn + T(S(t))).second * T(step * step / S(8));

  // Whether G is above its margin, or below minus it: one bit a lane, one byte a node.
  using Bytes = std::array<std::array<std::uint8_t, 64>, turns_a_scan>;
  alignas(64) Bytes above{}, below{};
  const auto note = [&](int node, T G, const T& more) {
    for (int t = 0; t < turns; ++t) {
      const auto u = static_cast<std::size_t>(t), k = static_cast<std::size_t>(node);
      above[u][k] = static_cast<std::uint8_t>(Lanes<T>::bits(G > margin[u]));
      below[u][k] = static_cast<std::uint8_t>(Lanes<T>::bits(G < -margin[u]));
      G = G + more;
    }
  };
  const T level = roll.level + gain * first_turn;
  const T pull = h.rho * h.sin_slope, rho2 = h.rho * h.rho, rho_J = h.rho * h.J_min;
  const T swing = T(S(2)) * h.rho * h.cos_slope, sway = T(S(2)) * pull, climb = T(S(2) * step) * h.sin_slope;
  for (int k = 0; k <= half; ++k) {
    const Trig<S>& phi = nodes[static_cast<std::size_t>(k)];
    const T q = h.clearance + h.rho * T(phi.versine), J = h.J_min + T(S(2)) * h.rho * T(phi.versine);
    const T even = h.cos_slope * (h.Ic + q * q) * J, odd = pull * q * J * T(phi.sin);
    const T rho_K = rho_J * T(phi.cos) - rho2 * T(phi.versine * phi.versine);
    const T E = level + swing * T(phi.cos), E_odd = sway * T(phi.sin);
    note(k, even + odd + rho_K * (E - E_odd + climb * T(S(k))), rho_K * gain);
    if (k < half)
      note(nodes_a_turn - k, even - odd + rho_K * (E + E_odd + climb * T(S(nodes_a_turn - k))), rho_K * gain);
  }

  for (int t = 0; t < turns; ++t) {
    const auto u = static_cast<std::size_t>(t);
    std::array<std::uint64_t, 8> lane_flags{};
    for (std::size_t k = 0; k < nodes_a_turn; k += 8) {
      std::uint64_t up, next_up, down, next_down;
      std::memcpy(&up, &above[u][k], 8), std::memcpy(&next_up, &above[u][k + 1], 8);
      std::memcpy(&down, &below[u][k], 8), std::memcpy(&next_down, &below[u][k + 1], 8);
      const std::uint64_t by_lane = transpose_bits(~((up & next_up) | (down & next_down)));
      for (std::size_t i = 0; i < Lanes<T>::count; ++i)
        lane_flags[i] |= (by_lane >> (8 * i) & 0xffu) << k;
    }
    for (std::size_t i = 0; i < Lanes<T>::count; ++i) flags[i][u] = lane_flags[i];
  }
}

/// What an interval holds.
template <class T>
struct IntervalKind {
  MaskOf<T> fall;     ///< one root, where G falls
  MaskOf<T> unclear;  ///< cannot tell: halve it
};

/// G' is monotone, or has no root, where its values at both ends are beyond |G'''| length^2 / 8 and on one side; then G
/// is monotone too. Without a change of sign between the ends, a zero needs a turning point that comes within
/// |G''| length^2 / 8 of zero.
template <class T>
IntervalKind<T> classify(const CurvedSample<T>& a, const CurvedSample<T>& b, const LiftBounds<T>& bounds,
                         const T& length) {
  using std::abs;
  const T square = length * length * T(0.125);
  const MaskOf<T> up_a = a.value > T(0), up_b = b.value > T(0);
  const MaskOf<T> down_a = a.rate < T(0), down_b = b.rate < T(0);
  const MaskOf<T> changes = up_a != up_b;
  const MaskOf<T> monotone = (down_a == down_b) & (smaller(abs(a.rate), abs(b.rate)) > bounds.third * square);
  const MaskOf<T> near = !(smaller(abs(a.value), abs(b.value)) > bounds.second * square);
  const MaskOf<T> fall = changes & up_a & monotone, unclear = (changes | near) & !monotone;
  return {fall, unclear};
}

}  // namespace leapmap
