// SPDX-License-Identifier: GPL-3.0-or-later
/// What a designer chooses (Design) and the groups the equations of motion see (Hoop).
///
/// Everything here is dimensionless: masses in m + m_p, lengths in R, times in sqrt(R/g). Radius and
/// gravity only rescale an answer, so they appear in no equation of motion; see Scene for them.
#pragma once

#include <cmath>
#include <numbers>

namespace leapmap {

/// One hoop and how it is released. The defaults are the paper's hoop, released from rest with its mass on
/// top.
struct Design {
  double slope = 0.40;                      ///< theta [rad], 0 <= slope < pi/2
  double mass_ratio = 20.0 / 8.2;           ///< beta = m_p / m, >= 0
  double offset_ratio = 1.0;                ///< lambda = L / R, in [0, 1]
  double inertia_factor = 1.0;              ///< kappa = I / (m R^2), >= 0: thin hoop 1, disc 1/2
  double release_angle = std::numbers::pi;  ///< phi at t = 0 [rad]; 0: mass on the plane, pi: mass on top
  double release_spin = 0.0;                ///< w at t = 0 [sqrt(g/R)], positive downhill
};

/// The dimensionless groups of a Design, on any scalar: double, a SIMD batch, __float128.
template <class T>
struct Hoop {
  T slope;      ///< theta [rad]
  T sin_slope;  ///< sin theta
  T cos_slope;  ///< cos theta
  T alpha;      ///< m_p / (m + m_p) = beta / (1 + beta)
  T rho;        ///< r / R = alpha lambda, the centre of mass's distance from the hoop's centre
  T J0;         ///< inertia about the hoop's centre, kappa / (1 + beta) + alpha lambda^2
  T Ic;         ///< inertia about the centre of mass, J0 - rho^2
  T J_min;      ///< inertia about the contact at phi = 0, J0 + 1 - 2 rho, where it is least
};

/// Derives the groups. Ic and J_min are written as sums of non-negative terms: the textbook forms J0 - rho^2
/// and J0 + 1 - 2 rho lose every digit for a mass on the rim (lambda = 1) of a nearly massless hoop.
template <class T>
Hoop<T> derive(const Design& design) {
  using std::cos, std::sin;
  const T slope(design.slope), beta(design.mass_ratio), lambda(design.offset_ratio),
      kappa(design.inertia_factor);
  const T hub = T(1) / (T(1) + beta);  // m / (m + m_p)
  const T alpha = beta * hub;
  const T gap = T(1) - lambda;
  Hoop<T> hoop;
  hoop.slope = slope;
  hoop.sin_slope = sin(slope);
  hoop.cos_slope = cos(slope);
  hoop.alpha = alpha;
  hoop.rho = alpha * lambda;
  hoop.J0 = kappa * hub + alpha * lambda * lambda;
  hoop.Ic = kappa * hub + alpha * hub * lambda * lambda;
  hoop.J_min = (kappa + T(1)) * hub + alpha * gap * gap;
  return hoop;
}

}  // namespace leapmap
