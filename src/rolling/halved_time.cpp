// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/halved_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {

template <class S>
HalvedTime<S>::HalvedTime(const Roll<S>& roll, const S& tolerance, const GaussRule<S>& rule)
    : roll_(roll),
      gauss_(rule),
      tolerance_(tolerance),
      release_(std::atan2(roll.release_trig.sin, roll.release_trig.cos)),
      q0_(std::sqrt(-(roll.push > S(0) ? parabola_at_release(roll).nearer : S(-1)))) {}

/// x past the release.
template <class S>
S HalvedTime<S>::slowness_past(const S& x) {
  using std::abs;
  const Hoop<S>& hoop = roll_.hoop;
  const S E = vis_viva_past_release(roll_, x);
  const S terms = roll_.released + S(2) * x * (abs(roll_.push) + hoop.rho * std::min(x, S(1)));
  const Trig<S> phi = trig(release_ + x);
  const S J = contact_inertia(hoop, phi);
  const S in_J = hoop.rho * abs(phi.sin) * (S(4) + x) / J;
  unsure_ =
      std::max(unsure_, E > S(0) ? S(4) * epsilon * (terms / E + in_J) : std::numeric_limits<S>::infinity());
  return slowness(J, E);
}

/// dt / dq, `past` = q - q0.
template <class S>
S HalvedTime<S>::stretched_slowness(const S& past) {
  return S(2) * (q0_ + past) * slowness_past(past * (S(2) * q0_ + past));
}

template <class S>
template <class F>
S HalvedTime<S>::rule(const F& f, const S& a, const S& b) {
  S sum(0);
  for (std::size_t i = 0; i < gauss_.node.size(); ++i)
    sum += gauss_.weight[i] * f(a + (b - a) * gauss_.node[i]);
  --panels_left_;
  return sum * (b - a);
}

template <class S>
template <class F>
void HalvedTime<S>::halve(const F& f, const S& a, const S& b, const S& whole, int depth) {
  const S middle = a + (b - a) * S(0.5L);
  unsure_ = S(0);
  const S left = rule(f, a, middle), right = rule(f, middle, b), sum = left + right;
  const bool agree = std::abs(sum - whole) <= std::max(S(0.1L) * tolerance_ * (total_ + sum), unsure_ * sum);
  if (agree || depth == 0 || panels_left_ <= 0 || !(unsure_ < S(1))) {
    total_ += agree ? sum : std::numeric_limits<S>::quiet_NaN();
    return;
  }
  halve(f, a, middle, left, depth - 1);
  halve(f, middle, b, right, depth - 1);
}

/// The next place after x where the integrand may be sharp: the needles at 2 pi k, among eighths of a turn,
/// and the minima of E; at most the end.
template <class S>
S HalvedTime<S>::edge_after(const S& x, const S& end) const {
  const S eighth = std::numbers::pi_v<S> / S(4), turn = S(2) * std::numbers::pi_v<S>;
  const S minimum = std::numbers::pi_v<S> -
                    std::asin(std::clamp(roll_.hoop.thrust / roll_.hoop.rho, S(-1), S(1))) -
                    slope_of(roll_.hoop);
  const auto next = [&](const S& first, const S& step) {
    const S after = first + step * (std::floor((release_ + x - first) / step) + S(1)) - release_;
    return after > x + S(1e-9L) ? after : after + step;
  };
  return std::min({end, next(S(0), eighth), next(minimum, turn)});
}

template <class S>
S HalvedTime<S>::until(const S& end) {
  const S near(1);
  const auto stretched = [this](const S& past) { return stretched_slowness(past); };
  const auto plain = [this](const S& x) { return slowness_past(x); };
  const auto past = [&](const S& x) { return x > S(0) ? x / (q0_ + std::sqrt(q0_ * q0_ + x)) : S(0); };
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
  return total_;
}

template class HalvedTime<double>;
#ifdef LEAPMAP_SCALARS
template class HalvedTime<long double>;
#endif

}  // namespace leapmap
