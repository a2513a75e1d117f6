// SPDX-License-Identifier: GPL-3.0-or-later
/// Sliding with Coulomb friction, beyond the paper: (7) to (9) with (2) kept and lambda_f = -mu sign(v)
/// lambda_n.
///
/// v = x' - w is the contact point's velocity. With n0 = cos(theta) + rho c w^2 + rho s tau / Ic, which is
/// minus the y'' of a hoop that the plane lets go, and q = rho s - m (1 - rho c), m = mu sign(v), the forces
/// and accelerations are
///   N = n0 Ic / (Ic + rho s q),   F = -m N,   phi'' = tau / Ic - n0 q / (Ic + rho s q).
/// Both are linear in w^2: as a function of the angle u = w^2 obeys du/dphi = 2 phi'', a linear equation of
/// first order. Where Ic + rho s q <= 0 the rigid-body equations have no answer or two (Painleve).
///
/// As F = -m N, the mass's momentum along the plane and m times that away from it, v + (1 - rho c) w and
/// m rho s w, together gain sin(theta) - m cos(theta) a time unit. So travel and, but for its last digits,
/// slip follow from angle, spin and time (SlidingMomentum).
#pragma once

#include "hoop/rolling.hpp"

namespace leapmap {

/// What sliding says at one angle; everything else follows from w^2.
template <class T>
struct SlidingCoefficients {
  T pivot;  ///< Ic + rho s q; not above zero: indeterminate
  T turn;   ///< phi'' = turn n0 + tau / Ic
  T push;   ///< N = push n0
};

/// q; friction: m = mu_kinetic sign(v).
template <class T>
T sliding_lever(const Hoop<T>& hoop, const Trig<T>& phi, const T& friction) {
  return hoop.rho * phi.sin - friction * height_of_mass(hoop, phi);
}

/// pivot: Ic + rho s q, where somebody knows it better.
template <class T>
SlidingCoefficients<T> sliding_coefficients(const Hoop<T>& hoop, const Trig<T>& phi, const T& friction,
                                            const T& pivot) {
  const T inverse = reciprocal(pivot);
  return {pivot, -sliding_lever(hoop, phi, friction) * inverse, hoop.Ic * inverse};
}
template <class T>
SlidingCoefficients<T> sliding_coefficients(const Hoop<T>& hoop, const Trig<T>& phi, const T& friction) {
  const T q = sliding_lever(hoop, phi, friction), pivot = hoop.Ic + hoop.rho * phi.sin * q;
  return sliding_coefficients(hoop, phi, friction, pivot);
}

/// n0: the hoop leaves the plane where this falls through zero.
template <class T>
T free_normal_force(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin_squared) {
  return hoop.cos_slope + hoop.rho * (phi.cos * spin_squared + phi.sin * (hoop.drive / hoop.Ic));
}

/// Its derivative by time over the spin; angular: phi''.
template <class T>
T free_normal_force_rate(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin_squared, const T& angular) {
  return hoop.rho * (phi.cos * (T(2) * angular + hoop.drive / hoop.Ic) - phi.sin * spin_squared);
}

/// Accelerations while sliding.
template <class T>
struct SlidingMotion {
  T normal_force;  ///< [weights]
  T friction;      ///< lambda_f over the weight
  T angular;       ///< phi''
  T slip;          ///< v' = x'' - phi''
};

/// at: sliding_coefficients there; n0: free_normal_force there.
template <class T>
SlidingMotion<T> sliding_motion(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin_squared,
                                const T& friction, const SlidingCoefficients<T>& at, const T& n0) {
  const T N = at.push * n0, F = -friction * N, angular = at.turn * n0 + hoop.drive / hoop.Ic;
  const T arm = height_of_mass(hoop, phi);
  return {N, F, angular, F + hoop.sin_slope - arm * angular - hoop.rho * phi.sin * spin_squared};
}
template <class T>
SlidingMotion<T> sliding_motion(const Hoop<T>& hoop, const Trig<T>& phi, const T& spin_squared,
                                const T& friction) {
  return sliding_motion(hoop, phi, spin_squared, friction, sliding_coefficients(hoop, phi, friction),
                        free_normal_force(hoop, phi, spin_squared));
}

/// What both momenta together gain a time unit.
template <class T>
T momentum_gain(const Hoop<T>& hoop, const T& friction) {
  return hoop.sin_slope - friction * hoop.cos_slope;
}

/// Their sum v + reach w, reach = 1 - rho c + m rho s, and its integral, travel - rho s - m rho c, of a slide
/// one way that is counted from a given state.
template <class T>
class SlidingMomentum {
 public:
  SlidingMomentum(const Hoop<T>& hoop, const T& m, const Trig<T>& phi, const T& spin)
      : rho_(hoop.rho),
        friction_(m),
        clearance_(hoop.clearance),
        gain_(momentum_gain(hoop, m)),
        turning_(reach(phi) * spin),
        swung_(swing(phi)) {}

  /// What the slip has gained after a time, at which the hoop is at phi and has that spin.
  T slip_gained(const Trig<T>& phi, const T& spin, const T& time) const {
    return gain_ * time + (turning_ - reach(phi) * spin);
  }
  /// How far it has travelled after a time, at which it is at phi. slip: at the given state.
  T travelled(const Trig<T>& phi, const T& time, const T& slip) const {
    return time * (slip + turning_ + T(ScalarOf<T>(0.5)) * gain_ * time) + (swing(phi) - swung_);
  }

 private:
  T reach(const Trig<T>& phi) const { return clearance_ + rho_ * (phi.versine + friction_ * phi.sin); }
  T swing(const Trig<T>& phi) const { return rho_ * (phi.sin + friction_ * phi.cos); }

  T rho_, friction_, clearance_, gain_;
  T turning_, swung_;  // reach w and rho s + m rho c at the given state
};

}  // namespace leapmap
