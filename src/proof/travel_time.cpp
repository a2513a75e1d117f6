// SPDX-License-Identifier: GPL-3.0-or-later
#include "proof/travel_time.hpp"

#include <acb_calc.h>

namespace leapmap {
namespace {

/// E / x and J as functions of a complex x past the release:
///   E / x = released / x + 2 push + by_sine (1 - sin x / x) + by_versine (1 - cos x) / x.
struct Slowness {
  Ball released, push2, by_sine, by_versine;
  Ball J_even, J_cos, J_sin;
  bool from_rest;
};

class Complex {
 public:
  Complex() { acb_init(x); }
  Complex(const Complex&) = delete;
  Complex& operator=(const Complex&) = delete;
  ~Complex() { acb_clear(x); }
  acb_t x;
};

/// sqrt(J / E), or from rest 2 q sqrt(J / E) at x = q^2, where it is analytic too.
int slowness(acb_ptr out, const acb_t variable, void* of, slong order, slong bits) {
  const auto& s = *static_cast<const Slowness*>(of);
  Complex x, half, sinc, sine, E, J, part;
  if (s.from_rest)
    acb_mul(x.x, variable, variable, bits);
  else
    acb_set(x.x, variable);
  acb_mul_2exp_si(half.x, x.x, -1);
  // E / x
  acb_sinc(sinc.x, x.x, bits);
  acb_one(E.x);
  acb_sub(E.x, E.x, sinc.x, bits);
  acb_mul_arb(E.x, E.x, s.by_sine.arb(), bits);
  acb_sin(sine.x, half.x, bits);
  acb_sinc(part.x, half.x, bits);
  acb_mul(part.x, part.x, sine.x, bits);
  acb_addmul_arb(E.x, part.x, s.by_versine.arb(), bits);
  acb_add_arb(E.x, E.x, s.push2.arb(), bits);
  // J
  acb_mul(J.x, sinc.x, x.x, bits);
  acb_mul_arb(J.x, J.x, s.J_sin.arb(), bits);
  acb_cos(part.x, x.x, bits);
  acb_addmul_arb(J.x, part.x, s.J_cos.arb(), bits);
  acb_add_arb(J.x, J.x, s.J_even.arb(), bits);
  if (s.from_rest) {
    acb_mul_2exp_si(J.x, J.x, 2);  // (2 q)^2 / x
  } else {
    acb_mul(E.x, E.x, x.x, bits);
    acb_add_arb(E.x, E.x, s.released.arb(), bits);
  }
  acb_div(J.x, J.x, E.x, bits);
  acb_sqrt_analytic(out, J.x, order != 0, bits);
  return 0;
}

}  // namespace

Ball travel_time(const Roll<Ball>& roll, const Ball& from, const Ball& to) {
  const Hoop<Ball>& hoop = roll.hoop;
  const Ball rho2 = Ball(2) * hoop.rho;
  Slowness of{.released = roll.released,
              .push2 = Ball(2) * roll.push,
              .by_sine = rho2 * sin_from_vertical(hoop, roll.release_trig),
              .by_versine = -(rho2 * cos_from_vertical(hoop, roll.release_trig)),
              .J_even = hoop.J_min + rho2,
              .J_cos = -(rho2 * roll.release_trig.cos),
              .J_sin = rho2 * roll.release_trig.sin,
              .from_rest = roll.released == Ball(0)};
  const auto variable = [&](const Ball& x) { return of.from_rest ? sqrt(x) : x; };
  Complex begin, end, time;
  acb_set_arb(begin.x, variable(from).arb()), acb_set_arb(end.x, variable(to).arb());
  constexpr slong digits = 38;  // bits, relative: some 4e-12
  mag_t absolute;
  mag_init(absolute);
  mag_set_ui_2exp_si(absolute, 1, -digits);
  acb_calc_integrate(time.x, slowness, &of, begin.x, end.x, digits, absolute, nullptr, Ball::precision);
  mag_clear(absolute);
  Ball told;
  arb_set(told.arb(), acb_realref(time.x));
  return told;
}

}  // namespace leapmap
