// SPDX-License-Identifier: GPL-3.0-or-later
/// Free flight (13) in closed form: the spin is constant and the centre of mass flies a parabola.
///
/// The hoop's lowest point is at height y(t) above the plane. Right after a lift-off from rolling y often
/// dips below zero, because friction is cut off while it still brakes the spin; the jump is the first
/// interval with y > 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/root.hpp"
#include "physics/parameters.hpp"
#include "physics/rolling.hpp"

namespace leapmap {

/// Where a flight begins: both contact constraints are dropped with the contact point at rest.
template <class T>
struct LiftOff {
  T time;   ///< since release [sqrt(R/g)]
  T angle;  ///< phi [rad]
  T spin;   ///< w [sqrt(g/R)]
};

/// One flight, seen from its lift-off. Times in sqrt(R/g), lengths in hoop diameters.
/// A flight that never clears the plane has height, apex_time and flight_time zero.
template <class T>
struct Flight {
  T height = T(0);       ///< apex of the first interval with y > 0
  T apex_time = T(0);    ///< from lift-off to the apex
  T flight_time = T(0);  ///< from lift-off to the end of that interval
  T dip = T(0);          ///< least y before that interval, <= 0
};

/// x - sin x without cancellation.
template <class T>
T x_minus_sin(const T& x) {
  using std::abs, std::sin;
  if (abs(x) > T(0.7)) return x - sin(x);
  T term = x * x * x / T(6), sum = term;
  for (int k = 4; abs(term) > std::numeric_limits<T>::epsilon() * T(0.25) * abs(sum); k += 2) {
    term *= -x * x / T(k * (k + 1));
    sum += term;
  }
  return sum;
}

/// y(t) and y'(t). With phi the angle and w the spin at lift-off:
///   y  = rho sin(phi) (w t - sin w t) - 2 rho cos(phi) sin^2(w t / 2) - cos(theta) t^2 / 2
///   y' = -2 rho w sin(w t / 2) cos(phi + w t / 2) - cos(theta) t
/// which equals physics.md's y term by term, with every difference of near equals carried out.
template <class T>
Sample<T> height_above_plane(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& t) {
  using std::cos, std::sin;
  const T turned = spin * t;
  const T sin_half = sin(turned * T(0.5)), cos_half = cos(turned * T(0.5));
  return {
      hoop.rho * (phi.sin * x_minus_sin(turned) - T(2) * phi.cos * sin_half * sin_half) -
          hoop.cos_slope * t * t * T(0.5),
      T(-2) * hoop.rho * spin * sin_half * (phi.cos * cos_half - phi.sin * sin_half) - hoop.cos_slope * t};
}

/// y''(t) = -rho w^2 cos(phi + w t) - cos(theta).
template <class T>
T lift_acceleration(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& t) {
  using std::cos, std::sin;
  return -hoop.rho * spin * spin * (phi.cos * cos(spin * t) - phi.sin * sin(spin * t)) - hoop.cos_slope;
}

/// How far the hoop's centre has travelled along the plane since lift-off: the centre of mass at x - rho
/// sin(phi) flies on with its speed at lift-off and falls with sin(theta).
template <class T>
T travel_in_flight(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& t) {
  const Trig<T> turned = trig(spin * t);
  const T sine_gained = phi.cos * turned.sin - phi.sin * turned.versine;  // sin(phi + w t) - sin(phi)
  return spin * (T(1) - hoop.rho * phi.cos) * t + hoop.sin_slope * t * t * T(0.5) + hoop.rho * sine_gained;
}

/// The whole flight that starts at lift_off.
///
/// No root can be missed: the zeros of y'' are known in closed form, between two of them y' is monotone, and
/// between two zeros of y' so is y. The lift-off itself (a double root of y, a triple one after sliding) is
/// the start of the walk and is never looked for.
template <class T>
Flight<T> fly(const Hoop<T>& hoop, const LiftOff<T>& lift_off) {
  using std::abs, std::acos, std::floor, std::sqrt;
  // y depends on phi and w only through cos(phi + w t) and sin(phi) w: turning backwards is the mirror image.
  const bool mirrored = lift_off.spin < T(0);
  const T angle = mirrored ? -lift_off.angle : lift_off.angle;
  const T spin = abs(lift_off.spin);
  const Trig<T> phi = trig(angle);
  const auto height_at = [&](const T& t) { return height_above_plane(hoop, phi, spin, t); };
  const auto climb_at = [&](const T& t) {
    return Sample<T>{height_at(t).rate, lift_acceleration(hoop, phi, spin, t)};
  };

  Flight<T> flight;
  const T threshold = hoop.cos_slope / (hoop.rho * spin * spin);  // y'' > 0 iff cos(phi + w t) < -threshold
  if (!(threshold < T(1))) return flight;                         // gravity always wins: y < 0 from the start

  const T pi = acos(T(-1));
  const T opening = acos(-threshold);  // y'' > 0 for phi + w t in (opening, 2 pi - opening), modulo 2 pi
  const T turn = angle - T(2) * pi * floor(angle / (T(2) * pi));
  // Beyond this y = rho (cos(phi + w t) - cos phi) + rho sin(phi) w t - cos(theta) t^2 / 2 stays negative.
  const T drift = hoop.rho * phi.sin * spin;
  const T last =
      (drift + sqrt(drift * drift + T(2) * hoop.cos_slope * hoop.rho * (T(1) - phi.cos))) / hoop.cos_slope;
  const T resolution = T(2) * std::numeric_limits<T>::epsilon();

  bool above = false;
  const auto segment = [&](const T& from,
                           const T& to) {  // y is monotone here; true once the flight has ended
    const T y_from = from == T(0) ? T(0) : height_at(from).value;
    const T y_to = height_at(to).value;
    if (!above && y_to > T(0)) above = true;
    if (above && y_to > T(2) * flight.height) flight.height = y_to / T(2), flight.apex_time = to;
    if (!above) flight.dip = std::min(flight.dip, y_to / T(2));
    if (!above || y_to > T(0)) return false;
    flight.flight_time = polish_root(height_at, from, to, from + (to - from) * y_from / (y_from - y_to),
                                     false, resolution * to);
    return true;
  };

  // A fast spin turns thousands of times in one flight. With y between L(t) = drift t - cos(theta) t^2 / 2 -
  // rho (1 + cos phi) and L(t) + 2 rho, no landing is possible while L > 0, and no apex farther than
  // 2 sqrt(rho / cos theta) from the vertex of L: the walk leaps over what lies between.
  const T vertex = drift / hoop.cos_slope, around = T(2) * sqrt(hoop.rho / hoop.cos_slope);
  const T clearance = drift * drift - T(2) * hoop.cos_slope * hoop.rho * (T(1) + phi.cos);
  const T half_width =
      clearance > T(0) ? sqrt(clearance) / hoop.cos_slope : T(0);  // of L > 0, about the vertex
  const auto next_of_interest = [&](const T& t) {
    if (!above || !(t > vertex - half_width) || !(t < vertex + half_width)) return t;
    if (t < vertex - around) return vertex - around;
    return t > vertex + around ? vertex + half_width : t;
  };

  // The angles at which y'' changes sign follow each other as opening, 2 pi - opening, 2 pi + opening, ...
  T start = T(0);
  T climb_start = T(0);
  const auto knot_time = [&](long knot) {
    return (T(2) * pi * T((knot + 1) / 2) + (knot % 2 == 0 ? opening : -opening) - turn) / spin;
  };
  for (long knot = 0; start <= last; ++knot) {
    const T end = knot_time(knot);
    if (end <= start) continue;
    const long leap = 2 * static_cast<long>(floor((turn + spin * next_of_interest(start)) / (T(2) * pi))) - 1;
    if (leap > knot) {
      start = knot_time(leap);
      climb_start = climb_at(start).value;
      knot = leap;
      continue;
    }
    const T climb_end = climb_at(end).value;
    const bool turns = (climb_start > T(0) && climb_end < T(0)) || (climb_start < T(0) && climb_end > T(0));
    if (turns) {
      const T extremum = polish_root(climb_at, start, end, start + (end - start) * T(0.5), climb_end > T(0),
                                     resolution * end);
      if (segment(start, extremum) || segment(extremum, end)) return flight;
    } else if (segment(start, end)) {
      return flight;
    }
    start = end;
    climb_start = climb_end;
  }
  return {};
}

}  // namespace leapmap
