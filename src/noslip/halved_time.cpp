// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/halved_time.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "trajectory/gradient.hpp"

namespace leapmap {

template <class S, class T>
HalvedTime<S, T>::HalvedTime(const Roll<S>& roll, Number tolerance, const GaussRule<Number>& rule)
    : roll_(roll), tolerance_(tolerance) {
  using std::atan2, std::sqrt;
  constexpr std::size_t lanes = Lanes<Plain>::count;
  const std::size_t count = rule.node.size();
  assert(count > 0 && count <= most_nodes);
  rows_ = (count + lanes - 1) / lanes;
  LaneArray<Plain> nodes, weights;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const std::size_t i = row * lanes + k;
      nodes[k] = rule.node[std::min(i, count - 1)], weights[k] = i < count ? rule.weight[i] : Number(0);
    }
    nodes_[row] = Lanes<Plain>::load(nodes.data()), weights_[row] = Lanes<Plain>::load(weights.data());
  }
  release_ = atan2(roll.release_trig.sin, roll.release_trig.cos);
  q0_ = sqrt(-(roll.push > S(0) ? parabola_at_release(roll).nearer : S(-1)));
  const Hoop<S>& hoop = roll.hoop;
  const S rho2 = Number(2) * hoop.rho;
  wide_release_ = abreast<T>(release_), wide_q0_ = abreast<T>(q0_), released_ = abreast<T>(roll.released);
  J_min_ = abreast<T>(hoop.J_min), rho2_ = abreast<T>(rho2), push2_ = abreast<T>(S(Number(2) * roll.push));
  by_sine_ = abreast<T>(S(rho2 * sin_from_vertical(hoop, roll.release_trig)));
  by_versine_ = abreast<T>(S(-rho2 * cos_from_vertical(hoop, roll.release_trig)));
}

/// x past the release. V: T, or Plain for the value alone.
template <class S, class T>
template <class V>
V HalvedTime<S, T>::slowness_past(const V& x) {
  using std::abs;
  const Trig<V> turned = trig(x), phi = trig(V(as<V>(wide_release_) + x));
  // As vis_viva_past_release and contact_inertia have them.
  const V E = as<V>(released_) + (as<V>(push2_) * x + as<V>(by_sine_) * x_minus_sin(x, turned) +
                                  as<V>(by_versine_) * turned.versine);
  const V J = as<V>(J_min_) + as<V>(rho2_) * phi.versine;
  const Plain at = value_of(x), rho2 = value_of(rho2_), energy = value_of(E);
  const Plain terms =
      value_of(released_) + at * (abs(value_of(push2_)) + rho2 * smaller(at, Plain(Number(1))));
  const Plain in_J =
      Plain(Number(0.5)) * rho2 * abs(value_of(phi.sin)) * (Plain(Number(4)) + at) / value_of(J);
  const Plain unsure = Plain(Number(4) * epsilon) * (terms / energy + in_J);
  unsure_ = larger(unsure_,
                   select(energy > Plain(Number(0)), unsure, Plain(std::numeric_limits<Number>::infinity())));
  return slowness(J, E);
}

/// dt / dq, `past` = q - q0.
template <class S, class T>
template <class V>
V HalvedTime<S, T>::stretched_slowness(const V& past) {
  const V q0 = as<V>(wide_q0_), slow = (q0 + past) * slowness_past(V(past * (q0 + q0 + past)));
  return slow + slow;
}

template <class S, class T>
template <class V, class F>
auto HalvedTime<S, T>::rule(const F& f, const S& a, const S& b) {
  const S span = b - a;
  const V from = abreast<V>(as<V>(a)), length = abreast<V>(as<V>(span));
  V sum(Number(0));
  for (std::size_t row = 0; row < rows_; ++row)
    sum = sum + scaled(f(V(from + scaled(length, nodes_[row]))), weights_[row]);
  --panels_left_;
  return sum_of_lanes(sum) * as<V>(span);
}

/// Whether halves agree is judged by values: their derivatives, of integrands with the same singularities,
/// are then better than is asked for by as much.
template <class S, class T>
template <class F>
void HalvedTime<S, T>::halve(const F& f, const S& a, const S& b, const Number& whole, int depth) {
  const S middle = a + (b - a) * S(0.5L);
  unsure_ = Plain(Number(0));
  const S left = rule<T>(f, a, middle), right = rule<T>(f, middle, b), sum = left + right;
  const Number unsure = largest_lane(unsure_), taken = value_of(sum);
  const bool agree =
      std::abs(taken - whole) <=
      std::max(Number(0.1L) * tolerance_ * std::abs(value_of(total_) + taken), unsure * std::abs(taken));
  if (agree || depth == 0 || panels_left_ <= 0 || !(unsure < Number(1))) {
    total_ += agree ? sum : S(std::numeric_limits<Number>::quiet_NaN());
    doubt_ += Number(1.5) * unsure * largest_part(sum);
    return;
  }
  halve(f, a, middle, value_of(left), depth - 1);
  halve(f, middle, b, value_of(right), depth - 1);
}

/// The next place after x where the integrand may be sharp: the needles at 2 pi k, among eighths of a turn,
/// and the minima of E; at most the end.
template <class S, class T>
S HalvedTime<S, T>::edge_after(const S& x, const S& end) const {
  constexpr Number pi = std::numbers::pi_v<Number>, eighth = pi / Number(4), turn = Number(2) * pi;
  const Number release = value_of(release_), from = value_of(x);
  const Number crest =
      std::asin(std::clamp(value_of(roll_.hoop.thrust) / value_of(roll_.hoop.rho), Number(-1), Number(1)));
  const Number minimum =
      pi - crest - std::atan2(value_of(roll_.hoop.sin_slope), value_of(roll_.hoop.cos_slope));
  const auto next = [&](Number first, Number step) {
    const Number after = first + step * (std::floor((release + from - first) / step) + Number(1)) - release;
    return after > from + Number(1e-9L) ? after : after + step;
  };
  return std::min({end, S(next(0, eighth)), S(next(minimum, turn))});
}

template <class S, class T>
S HalvedTime<S, T>::until(const S& end) {
  const S near(1);
  const auto stretched = [this](const auto& past) { return this->stretched_slowness(past); };
  const auto plain = [this](const auto& x) { return this->slowness_past(x); };
  const auto past = [&](const S& x) {
    using std::sqrt;
    return x > S(0) ? S(x / (q0_ + sqrt(q0_ * q0_ + x))) : S(0);
  };
  for (S x(0); x < end;) {
    S to = edge_after(x, end);
    if (x < near) {
      to = std::min(to, near);
      const S from_q = past(x), to_q = past(to);
      halve(stretched, from_q, to_q, rule<Plain>(stretched, from_q, to_q), most_halvings);
    } else {
      halve(plain, x, to, rule<Plain>(plain, x, to), most_halvings);
    }
    x = to;
  }
  if constexpr (has_derivatives<S>)
    if (!(doubt_ <= Number(1e-6) * largest_part(total_)))
      total_.by.fill(std::numeric_limits<Number>::quiet_NaN());
  return total_;
}

template class HalvedTime<double>;
#ifdef LEAPMAP_KERNELS
template class HalvedTime<RollingDual>;
template class HalvedTime<DesignDual>;
#endif
#ifdef LEAPMAP_SCALARS
template class HalvedTime<long double>;
#endif

}  // namespace leapmap
