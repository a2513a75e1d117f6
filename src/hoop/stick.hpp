// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether friction holds a rolling hoop, as functions of the angle alone.
///
/// With the vis viva E = w^2 J both forces times J^2 are trigonometric polynomials without needle, linear in
/// E:
///   N J^2 = P J + rho K E,
///   F J^2 = (q push - sin(theta) J) J + rho s (J - q) E,   push = dE/dphi / 2, q = 1 - rho c.
#pragma once

#include <limits>

#include "hoop/rolling_by_angle.hpp"

namespace leapmap {

/// mu N - F and mu N + F, each times J^2 and raised by 32 roundings of its terms, so that what sticks but for
/// rounding sticks; with their rates by the angle. The contact sticks while both are above zero.
template <class T>
struct StickGuards {
  Sample<T> downhill;  ///< mu N - F: falls where F, downhill, is used up; v then turns backwards
  Sample<T> uphill;    ///< mu N + F
};

/// E: the vis viva at that angle.
template <class T>
StickGuards<T> stick_guards(const Hoop<T>& h, const Trig<T>& phi, const T& E, const T& mu) {
  using S = ScalarOf<T>;
  const T s = phi.sin, c = phi.cos;
  const LiftTerms<T> t = lift_terms(h, phi);
  const T push = torque(h, phi), push1 = -h.rho * cos_from_vertical(h, phi), E1 = T(2) * push;
  const Sample<T> N = lift(h, t, E, E1);

  const T q1 = h.rho * s;
  const T pull = t.q * push - h.sin_slope * t.J, pull1 = q1 * push + t.q * push1 - h.sin_slope * t.J1;
  const T swing = s * (t.J - t.q), swing1 = c * (t.J - t.q) + s * (t.J1 - q1);
  const T F = pull * t.J + h.rho * swing * E,
          F1 = pull1 * t.J + pull * t.J1 + h.rho * (swing1 * E + swing * E1);
  using std::abs;
  const T terms = mu * (t.P * t.J + h.rho * abs(t.K) * E) + (abs(t.q * push) + abs(h.sin_slope) * t.J) * t.J +
                  h.rho * abs(swing) * E;
  const T slack = T(S(32) * std::numeric_limits<S>::epsilon()) * terms;
  return {{mu * N.value - F + slack, mu * N.rate - F1}, {mu * N.value + F + slack, mu * N.rate + F1}};
}

}  // namespace leapmap
