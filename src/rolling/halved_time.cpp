// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/halved_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trajectory/gradient.hpp"

namespace leapmap {

template <class S>
HalvedTime<S>::HalvedTime(const Roll<S>& roll, Number tolerance, const GaussRule<Number>& rule)
    : roll_(roll), gauss_(rule), tolerance_(tolerance) {
  using std::atan2, std::sqrt;
  release_ = atan2(roll.release_trig.sin, roll.release_trig.cos);
  q0_ = sqrt(-(roll.push > S(0) ? parabola_at_release(roll).nearer : S(-1)));
  two_q0_ = S(2) * q0_;
  const Hoop<S>& hoop = roll.hoop;
  rho2_ = S(2) * hoop.rho, push2_ = S(2) * roll.push;
  by_sine_ = rho2_ * sin_from_vertical(hoop, roll.release_trig);
  by_versine_ = -rho2_ * cos_from_vertical(hoop, roll.release_trig);
}

/// x past the release.
template <class S>
S HalvedTime<S>::slowness_past(const S& x) {
  using std::abs;
  const Trig<S> turned = trig(x), phi = trig(S(release_ + x));
  // As vis_viva_past_release and contact_inertia have them.
  const S E =
      roll_.released + (push2_ * x + by_sine_ * x_minus_sin(x, turned) + by_versine_ * turned.versine);
  const S J = roll_.hoop.J_min + rho2_ * phi.versine;
  const Number at = value_of(x), rho = value_of(roll_.hoop.rho);
  const Number terms =
      value_of(roll_.released) + Number(2) * at * (abs(value_of(roll_.push)) + rho * std::min(at, Number(1)));
  const Number in_J = rho * abs(value_of(phi.sin)) * (Number(4) + at) / value_of(J);
  unsure_ = std::max(unsure_, E > S(0) ? Number(4) * epsilon * (terms / value_of(E) + in_J)
                                       : std::numeric_limits<Number>::infinity());
  return slowness(J, E);
}

/// dt / dq, `past` = q - q0.
template <class S>
S HalvedTime<S>::stretched_slowness(const S& past) {
  return Number(2) * ((q0_ + past) * slowness_past(S(past * (two_q0_ + past))));
}

template <class S>
template <class F>
S HalvedTime<S>::rule(const F& f, const S& a, const S& b) {
  S sum(0);
  for (std::size_t i = 0; i < gauss_.node.size(); ++i)
    sum += gauss_.weight[i] * f(S(a + (b - a) * gauss_.node[i]));
  --panels_left_;
  return sum * (b - a);
}

template <class S>
template <class F>
void HalvedTime<S>::halve(const F& f, const S& a, const S& b, const S& whole, int depth) {
  const S middle = a + (b - a) * S(0.5L);
  unsure_ = Number(0);
  const S left = rule(f, a, middle), right = rule(f, middle, b), sum = left + right;
  const bool agree =
      largest_part(S(sum - whole)) <=
      std::max(Number(0.1L) * tolerance_ * largest_part(S(total_ + sum)), unsure_ * largest_part(sum));
  if (agree || depth == 0 || panels_left_ <= 0 || !(unsure_ < Number(1))) {
    total_ += agree ? sum : S(std::numeric_limits<Number>::quiet_NaN());
    doubt_ += Number(1.5) * unsure_ * largest_part(sum);
    return;
  }
  halve(f, a, middle, left, depth - 1);
  halve(f, middle, b, right, depth - 1);
}

/// The next place after x where the integrand may be sharp: the needles at 2 pi k, among eighths of a turn,
/// and the minima of E; at most the end.
template <class S>
S HalvedTime<S>::edge_after(const S& x, const S& end) const {
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

template <class S>
S HalvedTime<S>::until(const S& end) {
  const S near(1);
  const auto stretched = [this](const S& past) { return stretched_slowness(past); };
  const auto plain = [this](const S& x) { return slowness_past(x); };
  const auto past = [&](const S& x) {
    using std::sqrt;
    return x > S(0) ? S(x / (q0_ + sqrt(q0_ * q0_ + x))) : S(0);
  };
  for (S x(0); x < end;) {
    S to = edge_after(x, end);
    if (x < near) {
      to = std::min(to, near);
      const S from_q = past(x), to_q = past(to);
      halve(stretched, from_q, to_q, rule(stretched, from_q, to_q), most_halvings);
    } else {
      halve(plain, x, to, rule(plain, x, to), most_halvings);
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
