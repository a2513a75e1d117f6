// SPDX-License-Identifier: GPL-3.0-or-later
/// Landing: one contact point, Coulomb friction and Poisson's restitution along Routh's path of impulses.
#pragma once

#include <algorithm>
#include <cmath>

#include "hoop/rolling.hpp"

namespace leapmap {

/// The spin after a landing that holds at once and does not rebound: the angular momentum about the contact
/// is kept. travel: x', climb: y' of the hoop's centre before it, with spin w.
template <class T>
T spin_after_holding(const Hoop<T>& hoop, const Trig<T>& phi, const T& travel, const T& climb,
                     const T& spin) {
  const T along = travel - hoop.rho * phi.cos * spin, across = climb + hoop.rho * phi.sin * spin;
  return (hoop.Ic * spin + height_of_mass(hoop, phi) * along + hoop.rho * phi.sin * across) /
         contact_inertia(hoop, phi);
}

/// Velocities at the contact, and the spin.
template <class S>
struct ContactVelocity {
  S slip;    ///< v along the plane, positive downhill
  S normal;  ///< away from the plane
  S spin;
};

/// Impulses over (m + m_p) sqrt(g R).
template <class S>
struct LandingImpulse {
  S friction, normal;
};

/// What a landing leaves, and the impulses that made it.
template <class S>
struct Landing {
  ContactVelocity<S> after;
  LandingImpulse<S> impulse;
  bool sticks;  ///< slip is zero, held by friction
};

/// A landing that holds at once, as without slip: the impulse stops the contact point in both directions.
template <class T>
Landing<T> hold(const Hoop<T>& hoop, const Trig<T>& phi, const ContactVelocity<T>& before) {
  const T spin = spin_after_holding(hoop, phi, before.slip + before.spin, before.normal, before.spin);
  const T gained = spin - before.spin;
  // What the centre of mass gains along the plane and away from it.
  return {{T(0), T(0), spin},
          {height_of_mass(hoop, phi) * gained - before.slip, hoop.rho * phi.sin * gained - before.normal},
          true};
}

/// The contact velocities answer impulses by W: slip += Wtt Pt + Wtn Pn, normal += Wtn Pt + Wnn Pn. The
/// impulses go Routh's path: while the normal impulse grows, friction opposes slip with mu times it, until
/// slip is used up; then it holds the contact if |Wtn / Wtt| <= mu, else slip goes on towards sign(Wtn).
/// Compression ends where the normal velocity is zero; restitution adds its share of the normal impulse until
/// there. It always ends: where sliding alone would not end compression, it ends itself. Of a rebound slower
/// than rest_speed the normal velocity counts as none.
template <class S>
Landing<S> land(const Hoop<S>& hoop, const Trig<S>& phi, const ContactVelocity<S>& before, const S& mu,
                const S& restitution, const S& rest_speed) {
  using std::abs;
  const S arm = height_of_mass(hoop, phi), lever = hoop.rho * phi.sin;
  const S Wtt = S(1) + arm * arm / hoop.Ic, Wtn = arm * lever / hoop.Ic, Wnn = S(1) + lever * lever / hoop.Ic;
  const auto sign = [](const S& x) { return x > S(0) ? S(1) : S(-1); };

  // The path in pieces: on each, friction's share of the normal impulse is constant.
  struct Point {
    S slip, normal, friction_impulse, normal_impulse;
    bool sticks;
  };
  const bool holds = abs(Wtn) <= mu * Wtt;
  const auto share_at = [&](const Point& at) {
    if (at.sticks) return -Wtn / Wtt;
    return -mu * sign(at.slip != S(0) ? at.slip : Wtn);
  };
  const auto advance = [&](Point& at, S to_impulse, bool to_compression) {
    for (int piece = 0; piece < 3; ++piece) {
      const S share = share_at(at), slip_rate = Wtt * share + Wtn, normal_rate = Wtn * share + Wnn;
      S length = to_compression ? (normal_rate > S(0) ? -at.normal / normal_rate : S(HUGE_VAL))
                                : to_impulse - at.normal_impulse;
      const S to_stick = at.sticks || at.slip * slip_rate >= S(0) ? S(HUGE_VAL) : -at.slip / slip_rate;
      const bool stops = to_stick <= length;
      length = stops ? to_stick : length;
      at.normal_impulse += length, at.friction_impulse += share * length;
      at.normal += normal_rate * length;
      at.slip = stops ? S(0) : at.slip + slip_rate * length;
      if (!stops) return;
      at.sticks = holds;
    }
  };
  Point at{before.slip, before.normal, S(0), S(0), before.slip == S(0) && holds};
  advance(at, S(0), true);
  at.normal = S(0);
  advance(at, (S(1) + restitution) * at.normal_impulse, false);
  if (!(at.normal >= rest_speed)) at.normal = S(0);
  const S spin = before.spin - (arm * at.friction_impulse + lever * at.normal_impulse) / hoop.Ic;
  return {{at.sticks ? S(0) : at.slip, at.normal, spin}, {at.friction_impulse, at.normal_impulse}, at.sticks};
}

}  // namespace leapmap
