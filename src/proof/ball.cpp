// SPDX-License-Identifier: GPL-3.0-or-later
#include "proof/ball.hpp"

#include <algorithm>
#include <stdexcept>

namespace leapmap {
namespace {

/// x - sin x of a number, to the last digits however small it is: as many bits more as the difference loses.
Ball x_minus_sin_of(const arf_t x) {
  constexpr slong most_bits = 3000;
  const slong below = arf_is_zero(x) ? 0 : std::clamp(-arf_abs_bound_lt_2exp_si(x), slong{0}, most_bits);
  const slong bits = Ball::precision + 2 * below + 4;
  Ball number, sine;
  arb_set_arf(number.arb(), x);
  arb_sin(sine.arb(), number.arb(), bits);
  arb_sub(sine.arb(), number.arb(), sine.arb(), bits);
  arb_set_round(sine.arb(), sine.arb(), Ball::precision);
  return sine;
}

/// The bound that `get` tells, as a double that is rounded outwards.
template <class Get>
double bound_of(const arb_t x, Get get, arf_rnd_t outwards) {
  arf_t bound;
  arf_init(bound);
  get(bound, x, Ball::precision);
  const double outside = arf_get_d(bound, outwards);
  arf_clear(bound);
  return outside;
}

}  // namespace

Ball Ball::between(double from, double to) {
  Ball all;
  if (!(from <= to)) {  // not known
    arb_indeterminate(all.x_);
    return all;
  }
  arf_t a, b;
  arf_init(a), arf_init(b);
  arf_set_d(a, from), arf_set_d(b, to);
  arb_set_interval_arf(all.x_, a, b, precision);
  arf_clear(a), arf_clear(b);
  return all;
}

Ball meet(const Ball& a, const Ball& b) {
  if (!b.is_finite()) return a;
  if (!a.is_finite()) return b;
  Ball both;
  if (!arb_intersection(both.x_, a.x_, b.x_, Ball::precision))
    throw std::logic_error("two enclosures of one number have none in common");
  return both;
}

double Ball::lower() const { return bound_of(x_, arb_get_lbound_arf, ARF_RND_FLOOR); }
double Ball::upper() const { return bound_of(x_, arb_get_ubound_arf, ARF_RND_CEIL); }

bool Ball::holds(double number) const { return arb_contains(x_, Ball(number).x_) != 0; }

Trig<Ball> trig(const Ball& angle) {
  const auto [sin, cos] = sincos_of(angle);
  const Ball versine = cos > Ball(0) ? sin * sin / (Ball(1) + cos) : Ball(1) - cos;
  return {sin, cos, versine};
}

Ball x_minus_sin(const Ball& x, const Trig<Ball>& turned) {
  if (abs(x) > Ball(0.25)) return x - turned.sin;
  arf_t from, to;
  arf_init(from), arf_init(to);
  arb_get_interval_arf(from, to, x.arb(), Ball::precision);
  const Ball ends = hull(x_minus_sin_of(from), x_minus_sin_of(to));
  arf_clear(from), arf_clear(to);
  return ends;
}

}  // namespace leapmap
