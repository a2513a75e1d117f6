// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip as functions of the angle alone: energy is conserved, so the spin is explicit.
///
/// With the vis viva E(phi) = w^2 J(phi), twice the kinetic energy, the normal force (11) is
///   N = (P J + rho K E) / J^2,   P = cos(theta) (Ic + q^2) + rho sin(theta) s q,   K = J_min c - rho v^2,
/// in s = sin phi, c = cos phi, v = 1 - c, q = 1 - rho c. The numerator G = P J + rho K E has the sign of N
/// and no needle where J is small: a trigonometric polynomial of degree 3 plus phi times one of degree 2. It
/// is linear in E, which gains 4 pi sin(theta) a revolution: G of all revolutions follows from one
/// evaluation.
#pragma once

#include <algorithm>
#include <limits>
#include <numbers>

#include "numerics/root.hpp"
#include "physics/parameters.hpp"
#include "physics/rolling.hpp"

namespace leapmap {

/// A hoop on its way from one release.
template <class T>
struct Roll {
  Hoop<T> hoop;
  T release;             ///< phi0 [rad]
  Trig<T> release_trig;  ///< of it
  T released;            ///< E at release, w0^2 J(phi0)
  T level;               ///< E(phi) - 2 phi sin(theta) - 2 rho cos(theta + phi), the same at every angle
  T push;                ///< dE/dphi / 2 at release
};

/// dE/dphi / 2, the torque about the contact: sin(theta) - rho sin(theta + phi).
template <class T>
T torque(const Hoop<T>& hoop, const Trig<T>& phi) {
  return hoop.sin_slope - hoop.rho * sin_from_vertical(hoop, phi);
}

template <class T>
Roll<T> begin_roll(const Hoop<T>& hoop, const T& release, const T& spin) {
  const Trig<T> phi = trig(release);
  const T released = spin * spin * contact_inertia(hoop, phi);
  return {.hoop = hoop,
          .release = release,
          .release_trig = phi,
          .released = released,
          .level = released - T(2) * (release * hoop.sin_slope + hoop.rho * cos_from_vertical(hoop, phi)),
          .push = torque(hoop, phi)};
}

/// The same roll in every lane.
template <class T>
Roll<T> widened(const Roll<ScalarOf<T>>& roll) {
  return {.hoop = widened<T>(roll.hoop),
          .release = T(roll.release),
          .release_trig = {T(roll.release_trig.sin), T(roll.release_trig.cos), T(roll.release_trig.versine)},
          .released = T(roll.released),
          .level = T(roll.level),
          .push = T(roll.push)};
}

/// E at an angle, accurate to a few roundings of its largest term.
template <class T>
T vis_viva(const Roll<T>& roll, const T& angle, const Trig<T>& phi) {
  return roll.level +
         T(2) * (angle * roll.hoop.sin_slope + roll.hoop.rho * cos_from_vertical(roll.hoop, phi));
}

/// E an angle x past the release, without cancellation however small x is and however near the release is to
/// an equilibrium: E0 + 2 push x + 2 rho sin(theta + phi0) (x - sin x) - 2 rho cos(theta + phi0) (1 - cos x).
template <class T>
T vis_viva_past_release(const Roll<T>& roll, const T& x, const Trig<T>& turned, const T& x_less_sin) {
  const Hoop<T>& hoop = roll.hoop;
  return roll.released +
         T(2) * (roll.push * x + hoop.rho * (sin_from_vertical(hoop, roll.release_trig) * x_less_sin -
                                             cos_from_vertical(hoop, roll.release_trig) * turned.versine));
}
template <class T>
T vis_viva_past_release(const Roll<T>& roll, const T& x) {
  const Trig<T> turned = trig(x);
  return vis_viva_past_release(roll, x, turned, x_minus_sin(x, turned.sin));
}

/// Where E is least for the first time after the release. E has minima only if rho > sin(theta), where theta
/// + phi = pi - asin(sin(theta) / rho); they rise from one revolution to the next, so that the first one
/// tells whether the hoop stalls. Otherwise E rises always, and least where theta + phi = pi / 2.
template <class T>
struct FirstMinimum {
  T angle;
  T crest;            ///< asin(sin(theta) / rho), or pi / 2
  MaskOf<T> is_real;  ///< E has minima
};
template <class T>
FirstMinimum<T> first_minimum(const Roll<T>& roll) {
  using std::asin, std::floor;
  const T pi(std::numbers::pi_v<ScalarOf<T>>), two_pi = T(2) * pi;
  const MaskOf<T> is_real = roll.hoop.rho > roll.hoop.sin_slope;
  const T crest = asin(select(is_real, roll.hoop.sin_slope / roll.hoop.rho, T(1)));
  const T phase = pi - crest - roll.hoop.slope;
  return {phase + two_pi * (floor((roll.release - phase) / two_pi) + T(1)), crest, is_real};
}

/// Where a hoop stalls whose first minimum of E is real and below zero: between E's maximum, or the release
/// if that is later, and there.
template <class S>
S stall_angle(const Roll<S>& roll, const S& minimum, const S& crest) {
  const auto vis_viva_at = [&](const S& angle) {
    return Sample<S>{vis_viva_past_release(roll, S(angle - roll.release)),
                     S(2) * torque(roll.hoop, trig(angle))};
  };
  const S from = std::max(roll.release, minimum - std::numbers::pi_v<S> + S(2) * crest);
  const S resolution = S(4) * std::numeric_limits<S>::epsilon() * std::max(S(1), std::abs(minimum));
  return polish_root(vis_viva_at, from, minimum, S(0.5L) * (from + minimum), false, resolution);
}

/// What G is made of, G = P J + rho K E, with rates by the angle.
template <class T>
struct LiftTerms {
  T q, J, J1, P, P1, K, K1;
  T bend;  ///< d(s q)/dphi
};

template <class T>
LiftTerms<T> lift_terms(const Hoop<T>& h, const Trig<T>& phi) {
  const T s = phi.sin, c = phi.cos;
  const T J = contact_inertia(h, phi), q = h.clearance + h.rho * phi.versine;
  const T bend = h.rho * s * s + c * q;
  return {.q = q,
          .J = J,
          .J1 = T(2) * h.rho * s,
          .P = h.cos_slope * (h.Ic + q * q) + h.rho * h.sin_slope * s * q,
          .P1 = h.rho * (T(2) * h.cos_slope * s * q + h.sin_slope * bend),
          .K = h.J_min * c - h.rho * phi.versine * phi.versine,
          .K1 = -s * J,
          .bend = bend};
}

/// G and G', given E and E' at that angle.
template <class T>
Sample<T> lift(const Hoop<T>& h, const LiftTerms<T>& t, const T& E, const T& E1) {
  return {t.P * t.J + h.rho * t.K * E, t.P1 * t.J + t.P * t.J1 + h.rho * (t.K1 * E + t.K * E1)};
}

/// G and its first three derivatives at an angle.
template <class T>
CurvedSample<T> lift(const Roll<T>& roll, const T& angle) {
  const Hoop<T>& h = roll.hoop;
  const Trig<T> phi = trig(angle);
  const T s = phi.sin, c = phi.cos;
  const LiftTerms<T> t = lift_terms(h, phi);
  const T J2 = T(2) * h.rho * c;
  const T bend1 = s * (T(3) * h.rho * c - t.q);  // d(bend)/dphi
  const T P2 = h.rho * (T(2) * h.cos_slope * t.bend + h.sin_slope * bend1);
  const T bend2 = c * (T(3) * h.rho * c - t.q) - T(4) * h.rho * s * s;
  const T P3 = h.rho * (T(2) * h.cos_slope * bend1 + h.sin_slope * bend2);
  const T K2 = -c * t.J - s * t.J1, K3 = s * t.J - T(3) * c * t.J1;
  const T steep = T(2) * h.rho * sin_from_vertical(h, phi), high = T(2) * h.rho * cos_from_vertical(h, phi);
  const T E = roll.level + T(2) * angle * h.sin_slope + high, E1 = T(2) * h.sin_slope - steep;
  const Sample<T> G = lift(h, t, E, E1);
  return {G.value, G.rate,
          P2 * t.J + T(2) * t.P1 * t.J1 + t.P * J2 + h.rho * (K2 * E + T(2) * t.K1 * E1 - t.K * high),
          P3 * t.J + T(3) * (P2 * t.J1 + t.P1 * J2) - t.P * t.J1 +
              h.rho * (K3 * E + T(3) * (K2 * E1 - t.K1 * high) + t.K * steep)};
}

/// Bounds of |G''| and |G'''| over all angles of one revolution.
template <class T>
struct LiftBounds {
  T second, third;
};

/// For revolution `turn`, [2 pi turn, 2 pi (turn + 1)]. G is expanded there as harmonics 1 to 3 with E's
/// linear part held at its middle, and the rest, 2 rho sin(theta) (phi - middle) K, is bounded by itself;
/// each harmonic's amplitude is at most larger + (sqrt 2 - 1) smaller of its two coefficients.
template <class T>
LiftBounds<T> lift_bounds(const Roll<T>& roll, const T& turn) {
  using std::abs;
  const Hoop<T>& h = roll.hoop;
  const T pi(std::numbers::pi_v<ScalarOf<T>>);
  const T rho = h.rho, half(0.5);
  const T j0 = h.J_min + T(2) * rho, j1 = T(-2) * rho;
  const T p0 = h.Ic + T(1) + half * rho * rho, p1 = T(-2) * rho, p2 = half * rho * rho;
  const T middle = roll.level + T(4) * pi * h.sin_slope * (turn + half);
  const T k0 = T(-1.5) * rho, k1 = h.J_min + T(2) * rho, k2 = -half * rho;
  const T e = T(2) * rho * h.cos_slope, f = T(-2) * rho * h.sin_slope;  // of cos phi and sin phi in E
  const T cos1 =
      h.cos_slope * (p0 * j1 + p1 * j0 + half * p2 * j1) + rho * (e * (k0 + half * k2) + k1 * middle);
  const T cos2 = h.cos_slope * (half * p1 * j1 + p2 * j0) + rho * (half * e * k1 + k2 * middle);
  const T cos3 = half * (h.cos_slope * p2 * j1 + rho * e * k2);
  const T pull = rho * h.sin_slope;
  const T sin1 = pull * (j0 - T(0.25) * rho * j1) + rho * f * (k0 - half * k2);
  const T sin2 = half * (pull * (j1 - rho * j0) + rho * f * k1);
  const T sin3 = pull * T(-0.25) * rho * j1 + half * rho * f * k2;
  const auto amplitude = [](const T& a, const T& b) {
    return larger(abs(a), abs(b)) + T(0.4143) * smaller(abs(a), abs(b));
  };
  const T a1 = amplitude(cos1, sin1), a2 = amplitude(cos2, sin2), a3 = amplitude(cos3, sin3);
  const T rest = T(2) * rho * h.sin_slope;
  return {a1 + T(4) * a2 + T(9) * a3 + rest * (T(2) * (k1 + rho) + pi * (k1 + T(2) * rho)),
          a1 + T(8) * a2 + T(27) * a3 + rest * (T(3) * (k1 + T(2) * rho) + pi * (k1 + T(4) * rho))};
}

}  // namespace leapmap
