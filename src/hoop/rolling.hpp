// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip: the paper's equations (10), (11) and (12), divided by (m + m_p) g R or (m + m_p) g,
/// with a motor's torque tau beside sin(theta) in (10).
///
/// Forces are in units of the weight, phi in rad, spin w = dphi/dt in sqrt(g/R), time in sqrt(R/g).
#pragma once

#include <cmath>

#include "hoop/parameters.hpp"
#include "numerics/dual.hpp"

namespace leapmap {

/// Sine, cosine and versine (1 - cos) of an angle. The versine keeps its relative accuracy near multiples of
/// 2 pi, where the inertia about the contact is least and 1 - cos would have lost all digits.
template <class T>
struct Trig {
  T sin, cos, versine;
};

template <class T>
Trig<T> trig(const T& angle) {
  if constexpr (has_derivatives<T>) {
    const auto [sin, cos, versine] = trig(angle.value);
    return {angle.through(sin, cos), angle.through(cos, -sin), angle.through(versine, sin)};
  } else {
    const SinCos<T> half = sincos_of(angle * T(0.5));
    const T versine = T(2) * half.sin * half.sin;
    return {T(2) * half.sin * half.cos, T(1) - versine, versine};
  }
}

/// Of an angle as it is seen on a leg, way times it (parameters.hpp). phi: of the angle itself.
template <class T>
Trig<T> seen(const Trig<T>& phi, const T& way) {
  return {way * phi.sin, phi.cos, phi.versine};
}

/// x - sin x without cancellation, turned: trig(x). Its series is used below 0.7, to 4e-22 of the sum.
template <class T>
T x_minus_sin(const T& x, const Trig<T>& turned) {
  using std::abs;
  if constexpr (has_derivatives<T>) {
    const auto& [sin, cos, versine] = turned;
    return x.through(x_minus_sin(x.value, {sin.value, cos.value, versine.value}), versine.value);
  } else {
    const auto small = abs(x) < T(0.7);
    if (!any(small)) return x - turned.sin;
    using S = ScalarOf<T>;
    const T square = x * x;
    T sum(1);
    for (int k = 18; k >= 4; k -= 2) sum = T(1) - sum * square * T(S(1) / S(k * (k + 1)));
    return select(small, x * square * sum * T(S(1) / S(6)), x - turned.sin);
  }
}

/// Inertia about the contact, J(phi) = J0 + 1 - 2 rho cos phi.
template <class T>
T contact_inertia(const Hoop<T>& hoop, const Trig<T>& phi) {
  return hoop.J_min + T(2) * hoop.rho * phi.versine;
}

/// How far the centre of mass is from the plane, 1 - rho cos phi.
template <class T>
T height_of_mass(const Hoop<T>& hoop, const Trig<T>& phi) {
  return hoop.clearance + hoop.rho * phi.versine;
}

/// sin(theta + phi) and cos(theta + phi), the direction of gravity seen from the mass.
template <class T>
T sin_from_vertical(const Hoop<T>& hoop, const Trig<T>& phi) {
  return hoop.sin_slope * phi.cos + hoop.cos_slope * phi.sin;
}
template <class T>
T cos_from_vertical(const Hoop<T>& hoop, const Trig<T>& phi) {
  return hoop.cos_slope * phi.cos - hoop.sin_slope * phi.sin;
}

/// (10) solved for phi'' [g/R].
template <class T>
T angular_acceleration(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin) {
  return (hoop.thrust - hoop.rho * (sin_from_vertical(hoop, phi) + phi.sin * spin * spin)) /
         contact_inertia(hoop, phi);
}

/// (11) lambda_n, the normal force over the weight; it lifts off where this falls through zero.
template <class T>
T normal_force(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& acceleration) {
  return hoop.cos_slope + hoop.rho * (phi.sin * acceleration + phi.cos * spin * spin);
}

/// (12) lambda_f, the friction force over the weight, positive downhill.
template <class T>
T friction_force(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& acceleration) {
  return height_of_mass(hoop, phi) * acceleration + hoop.rho * phi.sin * spin * spin - hoop.sin_slope;
}

/// Partial derivatives of angular_acceleration by angle and by spin.
template <class T>
struct AccelerationGradient {
  T by_angle, by_spin;
};

template <class T>
AccelerationGradient<T> acceleration_gradient(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin,
                                              const T& acceleration) {
  const T J = contact_inertia(hoop, phi);
  return {
      -hoop.rho * (cos_from_vertical(hoop, phi) + phi.cos * spin * spin + T(2) * phi.sin * acceleration) / J,
      T(-2) * hoop.rho * phi.sin * spin / J};
}

/// phi''' along the motion, by the chain rule.
template <class T>
T angular_jerk(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& acceleration) {
  const AccelerationGradient<T> gradient = acceleration_gradient(hoop, phi, spin, acceleration);
  return gradient.by_angle * spin + gradient.by_spin * acceleration;
}

/// d/dt of normal_force along the motion.
template <class T>
T normal_force_rate(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& acceleration) {
  const T jerk = angular_jerk(hoop, phi, spin, acceleration);
  return hoop.rho * (phi.sin * (jerk - spin * spin * spin) + T(3) * phi.cos * spin * acceleration);
}

/// The same of friction_force.
template <class T>
T friction_force_rate(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin, const T& acceleration) {
  return height_of_mass(hoop, phi) * angular_jerk(hoop, phi, spin, acceleration) +
         hoop.rho * spin * (T(3) * phi.sin * acceleration + phi.cos * spin * spin);
}

/// Kinetic energy over (m + m_p) g R, (3) under (1) and (2).
template <class T>
T kinetic_energy(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin) {
  return T(0.5) * contact_inertia(hoop, phi) * spin * spin;
}

/// Potential energy over (m + m_p) g R, (4) under (1) and (2) but for a constant, less the work that the
/// motor has done; phi is trig(angle).
template <class T>
T potential_energy(const Hoop<T>& hoop, const T& angle, const Trig<T>& phi) {
  return -angle * hoop.thrust - hoop.rho * cos_from_vertical(hoop, phi);
}

/// Their sum, constant while rolling.
template <class T>
T rolling_energy(const Hoop<T>& hoop, const T& angle, const T& spin) {
  const Trig<T> phi = trig(angle);
  return kinetic_energy(hoop, phi, spin) + potential_energy(hoop, angle, phi);
}

}  // namespace leapmap
