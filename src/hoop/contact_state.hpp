// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the hoop is, and how it moves, in contact with the plane or leaving it.
#pragma once

#include <cmath>
#include <numbers>

#include "hoop/flight.hpp"
#include "hoop/rolling.hpp"

namespace leapmap {

template <class S>
struct ContactState {
  S time = S(0);    ///< since release [sqrt(R/g)]
  S travel = S(0);  ///< x, of the hoop's centre since release [R]
  S angle = S(0), spin = S(0);
  S slip = S(0);              ///< v = x' - w
  S normal = S(0);            ///< v_n with which a flight begins: of a rebound above zero
  S turned_in_flight = S(0);  ///< with an idle motor, since release or since it was reduced [rad]
};

/// A state in contact a little later, to first order; angular: phi'', slip: v'.
template <class S>
ContactState<S> a_little_later(ContactState<S> at, const S& angular, const S& slip, const S& by) {
  at.time += by, at.travel += (at.slip + at.spin) * by, at.angle += at.spin * by;
  at.spin += angular * by, at.slip += slip * by;
  return at;
}

/// A state without whole turns, time and travel, on which nothing depends that comes after it.
template <class S>
ContactState<S> reduced(const ContactState<S>& at) {
  using std::fma, std::nearbyint;
  constexpr S turn = S(2) * std::numbers::pi_v<S>;
  // As std::remainder, but for angles within a rounding of half a turn, and in less time.
  return {.angle = fma(-nearbyint(at.angle / turn), turn, at.angle),
          .spin = at.spin,
          .slip = at.slip,
          .normal = at.normal};
}

template <class S>
ContactState<double> in_double(const ContactState<S>& at) {
  return {static_cast<double>(at.time),
          static_cast<double>(at.travel),
          static_cast<double>(at.angle),
          static_cast<double>(at.spin),
          static_cast<double>(at.slip),
          static_cast<double>(at.normal),
          static_cast<double>(at.turned_in_flight)};
}

/// Mechanical energy over (m + m_p) g R, but for a constant: (3) and (4) with the constraint (1) released;
/// normal: v_n.
template <class S>
S contact_energy(const Hoop<S>& hoop, const ContactState<S>& at) {
  const Trig<S> phi = trig(at.angle);
  const S along = at.slip + height_of_mass(hoop, phi) * at.spin;
  const S across = at.normal + hoop.rho * phi.sin * at.spin;
  return S(0.5) * (along * along + across * across + hoop.Ic * at.spin * at.spin) -
         at.travel * hoop.sin_slope - hoop.rho * cos_from_vertical(hoop, phi);
}

/// The end of a flight just before it touches the plane; normal: v_n there, below zero.
template <class S>
ContactState<S> after_flight(const Hoop<S>& hoop, const ContactState<S>& at, const S& flight_time) {
  const Trig<S> phi = trig(at.angle);
  const Sample<S> travel = travel_in_flight(hoop, phi, at.spin, at.slip, flight_time);
  const Turned<S> turned = turned_in_flight(hoop, at.spin, flight_time);
  return {at.time + flight_time,
          at.travel + travel.value,
          at.angle + turned.value,
          turned.rate,
          travel.rate - turned.rate,
          height_above_plane(hoop, phi, at.spin, flight_time, at.normal).rate,
          at.turned_in_flight + select(hoop.aloft == S(0), turned.value, S(0))};
}

}  // namespace leapmap
