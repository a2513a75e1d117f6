// SPDX-License-Identifier: GPL-3.0-or-later
/// The edge of Painleve's region, where a slide's pivot Ic + rho s q falls to zero (hoop/sliding.hpp).
///
/// A slide that comes near the edge does one of three things (F. Genot and B. Brogliato, New results on
/// Painleve paradoxes, Eur. J. Mech. A/Solids 18 (1999) 653-677, for a rod; the equations are the same). With
/// x the angle left to the edge, n0 goes about as C x^k plus a multiple of x, k = -2 rho c q / pivot' at the
/// edge. For C < 0 the hoop lifts off before the edge. For C > 0 and k < 1 the normal force grows beyond all
/// bounds: indeterminate, unless slip or spin is used up before, as they are for k <= 0. For k > 1 it does
/// not: n0 and the pivot come to zero together, and there the hoop lifts off. All this for c < 0; else n0
/// cannot vanish, and the spin is used up before the edge.
#pragma once

#include <cmath>
#include <numbers>

#include "hoop/sliding.hpp"
#include "numerics/first_fall.hpp"

namespace leapmap {

/// pivot and its derivative by the angle.
template <class S>
Sample<S> pivot_by_angle(const Hoop<S>& hoop, const Trig<S>& phi, const S& friction) {
  const S s = phi.sin, c = phi.cos, rho = hoop.rho, m = friction;
  const S sine_2 = S(2) * s * c, cosine_2 = c * c - s * s;
  return {sliding_coefficients(hoop, phi, friction).pivot, rho * (rho * sine_2 - m * c + m * rho * cosine_2)};
}

/// k, above, at an edge.
template <class S>
S power_at_edge(const Hoop<S>& hoop, const Trig<S>& phi, const S& friction) {
  return S(-2) * hoop.rho * phi.cos * sliding_lever(hoop, phi, friction) /
         pivot_by_angle(hoop, phi, friction).rate;
}

/// Whether the pivot Ic + rho^2 s^2 - m rho s (1 - rho c) is above zero at every angle, as one of two bounds
/// tells at once: |s| (1 - rho c) is at most 1 + rho / 2, and x^2 - m x (1 - rho c) at least
/// -(m (1 + rho) / 2)^2.
template <class S>
bool keeps_off_painleve(const Hoop<S>& hoop, const S& friction) {
  const S m = std::abs(friction), half = m * (S(1) + hoop.rho) * S(0.5);
  return hoop.Ic > hoop.rho * m * (S(1) + hoop.rho * S(0.5)) || hoop.Ic > half * half;
}

/// The nearest edge ahead of a sliding hoop.
template <class S>
struct PainleveEdge {
  Trig<S> once, twice;  ///< of its angle and of twice that
  S way;                ///< 1: it lies at greater angles, -1: at lesser

  /// Ic + rho s q at `left` from the edge, without cancellation: differences of sines as products.
  template <class T>
  T pivot(const Hoop<T>& hoop, const T& friction, const T& left) const {
    const SinCos<T> whole = sincos_of(left), half = sincos_of(left * T(S(0.5)));
    const T turned(way);  // sines of the edge's angle change sign with the way
    const T sine_once = turned * T(once.sin), cosine_once(once.cos), sine_twice = turned * T(twice.sin),
            cosine_twice(twice.cos);
    const T rho = hoop.rho, m = turned * friction;
    const T cosine_between = cosine_once * half.cos + sine_once * half.sin;  // of the edge less left / 2
    const T sine_twice_between = sine_twice * whole.cos - cosine_twice * whole.sin;
    const T cosine_twice_between = cosine_twice * whole.cos + sine_twice * whole.sin;
    return rho * (T(S(2)) * m * cosine_between * half.sin -
                  rho * whole.sin * (sine_twice_between + m * cosine_twice_between));
  }
};

/// Angle from here to the nearest edge on the way, within a turn; NaN: there is none. The pivot here must be
/// above zero.
template <class S>
S left_to_edge(const Hoop<S>& hoop, const S& friction, const S& angle, const S& way) {
  constexpr int looks = 48;
  const S step = S(2) * std::numbers::pi_v<S> / S(looks);
  const auto pivot = [&](const S& x) {
    const Sample<S> at = pivot_by_angle(hoop, trig(S(angle + way * x)), friction);
    return Sample<S>{at.value, way * at.rate};
  };
  Sample<S> left = pivot(S(0));
  for (int k = 0; k < looks; ++k) {
    const S a = S(k) * step, b = a + step;
    const Sample<S> right = pivot(b);
    if (const S fall = first_fall(pivot, a, b, left, right); !std::isnan(fall)) return fall;
    left = right;
  }
  return std::numeric_limits<S>::quiet_NaN();
}

}  // namespace leapmap
