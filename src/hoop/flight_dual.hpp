// SPDX-License-Identifier: GPL-3.0-or-later
/// A flight whose apex and landing were found in plain numbers, with its derivatives.
#pragma once

#include "hoop/flight_search.hpp"
#include "numerics/dual.hpp"

namespace leapmap {

template <class D>
struct FlightDual {
  D height, apex_time, flight_time;  ///< as in Flight
};

/// From a lift-off with any spin and normal velocity v_n. The height depends on the time of the apex to
/// second order only.
template <class T, std::size_t N>
FlightDual<Dual<T, N>> with_derivatives(const Hoop<Dual<T, N>>& hoop, const Trig<Dual<T, N>>& phi,
                                        const Dual<T, N>& spin, const Dual<T, N>& normal_velocity,
                                        const T& apex_time, const T& flight_time) {
  using D = Dual<T, N>;
  const HeightAbovePlane<D> top = height_above_plane(hoop, phi, spin, D(apex_time), normal_velocity),
                            end = height_above_plane(hoop, phi, spin, D(flight_time), normal_velocity);
  return {D(0.5) * top.value, with_derivatives(apex_time, top.rate, top.acceleration.value),
          with_derivatives(flight_time, end.value, end.rate.value)};
}

/// How long after the lift-off a flight without rebound, of a spin above zero, is deepest below the plane
/// before it clears it; zero: nowhere. toss: it, apex: in turned angle.
template <class T>
T lowest_before(const Toss<T>& toss, const T& apex) {
  using S = ScalarOf<T>;
  const T two_pi(S(2) * pi_of<S>);
  T top = toss.top, lowest(0), at(0);
  MaskOf<T> sinks = toss.top > T(2) * (T(pi_of<S>) - toss.opening);  // after later tops it does at any rate
  for (; any(top < apex); top = top + two_pi, sinks = top == top) {
    const MaskOf<T> before = sinks & (top < apex);
    if (!any(before)) continue;
    const T bottom = toss_detail::bottom(toss, top, before), y = toss_height(toss, bottom).value;
    const MaskOf<T> lower = before & (y < lowest);
    lowest = select(lower, y, lowest), at = select(lower, bottom, at);
  }
  return at;
}

/// The same in time of any flight from a lift-off, driven or not; a rebound that no motor turns has no dip.
template <class T>
T lowest_time(const Hoop<T>& hoop, const T& angle, const T& spin, const T& normal_velocity,
              const T& apex_time) {
  using std::abs;
  const MaskOf<T> driven = hoop.aloft != T(0);
  T lowest(0);
  if (!all(driven)) {
    const T forwards = select(spin < T(0), -angle, angle), speed = abs(spin);
    lowest = lowest_before(toss_of(hoop, forwards, trig(forwards), speed), T(apex_time * speed)) / speed;
  }
  if (!any(driven)) return lowest;
  return select(driven, fly_driven(hoop, angle, spin, normal_velocity, driven).lowest_at, lowest);
}

}  // namespace leapmap
