// SPDX-License-Identifier: GPL-3.0-or-later
/// Free flight (13) in closed form: the spin is constant, unless a motor turns the hoop on (Hoop::aloft), and
/// the centre of mass flies a parabola.
///
/// The hoop's lowest point is at height y(t) above the plane. Right after a lift-off from rolling y often
/// dips below zero, because friction is cut off while it still brakes the spin; the jump is the first
/// interval with y > 0. Measured in turned angle psi = w t and in heights of rho, a flight has two numbers
/// only, a Toss.
#pragma once

#include <cmath>
#include <numbers>

#include "hoop/parameters.hpp"
#include "hoop/rolling.hpp"
#include "numerics/root.hpp"

namespace leapmap {

/// Where a flight begins, both contact constraints dropped; how the contact point moves is told beside it.
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

/// A flight without its units, and the turns of its y'. y' has a maximum at psi = top, and again a turn
/// later, and before it a minimum at top - 2 (pi - opening), if that is not before the lift-off.
template <class T>
struct Toss {
  Trig<T> phi;  ///< of the angle at lift-off
  T gravity;    ///< gamma = cos(theta) / (rho w^2)
  T swing;      ///< sqrt(1 - gamma^2)
  T opening;    ///< acos(-gamma): y'' > 0 for phi + psi in (opening, 2 pi - opening), modulo 2 pi
  T top;        ///< psi at the first maximum of y'
  T fastest;    ///< y' / rho there; from turn to turn it loses 2 pi gamma
};

/// y and three derivatives of it by psi, over rho:
///   y   = sin(phi) (psi - sin psi) - cos(phi) (1 - cos psi) - gamma psi^2 / 2
///   y'  = sin(phi) (1 - cos psi) - cos(phi) sin psi - gamma psi
///   y'' = -cos(phi + psi) - gamma
/// which is the hoop centre's height in free flight term by term, with every difference of near equals
/// carried out.
template <class T>
CurvedSample<T> toss_height(const Toss<T>& toss, const T& psi) {
  const Trig<T> turned = trig(psi);
  const T s = toss.phi.sin, c = toss.phi.cos;
  return {s * x_minus_sin(psi, turned) - c * turned.versine - T(0.5) * toss.gravity * psi * psi,
          s * turned.versine - c * turned.sin - toss.gravity * psi,
          s * turned.sin - c * turned.cos - toss.gravity, s * turned.cos + c * turned.sin};
}

/// y' and three derivatives of it, over rho.
template <class T>
CurvedSample<T> toss_climb(const Toss<T>& toss, const T& psi) {
  const Trig<T> turned = trig(psi);
  const T s = toss.phi.sin, c = toss.phi.cos;
  return {s * turned.versine - c * turned.sin - toss.gravity * psi,
          s * turned.sin - c * turned.cos - toss.gravity, s * turned.cos + c * turned.sin,
          c * turned.cos - s * turned.sin};
}

/// Beyond this psi the hoop stays below the plane: where (psi (sin(phi) + launch) + 1 - cos(phi)) = gamma
/// psi^2 / 2.
template <class T>
T toss_end(const Toss<T>& toss, const T& launch = T(0)) {
  using std::sqrt;
  const T s = toss.phi.sin + launch;
  return (s + sqrt(s * s + T(2) * toss.gravity * toss.phi.versine)) / toss.gravity;
}

/// The toss that starts at an angle, whose trig is phi, with a spin >= 0. Where gravity wins from the start
/// (gamma >= 1), fastest is not above zero.
template <class T>
Toss<T> toss_of(const Hoop<T>& hoop, const T& angle, const Trig<T>& phi, const T& spin) {
  using std::acos, std::floor, std::sqrt;
  const T pi(std::numbers::pi_v<ScalarOf<T>>), two_pi = T(2) * pi;
  Toss<T> toss;
  toss.phi = phi;
  toss.gravity = hoop.cos_slope / (hoop.rho * spin * spin);
  const MaskOf<T> light = toss.gravity < T(1);
  toss.opening = acos(select(light, -toss.gravity, T(0)));
  const T top = two_pi - toss.opening - (angle - two_pi * floor(angle / two_pi));
  toss.top = select(top < T(0), top + two_pi, top);
  toss.swing = sqrt(larger(T(1) - toss.gravity * toss.gravity, T(0)));
  toss.fastest = select(light, phi.sin + toss.swing - toss.gravity * toss.top, T(-1));
  return toss;
}

/// How far a hoop has turned in flight, and how fast it turns.
template <class T>
struct Turned {
  T value, rate;
  Trig<T> trig;  ///< of the value
};
template <class T>
Turned<T> turned_in_flight(const Hoop<T>& hoop, const T& spin, const T& t) {
  T turned = spin * t, rate = spin;
  if (any_aloft(hoop)) turned = turned + T(0.5) * hoop.aloft * t * t, rate = rate + hoop.aloft * t;
  return {turned, rate, trig(turned)};
}

/// y(t), dy/dt and y'', t after a lift-off at phi with any spin and with normal velocity v_n, zero but for a
/// rebound; with the motor on y''' as well, else 0 in its place.
template <class T>
struct HeightAbovePlane {
  T value, rate, acceleration, jerk;
};
template <class T>
HeightAbovePlane<T> height_above_plane(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& t,
                                       const T& normal_velocity = T(0)) {
  const Turned<T> turned = turned_in_flight(hoop, spin, t);
  const T s = phi.sin, c = phi.cos, turn_rate = turned.rate;
  HeightAbovePlane<T> y{
      hoop.rho * (s * x_minus_sin(turned.value, turned.trig) - c * turned.trig.versine) +
          t * (normal_velocity - T(0.5) * hoop.cos_slope * t),
      normal_velocity - hoop.cos_slope * t +
          hoop.rho * turn_rate * (s * turned.trig.versine - c * turned.trig.sin),
      hoop.rho * turn_rate * turn_rate * (s * turned.trig.sin - c * turned.trig.cos) - hoop.cos_slope, T(0)};
  if (!any_aloft(hoop)) return y;
  const T lift = hoop.rho * hoop.aloft;
  const T sine = s * turned.trig.cos + c * turned.trig.sin,
          cosine = c * turned.trig.cos - s * turned.trig.sin;
  y.value = y.value - T(0.5) * lift * s * t * t, y.rate = y.rate - lift * s * t;
  y.acceleration = y.acceleration - lift * sine;
  y.jerk = turn_rate * (hoop.rho * turn_rate * turn_rate * sine - T(3) * lift * cosine);
  return y;
}

/// How far the hoop's centre has travelled along the plane since lift-off, and how fast it travels: the
/// centre of mass at x - rho sin(phi) flies on with its speed at lift-off and falls with sin(theta). slip: v
/// at lift-off, x' = v + w.
template <class T>
Sample<T> travel_in_flight(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& slip,
                           const T& t) {
  const Turned<T> turned = turned_in_flight(hoop, spin, t);
  const T sine_gained = phi.cos * turned.trig.sin - phi.sin * turned.trig.versine;  // sin(phi(t)) - sin(phi)
  const T cosine_gained =
      -phi.sin * turned.trig.sin - phi.cos * turned.trig.versine;  // cos(phi(t)) - cos(phi)
  Sample<T> x{(slip + spin * (T(1) - hoop.rho * phi.cos)) * t + hoop.sin_slope * t * t * T(0.5) +
                  hoop.rho * sine_gained,
              slip + spin + hoop.sin_slope * t + hoop.rho * spin * cosine_gained};
  if (any_aloft(hoop)) x.rate = x.rate + hoop.rho * hoop.aloft * t * (phi.cos + cosine_gained);
  return x;
}

}  // namespace leapmap
