// SPDX-License-Identifier: GPL-3.0-or-later
/// What a jump comes to besides its height and times: how far it flies, and how hard it lands. One more is a
/// member, its row and its formula here, and the row of its field.
#pragma once

#include <array>

#include "hoop/contact_state.hpp"
#include "hoop/landing.hpp"
#include "leapmap/outcome.hpp"

namespace leapmap {

/// Along the plane positive downhill.
template <class T>
struct JumpMeasures {
  T range;             ///< travel of the centre from lift-off to landing [R]
  T normal_speed;      ///< of the contact point just before the landing, towards the plane [sqrt(g R)]
  T tangential_speed;  ///< the same along the plane
  T impulse;           ///< of the plane in the whole landing, normal [(m + m_p) sqrt(g R)]
  T energy_lost;       ///< in the landing [(m + m_p) g R]
};

/// Where outcomes keep a measure.
template <class T>
struct MeasureRow {
  T JumpMeasures<T>::*number;
  double Outcome::*kept;
  bool has_direction;  ///< changes its sign if seen from behind
};
template <class T>
inline constexpr std::array measure_rows{
    MeasureRow<T>{&JumpMeasures<T>::range, &Outcome::jump_range, true},
    MeasureRow<T>{&JumpMeasures<T>::normal_speed, &Outcome::landing_normal_speed, false},
    MeasureRow<T>{&JumpMeasures<T>::tangential_speed, &Outcome::landing_tangential_speed, true},
    MeasureRow<T>{&JumpMeasures<T>::impulse, &Outcome::landing_impulse, false},
    MeasureRow<T>{&JumpMeasures<T>::energy_lost, &Outcome::landing_energy_lost, false}};

/// Whether a number of an outcome is a measure of its jump.
constexpr bool is_measure(const OutcomeNumber& number) {
  for (const MeasureRow<double>& row : measure_rows<double>)
    if (number == row.kept) return true;
  return false;
}

/// Kinetic energy over (m + m_p) g R: (3) with the constraint (1) released.
template <class T>
T kinetic_energy(const Hoop<T>& hoop, const Trig<T>& phi, const ContactVelocity<T>& at) {
  const T along = at.slip + height_of_mass(hoop, phi) * at.spin,
          across = at.normal + hoop.rho * phi.sin * at.spin;
  return T(0.5) * (along * along + across * across + hoop.Ic * at.spin * at.spin);
}

/// before: the end of the flight, just before the landing.
template <class T>
JumpMeasures<T> measures_of(const Hoop<T>& hoop, const T& range, const ContactState<T>& before,
                            const Landing<T>& landing) {
  const Trig<T> phi = trig(before.angle);
  const ContactVelocity<T> velocity{before.slip, before.normal, before.spin};
  return {range, -before.normal, before.slip, landing.impulse.normal,
          kinetic_energy(hoop, phi, velocity) - kinetic_energy(hoop, phi, landing.after)};
}

/// Of a flight without slip from a lift-off, after which the contact holds at once.
template <class T>
JumpMeasures<T> measures_of(const Hoop<T>& hoop, const T& angle, const T& spin, const T& flight_time) {
  const ContactState<T> before =
      after_flight(hoop, ContactState<T>{.angle = angle, .spin = spin}, flight_time);
  return measures_of(hoop, before.travel, before,
                     hold(hoop, trig(before.angle), {before.slip, before.normal, before.spin}));
}

/// put(member of Outcome, measure) of each. way: -1 if the measures are seen from behind, else 1.
template <class T, class Put>
void put_measures(const JumpMeasures<T>& measures, const T& way, const Put& put) {
  for (const MeasureRow<T>& row : measure_rows<T>)
    put(row.kept, row.has_direction ? T(way * (measures.*row.number)) : measures.*row.number);
}

template <class S>
void keep_measures(const JumpMeasures<S>& measures, Outcome& outcome) {
  put_measures(measures, S(1),
               [&](double Outcome::*kept, const S& value) { outcome.*kept = static_cast<double>(value); });
}

}  // namespace leapmap
