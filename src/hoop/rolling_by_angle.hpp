// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip as functions of the angle alone: energy is conserved, so the spin is explicit.
///
/// With the vis viva E(phi) = w^2 J(phi), twice the kinetic energy, the normal force (11) is
///   N = (P J + rho K E) / J^2,   P = cos(theta) (Ic + q^2) + rho s (sin(theta) q + tau),
///   K = J_min c - rho v^2,
/// in s = sin phi, c = cos phi, v = 1 - c, q = 1 - rho c. The numerator G = P J + rho K E has the sign of N
/// and no needle where J is small: a trigonometric polynomial of degree 3 plus phi times one of degree 2. It
/// is linear in E, which gains 4 pi (sin(theta) + tau) a revolution: G of all revolutions follows from one
/// evaluation.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "hoop/parameters.hpp"
#include "hoop/rolling.hpp"
#include "numerics/root.hpp"

namespace leapmap {

/// A hoop on its way from one release, or from where it turned round. The angle grows on the way: a hoop that
/// rolls uphill is seen from behind the plane (parameters.hpp).
template <class T>
struct Roll {
  Hoop<T> hoop;
  T release;             ///< phi0 [rad]
  Trig<T> release_trig;  ///< of it
  T released;            ///< E at release, w0^2 J(phi0)
  T level;               ///< E(phi) - 2 phi thrust - 2 rho cos(theta + phi), the same at every angle
  T push;                ///< dE/dphi / 2 at release
};

/// dE/dphi / 2, the torque about the contact: sin(theta) + tau - rho sin(theta + phi).
template <class T>
T torque(const Hoop<T>& hoop, const Trig<T>& phi) {
  return hoop.thrust - hoop.rho * sin_from_vertical(hoop, phi);
}

/// Whether a hoop that has come to rest against a resisting torque stays there: slope and motor push less
/// than it.
template <class T>
bool is_held(const Hoop<T>& hoop, const Trig<T>& phi) {
  using std::abs;
  return abs(torque(hoop, phi) + hoop.resistance) <= abs(hoop.resistance);
}

/// Which way a hoop sets out: above zero downhill, below zero uphill, by its spin or, at rest, by its torque;
/// zero: it rests in an equilibrium. A spin whose square is lost counts as none. A design's numbers are
/// doubles, whatever T is: torque and spin within their rounding count as none too, or it would be the
/// rounding of pi that sets a hoop going. phi: trig(angle).
template <class T>
T setting_out(const Hoop<T>& hoop, const T& angle, const Trig<T>& phi, const T& spin) {
  using std::abs;
  const T rounding = T(ScalarOf<T>(4.0 * std::numeric_limits<double>::epsilon())) * (T(1) + abs(angle));
  const T push = torque(hoop, phi), of_terms = abs(hoop.sin_slope) + abs(hoop.drive) + hoop.rho;
  const MaskOf<T> rests = (abs(push) <= rounding * of_terms) & (abs(spin) <= rounding);
  return select(rests, T(0), select(spin * spin == T(0), push, spin));
}

/// phi: trig(release).
template <class T>
Roll<T> begin_roll(const Hoop<T>& hoop, const T& release, const Trig<T>& phi, const T& spin) {
  const T released = spin * spin * contact_inertia(hoop, phi);
  return {.hoop = hoop,
          .release = release,
          .release_trig = phi,
          .released = released,
          .level = released - T(2) * (release * hoop.thrust + hoop.rho * cos_from_vertical(hoop, phi)),
          .push = torque(hoop, phi)};
}
template <class T>
Roll<T> begin_roll(const Hoop<T>& hoop, const T& release, const T& spin) {
  return begin_roll(hoop, release, trig(release), spin);
}

/// The same roll without derivatives.
template <class T, std::size_t N>
Roll<T> plain(const Roll<Dual<T, N>>& roll) {
  const Trig<Dual<T, N>>& phi = roll.release_trig;
  return {.hoop = mapped<T>(roll.hoop, [](const Dual<T, N>& number) { return number.value; }),
          .release = roll.release.value,
          .release_trig = {phi.sin.value, phi.cos.value, phi.versine.value},
          .released = roll.released.value,
          .level = roll.level.value,
          .push = roll.push.value};
}
template <class T>
const Roll<T>& plain(const Roll<T>& roll) {
  return roll;
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
  return roll.level + T(2) * (angle * roll.hoop.thrust + roll.hoop.rho * cos_from_vertical(roll.hoop, phi));
}

/// sqrt(J / E) = dt / dphi.
template <class T>
T slowness(const T& inertia, const T& vis_viva) {
  if constexpr (has_derivatives<T>) {  // for less than its parts' derivatives cost
    auto slow = T(slowness(inertia.value, vis_viva.value));
    const auto half = slow.value * ScalarOf<T>(0.5), by_J = half / inertia.value,
               by_E = -half / vis_viva.value;
    for (std::size_t k = 0; k < slow.by.size(); ++k)
      slow.by[k] = by_J * inertia.by[k] + by_E * vis_viva.by[k];
    return slow;
  } else {
    return inertia * reciprocal_sqrt(inertia * vis_viva);
  }
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
  return vis_viva_past_release(roll, x, turned, x_minus_sin(x, turned));
}

/// The same, and J, for many angles x of one roll: by x's sine and versine, with factors that do not depend
/// on x. Of J near a needle at phi = 0 it is the rounding of rho, not of J, that remains.
template <class T>
struct PastRelease {
  T released, push2, by_sine, by_versine;  ///< of E
  T J_min, by_turned, J_cos, J_sin;        ///< of J

  /// sqrt(J / E). X: T, or a number that all lanes share.
  template <class X>
  T slowness_at(const X& x, const Trig<X>& turned, const X& x_less_sin) const {
    return slowness(inertia(turned), vis_viva(x, turned, x_less_sin));
  }
  template <class X>
  T vis_viva(const X& x, const Trig<X>& turned, const X& x_less_sin) const {
    return released + push2 * x + by_sine * x_less_sin + by_versine * turned.versine;
  }
  template <class X>
  T inertia(const Trig<X>& turned) const {
    return J_min + by_turned * turned.versine + J_cos * turned.cos + J_sin * turned.sin;
  }
};

template <class T>
PastRelease<T> past_release(const Roll<T>& roll) {
  const Trig<T>& phi = roll.release_trig;
  const T rho2 = T(2) * roll.hoop.rho;
  return {.released = roll.released,
          .push2 = T(2) * roll.push,
          .by_sine = rho2 * sin_from_vertical(roll.hoop, phi),
          .by_versine = -rho2 * cos_from_vertical(roll.hoop, phi),
          .J_min = roll.hoop.J_min,
          .by_turned = rho2,
          .J_cos = rho2 * phi.versine,
          .J_sin = rho2 * phi.sin};
}

/// Where E is least for the first time after the release, or, where E falls from turn to turn, least for the
/// first time below zero. E has minima only if rho > |thrust|, where theta + phi = pi - asin(thrust / rho);
/// from one revolution to the next they change by 4 pi thrust, so that this one tells whether the hoop turns
/// round. Otherwise E rises or falls always: it rises least where theta + phi = pi / 2, and is below zero at
/// the latest where `angle` says then.
template <class T>
struct FirstMinimum {
  T angle;
  T summit;           ///< E falls all the way from here to there; before the release: from that
  MaskOf<T> is_real;  ///< E has minima, or falls
};
/// slope: theta.
template <class T>
FirstMinimum<T> first_minimum(const Roll<T>& roll, const T& slope) {
  using std::asin, std::floor;
  const T pi(std::numbers::pi_v<ScalarOf<T>>), two_pi = T(2) * pi;
  const T &thrust = roll.hoop.thrust, &rho = roll.hoop.rho;
  const MaskOf<T> waves = (rho > thrust) & (rho > -thrust), falls = thrust < T(0);
  const T crest = asin(select(waves, thrust / rho, T(1)));
  const T phase = pi - crest - slope;
  FirstMinimum<T> first{phase + two_pi * (floor((roll.release - phase) / two_pi) + T(1)), T(0), waves};
  if (any(falls)) {
    const T lost = T(-2) * two_pi * thrust, least = vis_viva_past_release(roll, first.angle - roll.release);
    const T turns = select(falls & (least > T(0)), smaller(floor(least / lost) + T(1), T(1e9)), T(0));
    first.angle = first.angle + two_pi * turns;
    // E is at most released + 2 thrust x + 4 rho.
    const T latest = roll.release - (roll.released + T(4) * rho) / (T(2) * thrust) * T(1.01);
    first.angle = select(falls & !waves, latest, first.angle);
    first.is_real = waves | falls;
  }
  first.summit = select(waves, first.angle - pi + T(2) * crest, T(-1e300));
  return first;
}

/// The last digits of the angle past the release where E falls through zero, however small it is: near the
/// release E is known better than the angle. x: it, to roundings of angles; it lies between from and to.
template <class T>
T refined_turn(const Roll<T>& roll, T x, const T& from, const T& to) {
  using std::abs;
  for (int k = 0; k < 3; ++k) {
    const T E = vis_viva_past_release(roll, x), rate = T(2) * torque(roll.hoop, trig(roll.release + x));
    const T next = larger(from, smaller(x - E / rate, to));
    x = select((rate < T(0)) & (abs(next - x) <= T(ScalarOf<T>(1e-12L)) * larger(T(1), to)), next, x);
  }
  return x;
}

/// How far from the start of a roll the hoop turns round, `about` there: to the last digits however near that
/// is, as angles are not. S: a number, or a dual.
template <class S>
S length_to_rest(const Roll<S>& roll, ValueOf<S> about) {
  using Number = ValueOf<S>;
  const auto E_at = [&](const Number& x) { return vis_viva_past_release(roll, S(x)); };
  const auto rate_at = [&](const Number& x) {
    return 2 * value_of(torque(roll.hoop, trig(S(value_of(roll.release) + x))));
  };
  Number length = about;
  for (int k = 0; k < 3; ++k) {
    const Number next = length - value_of(E_at(length)) / rate_at(length);
    if (std::abs(next - about) <= 1e-12 * (1 + std::abs(value_of(roll.release))) && next > 0) length = next;
  }
  if constexpr (has_derivatives<S>)
    return with_derivatives(length, E_at(length), rate_at(length));
  else
    return length;
}

/// How far from the release a hoop turns round, whose first minimum is real and E there not above zero:
/// between E's summit, or the release if that is later, and there. Good to the last digits however small it
/// is. Lanes outside `wanted` return anything.
template <class T>
T turning_distance(const Roll<T>& roll, const FirstMinimum<T>& first, const MaskOf<T>& wanted) {
  const auto vis_viva_at = [&](const T& x) {
    return Sample<T>{vis_viva_past_release(roll, x), T(2) * torque(roll.hoop, trig(roll.release + x))};
  };
  const T from = larger(first.summit - roll.release, T(0)), to = first.angle - roll.release;
  const T resolution = T(ScalarOf<T>(4) * std::numeric_limits<ScalarOf<T>>::epsilon()) * larger(T(1), to);
  const T x = polish_root(vis_viva_at, from, to, T(0.5) * (from + to), wanted & !wanted, resolution, wanted);
  return refined_turn(roll, x, from, to);
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
  const T J = contact_inertia(h, phi), q = height_of_mass(h, phi);
  const T bend = h.rho * s * s + c * q;
  return {.q = q,
          .J = J,
          .J1 = T(2) * h.rho * s,
          .P = h.cos_slope * (h.Ic + q * q) + h.rho * s * (h.sin_slope * q + h.drive),
          .P1 = h.rho * (T(2) * h.cos_slope * s * q + h.sin_slope * bend + h.drive * c),
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
  const T P2 = h.rho * (T(2) * h.cos_slope * t.bend + h.sin_slope * bend1 - h.drive * s);
  const T bend2 = c * (T(3) * h.rho * c - t.q) - T(4) * h.rho * s * s;
  const T P3 = h.rho * (T(2) * h.cos_slope * bend1 + h.sin_slope * bend2 - h.drive * c);
  const T K2 = -c * t.J - s * t.J1, K3 = s * t.J - T(3) * c * t.J1;
  const T steep = T(2) * h.rho * sin_from_vertical(h, phi), high = T(2) * h.rho * cos_from_vertical(h, phi);
  const T E = roll.level + T(2) * angle * h.thrust + high, E1 = T(2) * h.thrust - steep;
  const Sample<T> G = lift(h, t, E, E1);
  return {G.value, G.rate,
          P2 * t.J + T(2) * t.P1 * t.J1 + t.P * J2 + h.rho * (K2 * E + T(2) * t.K1 * E1 - t.K * high),
          P3 * t.J + T(3) * (P2 * t.J1 + t.P1 * J2) - t.P * t.J1 +
              h.rho * (K3 * E + T(3) * (K2 * E1 - t.K1 * high) + t.K * steep)};
}

/// G as harmonics 0 to 3, and rho K likewise, whose share of E grows with the angle:
///   G = sum of cosine[m] cos(m phi) + sine[m] sin(m phi) + rho K (level + 2 phi thrust).
/// Near phi = 0 of a nearly massless hoop with the mass on its rim the terms cancel to their roundings; G of
/// lift() does not.
template <class T>
struct LiftHarmonics {
  std::array<T, 4> cosine, sine;  ///< sine[0] is zero
  std::array<T, 3> swing;         ///< of rho K, in cosines
};

template <class T>
LiftHarmonics<T> lift_harmonics(const Hoop<T>& h) {
  const T rho = h.rho, half(0.5);
  const T j0 = h.J_min + T(2) * rho, j1 = T(-2) * rho;
  const T p0 = h.Ic + T(1) + half * rho * rho, p1 = T(-2) * rho, p2 = half * rho * rho;
  const T k0 = T(-1.5) * rho, k1 = h.J_min + T(2) * rho, k2 = -half * rho;
  const T e = T(2) * rho * h.cos_slope, f = T(-2) * rho * h.sin_slope;  // of cos phi and sin phi in E
  const T pull = rho * h.sin_slope, drive = rho * h.drive;
  return {.cosine = {h.cos_slope * (p0 * j0 + half * p1 * j1) + half * rho * e * k1,
                     h.cos_slope * (p0 * j1 + p1 * j0 + half * p2 * j1) + rho * e * (k0 + half * k2),
                     h.cos_slope * (half * p1 * j1 + p2 * j0) + half * rho * e * k1,
                     half * (h.cos_slope * p2 * j1 + rho * e * k2)},
          .sine = {T(0), pull * (j0 - T(0.25) * rho * j1) + drive * j0 + rho * f * (k0 - half * k2),
                   half * (pull * (j1 - rho * j0) + drive * j1 + rho * f * k1),
                   pull * T(-0.25) * rho * j1 + half * rho * f * k2},
          .swing = {rho * k0, rho * k1, rho * k2}};
}

/// Bounds of |G''|, |G'''| and |G''''| over all angles of one revolution; the last also for a twelfth of a
/// revolution before and after it.
template <class T>
struct LiftBounds {
  T second, third, fourth;
};

/// For revolution `turn`, [2 pi turn, 2 pi (turn + 1)]. G's harmonics are taken there with E's linear part
/// held at its middle, and the rest, 2 rho thrust (phi - middle) K, is bounded by itself; each harmonic's
/// amplitude is at most larger + (sqrt 2 - 1) smaller of its two coefficients.
template <class T>
LiftBounds<T> lift_bounds(const Roll<T>& roll, const LiftHarmonics<T>& harmonics, const T& turn) {
  using std::abs;
  const Hoop<T>& h = roll.hoop;
  const T pi(std::numbers::pi_v<ScalarOf<T>>), rho = h.rho, k1 = h.J_min + T(2) * rho;
  const T middle = roll.level + T(4) * pi * h.thrust * (turn + T(0.5));
  const auto amplitude = [&](std::size_t m) {
    const T a = abs(m < 3 ? harmonics.cosine[m] + harmonics.swing[m] * middle : harmonics.cosine[m]),
            b = abs(harmonics.sine[m]);
    return larger(a, b) + T(0.4143) * smaller(a, b);
  };
  const T a1 = amplitude(1), a2 = amplitude(2), a3 = amplitude(3);
  const T rest = T(2) * rho * abs(h.thrust), farthest = pi * T(ScalarOf<T>(7) / ScalarOf<T>(6));
  return {a1 + T(4) * a2 + T(9) * a3 + rest * (T(2) * (k1 + rho) + pi * (k1 + T(2) * rho)),
          a1 + T(8) * a2 + T(27) * a3 + rest * (T(3) * (k1 + T(2) * rho) + pi * (k1 + T(4) * rho)),
          a1 + T(16) * a2 + T(81) * a3 + rest * (T(4) * (k1 + T(4) * rho) + farthest * (k1 + T(8) * rho))};
}

}  // namespace leapmap
