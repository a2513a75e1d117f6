// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the normal force of a rolling hoop may fall through zero: no interval is passed over that could hold
/// a fall.
///
/// A revolution is divided at 40 nodes whose sines and cosines all designs share. Between two nodes, h apart,
/// G (hoop/rolling_by_angle.hpp) differs from its chord by at most m = |G''| h^2 / 8, and G' from the
/// chord's slope by at most 4 m / h. So an interval is plain if its values differ by more than 4 m, for then
/// G is monotone, or if one of them is beyond 5 m, for then G is monotone or keeps off zero.
///
/// Where that does not decide, the cubic p through these two nodes and one on either side often does. On the
/// interval |G - p| <= 3/128 h^4 |G''''|. And G' - p' = G''''(.) / 6 times the product of the distances to
/// three zeros of it (Rolle), one between each two nodes, which is at most 2 h^3 there: |G' - p'| <= h^3 / 3
/// |G''''|. As p lies between the least and largest of its Bezier coefficients, and p' likewise, the interval
/// is plain if those of p are all beyond 3/128 h^4 |G''''| on one side of zero, for then G keeps off zero, or
/// if their differences, p' h / 3, are all beyond h^4 / 9 |G''''| on one side, for then G is monotone.
///
/// A plain interval holds one fall or none, as its signs tell. The others, or parts of them, are told by
/// values and slopes at their ends and the bounds of |G''| and |G'''|: one fall, nothing, or unclear; an
/// unclear one is halved until it is clear. So pairs a hair apart are found by a bound, not by luck.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "hoop/rolling_by_angle.hpp"

namespace leapmap {

inline constexpr int nodes_a_turn = 40;  ///< in groups of 8, a bit each and one more
static_assert(nodes_a_turn % 8 == 0 && nodes_a_turn < 64);
inline constexpr int turns_a_scan = 3;  ///< each further one costs a third of the first

/// Of one design, a word a revolution: bit k is of node k, or of the interval from there to node k + 1.
using NodeBits = std::array<std::uint64_t, turns_a_scan>;

struct ScanFlags {
  NodeBits looks;  ///< intervals that may hold a fall
  NodeBits falls;  ///< those of them that surely hold one, and nothing else
  /// Nodes where G > 0; bit 40 is of the next revolution's first node. The sign at a node is computed once,
  /// and decides for the intervals on both sides of it: were it computed twice, a root on a node could be
  /// lost by rounding, or counted twice.
  NodeBits above;
};

/// Of the nodes 0 to 10, which the others mirror: cosines and sines of once, twice and three times the angle.
template <class S>
using ScanNodes = std::array<std::array<SinCos<S>, 4>, nodes_a_turn / 4 + 1>;

template <class S>
ScanNodes<S> scan_nodes() {
  ScanNodes<S> nodes;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (std::size_t m = 0; m < nodes[k].size(); ++m)
      nodes[k][m] = sincos_of(S(2) * std::numbers::pi_v<S> * S(m * k) / S(nodes_a_turn));
  return nodes;
}

/// G at the nodes of each revolution, of as many designs as T has lanes.
template <class T>
struct NodeValues {
  using S = ScalarOf<T>;
  static constexpr std::size_t nodes = nodes_a_turn;
  std::array<T, nodes + 1> first, more;  ///< of the first revolution, and what each further one adds

  NodeValues(const ScanNodes<S>& shared, const Roll<T>& roll, const LiftHarmonics<T>& of,
             const T& first_turn) {
    const Hoop<T>& h = roll.hoop;
    const T gain = T(S(4) * std::numbers::pi_v<S>) * h.thrust;  // of E, a revolution
    const T level = roll.level + gain * first_turn, climb = gain * T(S(1) / S(nodes));
    const auto put = [&](std::size_t k, const T& value, const T& rho_K) {
      first[k] = value + rho_K * (level + climb * T(S(k)));
      more[k] = rho_K * gain;
    };
    for (std::size_t k = 0; k < shared.size(); ++k) {
      const auto& [zero, once, twice, thrice] = shared[k];
      const T even = of.cosine[0] + of.cosine[2] * T(twice.cos),
              odd = of.cosine[1] * T(once.cos) + of.cosine[3] * T(thrice.cos),
              even_sine = of.sine[2] * T(twice.sin),
              odd_sine = of.sine[1] * T(once.sin) + of.sine[3] * T(thrice.sin);
      const T even_K = of.swing[0] + of.swing[2] * T(twice.cos), odd_K = of.swing[1] * T(once.cos);
      const T near = even + odd, far = even - odd, near_K = even_K + odd_K, far_K = even_K - odd_K;
      const T near_sine = odd_sine + even_sine, far_sine = odd_sine - even_sine;
      put(k, near + near_sine, near_K);
      put(nodes / 2 - k, far + far_sine, far_K);
      put(nodes / 2 + k, far - far_sine, far_K);
      put(nodes - k, near - near_sine, near_K);
    }
    // At phi = 0 the harmonics may cancel to nothing.
    const T rho_K = h.rho * h.J_min, at_rest = h.cos_slope * (h.Ic + h.clearance * h.clearance) * h.J_min,
            high = T(S(2)) * h.rho * h.cos_slope;
    put(0, at_rest + rho_K * high, rho_K), put(nodes, at_rest + rho_K * high, rho_K);
  }

  /// At node k of revolution u. The last node of one is the first of the next, to the last bit.
  T operator()(std::size_t u, std::size_t k) const {
    return k == nodes ? first[0] + T(S(u + 1)) * more[0] : first[k] + T(S(u)) * more[k];
  }
  /// A node before the first of revolution u, and after its last.
  T before(std::size_t u) const { return first[nodes - 1] + T(S(u) - S(1)) * more[nodes - 1]; }
  T after(std::size_t u) const { return first[1] + T(S(u + 1)) * more[1]; }
};

/// Whether an interval is plain by the cubic through the values at its ends, b0 and b3, and at the nodes
/// before and after. fine: h^4 |G''''|.
template <class T>
MaskOf<T> is_plain_by_cubic(const T& before, const T& b0, const T& b3, const T& after, const T& fine) {
  using S = ScalarOf<T>;
  const T b1 = b0 + (T(6) * b3 - T(3) * b0 - T(2) * before - after) * T(S(1) / S(18));
  const T b2 = b3 - (before - T(6) * b0 + T(3) * b3 + T(2) * after) * T(S(1) / S(18));
  const T d0 = b1 - b0, d1 = b2 - b1, d2 = b3 - b2;
  const T off = fine * T(S(3) / S(128)), steep = fine * T(S(1) / S(9));
  const T least = smaller(smaller(b0, b1), smaller(b2, b3)), most = larger(larger(b0, b1), larger(b2, b3));
  const T least_rise = smaller(smaller(d0, d1), d2), most_rise = larger(larger(d0, d1), d2);
  return (least > off) | (most < -off) | (most_rise < -steep) | (least_rise > steep);
}

/// Flags the intervals of `turns` <= turns_a_scan revolutions that may hold a fall of G, one ScanFlags a
/// lane. Of the first revolution it tells what is from node `from` on; before that it may tell nothing.
template <class T>
void scan_turns(const ScanNodes<ScalarOf<T>>& nodes, const Roll<T>& roll, const T& first_turn, int turns,
                std::size_t from, ScanFlags* flags) {
  using std::abs;
  using S = ScalarOf<T>;
  using LaneWord = typename Lanes<T>::Word;
  constexpr std::size_t group = 8;
  constexpr S step = S(2) * std::numbers::pi_v<S> / S(nodes_a_turn), square = step * step;
  const LiftHarmonics<T> harmonics = lift_harmonics(roll.hoop);
  const NodeValues<T> G(nodes, roll, harmonics, first_turn);
  for (std::size_t i = 0; i < Lanes<T>::count; ++i) flags[i] = {};
  for (std::size_t u = 0; u < static_cast<std::size_t>(turns); ++u) {
    const LiftBounds<T> bounds = lift_bounds(roll, harmonics, T(first_turn + T(S(u))));
    const T margin = bounds.second * T(square / S(8)), margin4 = T(4) * margin, margin5 = T(5) * margin,
            fine = bounds.fourth * T(square * square);
    const std::size_t begin = u == 0 ? from / group * group : 0;
    LaneWord above(0), plain(0);
    for (std::size_t k = begin; k < nodes_a_turn; k += group) {
      std::array<T, group + 1> values;
      values[0] = G(u, k);
      T least = values[0];
      for (std::size_t j = 1; j <= group; ++j) values[j] = G(u, k + j), least = smaller(least, values[j]);
      if (all(least > margin5)) {  // the plane pushes well, as on most of the way
        above = above | LaneWord(std::uint64_t{0x1ff} << k),
        plain = plain | LaneWord(std::uint64_t{0xff} << k);
        continue;
      }
      std::array<T, group> contrast;  // plain above margin4
      T worst = contrast[0] = larger(abs(values[0]) - margin, abs(values[1] - values[0]));
      above = Lanes<T>::marked(above, values[0] > T(0), std::uint64_t{1} << k);
      for (std::size_t j = 1; j < group; ++j) {
        contrast[j] = larger(abs(values[j]) - margin, abs(values[j + 1] - values[j]));
        worst = smaller(worst, contrast[j]);
        above = Lanes<T>::marked(above, values[j] > T(0), std::uint64_t{1} << (k + j));
      }
      above = Lanes<T>::marked(above, values[group] > T(0), std::uint64_t{1} << (k + group));
      if (all(worst > margin4)) {
        plain = plain | LaneWord(std::uint64_t{0xff} << k);
        continue;
      }
      for (std::size_t j = 0; j < group; ++j) {
        MaskOf<T> is_plain = contrast[j] > margin4;
        if (!all(is_plain))
          is_plain = is_plain |
                     is_plain_by_cubic(k + j == 0 ? G.before(u) : G(u, k + j - 1), values[j], values[j + 1],
                                       k + j + 1 == nodes_a_turn ? G.after(u) : G(u, k + j + 2), fine);
        plain = Lanes<T>::marked(plain, is_plain, std::uint64_t{1} << (k + j));
      }
    }
    const LaneWord scanned((std::uint64_t{1} << nodes_a_turn) - (std::uint64_t{1} << begin));
    const LaneWord sinks = above & ~(above >> 1) & scanned, falls = sinks & plain,
                   looks = (~plain & scanned) | sinks;
    std::array<std::uint64_t, Lanes<T>::count> lanes;
    const auto tell = [&](const LaneWord& word, NodeBits ScanFlags::*bits) {
      Lanes<T>::store(word, lanes.data());
      for (std::size_t i = 0; i < lanes.size(); ++i) (flags[i].*bits)[u] = lanes[i];
    };
    tell(looks, &ScanFlags::looks), tell(falls, &ScanFlags::falls), tell(above, &ScanFlags::above);
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
