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

/// How the contact's velocities answer impulses: slip += tt Pt + tn Pn, normal += tn Pt + nn Pn.
template <class S>
struct ContactResponse {
  S tt, tn, nn;
};

/// Where Routh's path ends.
template <class S>
struct RouthEnd {
  S slip, normal;  ///< velocities of the contact
  LandingImpulse<S> impulse;
  bool sticks;
};

/// Impulses go Routh's path: while the normal impulse grows, friction opposes slip with mu times it, until
/// slip is used up; then it holds the contact if |tn / tt| <= mu, else slip goes on towards sign(tn).
/// Compression ends where the normal velocity is zero; restitution adds its share of the normal impulse until
/// there. It always ends: where sliding alone would not end compression, it ends itself. Of a rebound slower
/// than rest_speed the normal velocity counts as none.
template <class S>
RouthEnd<S> routh_path(const ContactResponse<S>& W, const S& slip, const S& normal, const S& mu,
                       const S& restitution, const S& rest_speed) {
  using std::abs;
  const auto sign = [](const S& x) { return x > S(0) ? S(1) : S(-1); };
  // The path in pieces: on each, friction's share of the normal impulse is constant.
  const bool holds = abs(W.tn) <= mu * W.tt;
  RouthEnd<S> at{slip, normal, {S(0), S(0)}, slip == S(0) && holds};
  const auto advance = [&](S to_impulse, bool to_compression) {
    for (int piece = 0; piece < 3; ++piece) {
      const S share = at.sticks ? -W.tn / W.tt : -mu * sign(at.slip != S(0) ? at.slip : W.tn);
      const S slip_rate = W.tt * share + W.tn, normal_rate = W.tn * share + W.nn;
      S length = to_compression ? (normal_rate > S(0) ? -at.normal / normal_rate : S(HUGE_VAL))
                                : to_impulse - at.impulse.normal;
      const S to_stick = at.sticks || at.slip * slip_rate >= S(0) ? S(HUGE_VAL) : -at.slip / slip_rate;
      const bool stops = to_stick <= length;
      length = stops ? to_stick : length;
      at.impulse.normal += length, at.impulse.friction += share * length;
      at.normal += normal_rate * length;
      at.slip = stops ? S(0) : at.slip + slip_rate * length;
      if (!stops) return;
      at.sticks = holds;
    }
  };
  advance(S(0), true);
  at.normal = S(0);
  advance((S(1) + restitution) * at.impulse.normal, false);
  if (!(at.normal >= rest_speed)) at.normal = S(0);
  if (at.sticks) at.slip = S(0);
  return at;
}

/// A hoop's landing along that path.
template <class S>
Landing<S> land(const Hoop<S>& hoop, const Trig<S>& phi, const ContactVelocity<S>& before, const S& mu,
                const S& restitution, const S& rest_speed) {
  const S arm = height_of_mass(hoop, phi), lever = hoop.rho * phi.sin;
  const ContactResponse<S> W{S(1) + arm * arm / hoop.Ic, arm * lever / hoop.Ic,
                             S(1) + lever * lever / hoop.Ic};
  const RouthEnd<S> end = routh_path(W, before.slip, before.normal, mu, restitution, rest_speed);
  const S spin = before.spin - (arm * end.impulse.friction + lever * end.impulse.normal) / hoop.Ic;
  return {{end.slip, end.normal, spin}, end.impulse, end.sticks};
}

}  // namespace leapmap
