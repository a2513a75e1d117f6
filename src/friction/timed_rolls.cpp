// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/timed_rolls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "friction/roll_timing.hpp"

namespace leapmap {
namespace {

constexpr double longest_panel = 2.8, shortest_panel = 0.1;  // [rad]

}  // namespace

template <class T>
TimedRolls<T>::TimedRolls(double tolerance, std::size_t most)
    : tolerance_(panel_tolerance<S>(tolerance)), motions_(most), clocks_(most) {}

template <class T>
void TimedRolls<T>::begin(const Roll<T>& rolls, const T& x, const Places& places, unsigned which) {
  using std::abs, std::sqrt;
  // J has a needle at phi = 0, half as wide as d, cosh d = 1 + J_min / (2 rho). A narrow one may hide between
  // nodes, so that the tail itself is asked for, and not its square.
  const MaskOf<T> has_needle = !(rolls.hoop.J_min > T(S(0.04)) * rolls.hoop.rho);
  const T longest = select(has_needle, T(S(0.5 * longest_panel)), T(S(longest_panel)));
  const T resolving = select(has_needle, T(tolerance_), T(S(0.03) * std::sqrt(tolerance_)));
  const T shift = zero_before_release(rolls, x);
  const auto [released, push2, by_sine, by_versine, J_min, by_turned, J_cos, J_sin] = past_release(rolls);
  motions_.template store<T>({released, push2, by_sine, by_versine, J_min, by_turned, J_cos, J_sin},
                             places.data(), width);
  clocks_.template store<T>(
      {shift, sqrt(x - shift), sqrt(-shift), T(S(0)), longest, resolving, abs(rolls.hoop.thrust)},
      places.data(), width);
  for (std::size_t i = 0; i < width; ++i)
    if (which >> i & 1u) waiting_.push_back(places[i]);
}

/// By panels as long as the nodes resolve. The error of an integral goes as the tail's square, which holds
/// where no needle hides between nodes.
template <class T>
void TimedRolls<T>::pass(std::vector<Timed>& timed) {
  using std::sqrt;
  const std::size_t count = std::min(width, waiting_.size()), first = waiting_.size() - count;
  Places index;
  for (std::size_t i = 0; i < width; ++i) index[i] = waiting_[first + (i < count ? i : 0)];
  waiting_.resize(first);
  const auto [released, push2, by_sine, by_versine, J_min, by_turned, J_cos, J_sin] =
      motions_.template load<T>(index.data());
  const PastRelease<T> motion{released, push2, by_sine, by_versine, J_min, by_turned, J_cos, J_sin};
  const auto [shift, end, from, so_far, length, resolving, thrust] = clocks_.template load<T>(index.data());
  T to = sqrt(from * from + length);
  to = select(to * to + T(S(0.3)) * length > end * end, end, to);
  const T span = to - from;
  typename SpectralPanel<T, nodes>::Values f;
  T least_E(std::numeric_limits<S>::max());
  for (std::size_t i = 0; i < nodes; ++i) {
    const T q = from + span * T(panel_.node[i]), x = shift + q * q;
    const Trig<T> turned = trig(x);
    const T E = motion.vis_viva(x, turned, x_minus_sin(x, turned));
    f[i] = q * slowness(motion.inertia(turned), E);
    least_E = smaller(least_E, E);
  }
  const T whole = T(S(2)) * span * panel_.integral(f), tail = T(S(2)) * span * panel_.tail(f);
  const T rounding = time_rounding(released, thrust, to, least_E);
  const MaskOf<T> resolved = tail <= larger(resolving, rounding) * whole;
  const T sum = select(resolved, so_far + whole, so_far), at = select(resolved, to, from),
          next = select(resolved, length, T(S(0.5)) * length);
  clocks_.template store<T>({shift, end, at, sum, next, resolving, thrust}, index.data(), count);
  const unsigned done = Lanes<T>::bits(resolved & (to >= end)),
                 too_short = Lanes<T>::bits(!(next > T(S(shortest_panel))));
  const auto taken = lanes_of(sum);
  for (std::size_t i = 0; i < count; ++i) {
    if (done >> i & 1u)
      timed.push_back({index[i], taken[i]});
    else if (too_short >> i & 1u)
      timed.push_back({index[i], std::numeric_limits<S>::quiet_NaN()});
    else
      waiting_.push_back(index[i]);
  }
}

#ifdef LEAPMAP_KERNELS
template class TimedRolls<Batch>;
#endif

}  // namespace leapmap
