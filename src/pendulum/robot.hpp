// SPDX-License-Identifier: GPL-3.0-or-later
/// A hoop with a pendulum on its axis and a motor between them, as its equations see it: masses in m + m_p,
/// lengths in R, times in sqrt(R/g). The pendulum's angle psi is measured as the hoop's phi: at 0 it points
/// at the plane, at pi away from it. The motor's torque tau acts on the pendulum, and -tau on the hoop.
///
/// With u = psi', w = phi', the centre of the hoop at x, 1 + y, and the contact's forces F and N,
///
///   x'' - rho (c u' - s u^2) = sin(theta) + F
///   y'' + rho (s u' + c u^2) = N - cos(theta)
///   J w'                     = -tau - F
///   A u' - rho c x'' + rho s y'' = tau - rho sin(theta + psi)
///
/// where s and c are of psi, rho = alpha lambda, J the hoop's inertia and A the pendulum's about the axis. A
/// pendulum that is locked (u = w) is the hoop of (10) to (12) with J0 = J + A.
#pragma once

#include <cmath>
#include <limits>

#include "leapmap/design.hpp"
#include "numerics/lanes.hpp"

namespace leapmap::pendulum {

/// The dimensionless groups. Differences of near equals, as A (1 + J) - rho^2, are sums of hub and others.
struct Robot {
  double sin_slope, cos_slope;
  double hub;     ///< m / (m + m_p)
  double alpha;   ///< m_p / (m + m_p)
  double lambda;  ///< the pendulum's length
  double rho;     ///< alpha lambda
  double own;     ///< the pendulum's own inertia over m_p L^2
  double J;       ///< inertia of the hoop
  double A;       ///< inertia of the pendulum about the axis
  double A_free;  ///< A - rho^2: what turns in flight

  /// Whether its equations have one answer: nothing that turns is without inertia.
  bool is_sound() const { return A_free > 0.0 && J > 0.0; }
};

inline Robot reduce(const Design& design) {
  const double hub = 1.0 / (1.0 + design.mass_ratio), alpha = design.mass_ratio * hub,
               lambda = design.offset_ratio, own = design.pendulum_inertia;
  const SinCos<double> direction = sincos_of(design.slope);
  return {.sin_slope = direction.sin,
          .cos_slope = direction.cos,
          .hub = hub,
          .alpha = alpha,
          .lambda = lambda,
          .rho = alpha * lambda,
          .own = own,
          .J = design.inertia_factor * hub,
          .A = alpha * lambda * lambda * (1.0 + own),
          .A_free = alpha * lambda * lambda * (hub + own)};
}

/// What the motor does: gives a torque, or holds the pendulum to the hoop, so that u' = w', by whatever
/// torque that takes.
template <class T>
struct Drive {
  T torque{};
  bool holds = false;
};

/// The second derivatives, the motor's torque, and the forces of the plane over the weight.
template <class T>
struct Forces {
  T along, across;   ///< x'', y''
  T hoop, pendulum;  ///< w', u'
  T torque;          ///< tau
  T normal, friction;
};

/// Rolling without slip: x'' = w', y'' = 0.
template <class T>
Forces<T> rolling(const Robot& r, const SinCos<T>& psi, const T& u, const Drive<T>& drive) {
  const T s = psi.sin, c = psi.cos;
  const T pull = r.sin_slope - r.rho * s * u * u;                 // along the plane
  const T weight = -r.rho * (r.sin_slope * c + r.cos_slope * s);  // turns the pendulum
  Forces<T> f;
  if (drive.holds) {
    const T gap = 1.0 - r.lambda * c, lever = r.lambda * s;
    const T inertia = r.hub + r.J + r.alpha * (gap * gap + lever * lever + r.lambda * r.lambda * r.own);
    f.hoop = f.pendulum = (pull + weight) / inertia;
    f.torque = (r.A - r.rho * c) * f.pendulum - weight;
  } else {
    f.torque = drive.torque;
    const T hoop = pull - f.torque, swing = f.torque + weight;
    const T determinant =
        r.alpha * r.lambda * r.lambda * (r.hub + r.alpha * s * s + (r.own * (1.0 + r.J) + r.J));
    const T inverse = T(1.0) / determinant;
    f.hoop = (r.A * hoop + r.rho * c * swing) * inverse;
    f.pendulum = (r.rho * c * hoop + (1.0 + r.J) * swing) * inverse;
  }
  f.along = f.hoop, f.across = T(0.0);
  f.normal = r.cos_slope + r.rho * (s * f.pendulum + c * u * u);
  f.friction = -f.torque - r.J * f.hoop;
  return f;
}

/// What friction can hold a rolling contact with, raised by some roundings: what sticks but for rounding
/// sticks.
template <class T>
T static_friction(const Forces<T>& f, double mu_static) {
  using std::abs;
  return mu_static * f.normal + 32.0 * std::numeric_limits<double>::epsilon() *
                                    (mu_static * abs(f.normal) + abs(f.friction) + abs(f.torque));
}

/// Minus y'' without the plane, times what turns; falls through zero where sliding ends in a lift-off,
/// whatever the friction is. Above zero contact is consistent.
template <class T>
T free_normal_force(const Robot& r, const SinCos<T>& psi, const T& u, const Drive<T>& drive) {
  const T held_down = r.cos_slope + r.rho * psi.cos * u * u;
  if (drive.holds) return held_down * (r.A_free + r.J);
  return held_down * r.A_free + r.rho * psi.sin * drive.torque;
}

/// By what free_normal_force is divided to give N. At zero or below sliding has no answer, or two: Painleve's
/// region. drag: F / N, -mu_kinetic with the sign of the slip.
template <class T>
T pivot(const Robot& r, const SinCos<T>& psi, double drag, bool held) {
  const T s = psi.sin, c = psi.cos;
  if (held) return r.A_free + r.J + r.rho * s * (r.rho * s - drag * (r.rho * c - 1.0));
  return r.A_free + r.rho * r.rho * s * (s - drag * c);
}

/// Sliding: y'' = 0, F = drag N.
template <class T>
Forces<T> sliding(const Robot& r, const SinCos<T>& psi, const T& u, const Drive<T>& drive, double drag) {
  const T s = psi.sin, c = psi.cos;
  Forces<T> f;
  f.normal = free_normal_force(r, psi, u, drive) / pivot(r, psi, drag, drive.holds);
  f.friction = drag * f.normal;
  if (drive.holds) {
    f.hoop = f.pendulum = -(r.rho * s - drag * (r.rho * c - 1.0)) * f.normal * (1.0 / (r.A_free + r.J));
    f.torque = -f.friction - r.J * f.hoop;
  } else {
    f.torque = drive.torque;
    f.hoop = -(f.torque + f.friction) * (1.0 / r.J);
    f.pendulum = (f.torque - r.rho * (s - drag * c) * f.normal) * (1.0 / r.A_free);
  }
  f.along = r.sin_slope + f.friction + r.rho * (c * f.pendulum - s * u * u);
  f.across = T(0.0);
  return f;
}

/// Off the plane.
template <class T>
Forces<T> flying(const Robot& r, const SinCos<T>& psi, const T& u, const Drive<T>& drive) {
  Forces<T> f;
  f.torque = drive.holds ? T(0.0) : drive.torque;
  f.hoop = -f.torque * (1.0 / r.J), f.pendulum = f.torque * (1.0 / r.A_free);
  f.along = r.sin_slope + r.rho * (psi.cos * f.pendulum - psi.sin * u * u);
  f.across = -r.cos_slope - r.rho * (psi.sin * f.pendulum + psi.cos * u * u);
  f.normal = f.friction = T(0.0);
  return f;
}

}  // namespace leapmap::pendulum
