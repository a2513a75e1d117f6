// SPDX-License-Identifier: GPL-3.0-or-later
/// The dimensionless groups of a hoop that the equations of motion see: masses in m + m_p, lengths in R,
/// times in sqrt(R/g). Radius and gravity only rescale an answer, so they appear in no equation of motion.
#pragma once

#include "leapmap/design.hpp"
#include "numerics/lanes.hpp"

namespace leapmap {

/// The dimensionless groups of a Design, on any scalar: double, a SIMD batch, long double.
template <class T>
struct Hoop {
  T slope;      ///< theta [rad]
  T sin_slope;  ///< sin theta
  T cos_slope;  ///< cos theta
  T rho;        ///< r / R = alpha lambda, the centre of mass's distance from the hoop's centre
  T clearance;  ///< 1 - rho, its distance from the plane at phi = 0
  T Ic;         ///< inertia about the centre of mass, J0 - rho^2
  T J_min;      ///< inertia about the contact at phi = 0, J0 + 1 - 2 rho, where it is least
};

/// Derives the groups from slope, mass_ratio, offset_ratio and inertia_factor, with alpha = beta / (1 + beta)
/// and J0 = kappa / (1 + beta) + alpha lambda^2. Clearance, Ic and J_min are written as sums of non-negative
/// terms: the textbook forms 1 - rho, J0 - rho^2 and J0 + 1 - 2 rho lose every digit for a mass on the rim
/// (lambda = 1) of a nearly massless hoop.
template <class T>
Hoop<T> derive(const T& slope, const T& beta, const T& lambda, const T& kappa) {
  const T hub = T(1) / (T(1) + beta);  // m / (m + m_p)
  const T alpha = beta * hub;
  const T gap = T(1) - lambda;
  const SinCos<T> direction = sincos_of(slope);
  return {.slope = slope,
          .sin_slope = direction.sin,
          .cos_slope = direction.cos,
          .rho = alpha * lambda,
          .clearance = hub + alpha * gap,
          .Ic = kappa * hub + alpha * hub * lambda * lambda,
          .J_min = (kappa + T(1)) * hub + alpha * gap * gap};
}

template <class T>
Hoop<T> derive(const Design& design) {
  return derive(T(design.slope), T(design.mass_ratio), T(design.offset_ratio), T(design.inertia_factor));
}

/// The same hoop in every lane.
template <class T>
Hoop<T> widened(const Hoop<ScalarOf<T>>& hoop) {
  return {T(hoop.slope),     T(hoop.sin_slope), T(hoop.cos_slope), T(hoop.rho),
          T(hoop.clearance), T(hoop.Ic),        T(hoop.J_min)};
}

}  // namespace leapmap
