// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether friction holds a rolling hoop, as functions of the angle alone.
///
/// With the vis viva E = w^2 J both forces times J^2 are trigonometric polynomials without needle, linear in
/// E:
///   N J^2 = P J + rho K E,
///   F J^2 = (q tau - sin(theta) J) J + rho s (J - q) E,   tau = dE/dphi / 2, q = 1 - rho c.
#pragma once

#include <limits>

#include "physics/rolling_by_angle.hpp"

namespace leapmap {

/// mu N - F and mu N + F, each times J^2, with their rates by the angle: the contact sticks while both are
/// above zero.
template <class T>
struct StickGuards {
  Sample<T> downhill;  ///< mu N - F: falls where F, downhill, is used up; v then turns backwards
  Sample<T> uphill;    ///< mu N + F
};

/// E: the vis viva at that angle.
template <class T>
StickGuards<T> stick_guards(const Hoop<T>& h, const Trig<T>& phi, const T& E, const T& mu) {
  using S = ScalarOf<T>;
  const T s = phi.sin, c = phi.cos, sin_above = sin_from_vertical(h, phi);
  const T J = contact_inertia(h, phi), J1 = T(2) * h.rho * s;
  const T q = h.clearance + h.rho * phi.versine, q1 = h.rho * s;
  const T tau = h.sin_slope - h.rho * sin_above, tau1 = -h.rho * cos_from_vertical(h, phi), E1 = T(2) * tau;

  const T P = h.cos_slope * (h.Ic + q * q) + h.rho * h.sin_slope * s * q;
  const T P1 = h.rho * (T(2) * h.cos_slope * s * q + h.sin_slope * (h.rho * s * s + c * q));
  const T K = h.J_min * c - h.rho * phi.versine * phi.versine, K1 = -s * J;
  const T N = P * J + h.rho * K * E, N1 = P1 * J + P * J1 + h.rho * (K1 * E + K * E1);

  const T pull = q * tau - h.sin_slope * J, pull1 = q1 * tau + q * tau1 - h.sin_slope * J1;
  const T swing = s * (J - q), swing1 = c * (J - q) + s * (J1 - q1);
  const T F = pull * J + h.rho * swing * E, F1 = pull1 * J + pull * J1 + h.rho * (swing1 * E + swing * E1);
  using std::abs;
  const T terms =
      mu * (P * J + h.rho * abs(K) * E) + (abs(q * tau) + h.sin_slope * J) * J + h.rho * abs(swing) * E;
  const T slack = T(S(32) * std::numeric_limits<S>::epsilon()) * terms;
  return {{mu * N - F + slack, mu * N1 - F1}, {mu * N + F + slack, mu * N1 + F1}};
}

}  // namespace leapmap
