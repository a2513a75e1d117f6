// SPDX-License-Identifier: GPL-3.0-or-later
/// The dimensionless groups of a hoop that the equations of motion see: masses in m + m_p, lengths in R,
/// times in sqrt(R/g). Radius and gravity only rescale an answer, so they appear in no equation of motion.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "numerics/dual.hpp"
#include "numerics/lanes.hpp"
#include "numerics/rows.hpp"

namespace leapmap {

/// The dimensionless groups of a Design, on any scalar: double, a SIMD batch, long double.
template <class T>
struct Hoop {
  T sin_slope;          ///< sin theta
  T cos_slope;          ///< cos theta
  T rho;                ///< r / R = alpha lambda, the centre of mass's distance from the hoop's centre
  T clearance;          ///< 1 - rho, its distance from the plane at phi = 0
  T Ic;                 ///< inertia about the centre of mass, J0 - rho^2
  T J_min;              ///< inertia about the contact at phi = 0, J0 + 1 - 2 rho, where it is least
  T drive;              ///< tau - the resistance: the torque on the hoop while it touches the plane
  T thrust;             ///< sin theta + drive, with which slope and torques drive the hoop downhill
  T resistance = T(0);  ///< of the contact against the rotation, signed as the spin of the release
  T aloft = T(0);       ///< tau / Ic, with which the motor turns the hoop in flight; 0: it idles there

  /// tau, the motor's torque.
  T motor() const { return drive + resistance; }
};

/// A hoop's groups in contact as so many numbers, in their order, and back: for what treats them all alike.
template <class T>
std::array<T, 9> numbers_of(const Hoop<T>& h) {
  return {h.sin_slope, h.cos_slope, h.rho, h.clearance, h.Ic, h.J_min, h.drive, h.thrust, h.resistance};
}
template <class T>
Hoop<T> hoop_of(const std::array<T, 9>& n) {
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]};
}
/// f of each of them.
template <class T, class S, class F>
Hoop<T> mapped(const Hoop<S>& hoop, const F& f) {
  const std::array<S, 9> from = numbers_of(hoop);
  std::array<T, 9> to;
  for (std::size_t k = 0; k < to.size(); ++k) to[k] = f(from[k]);
  Hoop<T> mapped = hoop_of(to);
  mapped.aloft = f(hoop.aloft);
  return mapped;
}

/// The same hoop with its motor in flight as the scene has it.
template <class T>
Hoop<T> in_flight(Hoop<T> hoop, const Scene& scene) {
  if (!scene.motor_in_flight) return hoop;
  if constexpr (has_derivatives<T>)
    hoop.aloft = hoop.motor() / hoop.Ic;
  else if (const MaskOf<T> driven = hoop.motor() != T(0); any(driven))
    hoop.aloft = select(driven, hoop.motor() / hoop.Ic, T(0));
  return hoop;
}

/// Whether a motor turns a hoop in flight, or would if it had a torque of which there are derivatives.
template <class T>
bool any_aloft(const Hoop<T>& hoop) {
  if constexpr (has_derivatives<T>)
    for (const auto& by : hoop.aloft.by)
      if (any(by != decltype(hoop.aloft.value)(0))) return true;
  return any(hoop.aloft != T(0));
}

/// What becomes of a hoop that a resisting torque acts on and that would reverse.
inline constexpr const char* reverses_against_resistance =
    "its rotation reverses, or is held while it slides, by the resisting torque, which is not followed";

/// Derives the groups from slope, mass_ratio, offset_ratio, inertia_factor and drive_torque, with alpha =
/// beta / (1 + beta) and J0 = kappa / (1 + beta) + alpha lambda^2. Clearance, Ic and J_min are written as
/// sums of non-negative terms: the textbook forms 1 - rho, J0 - rho^2 and J0 + 1 - 2 rho lose every digit for
/// a mass on the rim (lambda = 1) of a nearly massless hoop.
template <class T>
Hoop<T> reduce(const T& slope, const T& beta, const T& lambda, const T& kappa, const T& tau) {
  const T hub = T(1) / (T(1) + beta);  // m / (m + m_p)
  const T alpha = beta * hub;
  const T gap = T(1) - lambda;
  const SinCos<T> direction = sincos_of(slope);
  return {.sin_slope = direction.sin,
          .cos_slope = direction.cos,
          .rho = alpha * lambda,
          .clearance = hub + alpha * gap,
          .Ic = kappa * hub + alpha * hub * lambda * lambda,
          .J_min = (kappa + T(1)) * hub + alpha * gap * gap,
          .drive = tau,
          .thrust = direction.sin + tau};
}

/// The hoop with a resistance, signed as the spin that it acts against.
template <class T>
Hoop<T> resisted(Hoop<T> hoop, const T& resistance) {
  hoop.drive = hoop.drive - resistance, hoop.thrust = hoop.thrust - resistance;
  hoop.resistance = resistance;
  return hoop;
}

/// What a resisting torque c is multiplied by, for a hoop without it: 1 if it sets out downhill, -1 uphill.
/// At rest, if slope and motor push less than c, the part of c that holds the hoop where it is.
template <class T>
T resisted_way(const Hoop<T>& hoop, const T& c, const T& angle, const T& spin) {
  using std::abs;
  const SinCos<T> phi = sincos_of(angle);
  const T push = hoop.thrust - hoop.rho * (hoop.sin_slope * phi.cos + hoop.cos_slope * phi.sin);
  const auto sign = [](const T& value) {
    return select(value > T(0), T(1), select(value < T(0), T(-1), T(0)));
  };
  const T at_rest = select(abs(push) > c, sign(push), push / select(c > T(0), c, T(1)));
  return select(spin * spin != T(0), sign(spin), at_rest);
}

/// Of one design; 0 without a resisting torque.
inline double resistance_of(const Design& design) {
  const double c = design.resisting_torque;
  if (c == 0.0) return 0.0;
  const Hoop<double> hoop = reduce(design.slope, design.mass_ratio, design.offset_ratio,
                                   design.inertia_factor, design.drive_torque);
  return c * resisted_way(hoop, c, design.release_angle, design.release_spin);
}

template <class T>
Hoop<T> reduce(const Design& design) {
  return resisted(reduce(T(design.slope), T(design.mass_ratio), T(design.offset_ratio),
                         T(design.inertia_factor), T(design.drive_torque)),
                  T(resistance_of(design)));
}

template <class T>
Hoop<T> reduce(const Design& design, const Scene& scene) {
  return in_flight(reduce<T>(design), scene);
}

/// What matters of a design without friction.
template <class T>
struct GatheredDesigns {
  Hoop<T> hoop;
  T slope, release_angle, release_spin;
};
/// Of design_of(i) in lane i. What it reads are the first eight members of Design.
template <class T, class F>
GatheredDesigns<T> gathered_designs(const F& design_of) {
  static_assert(std::is_standard_layout_v<Design> &&
                offsetof(Design, resisting_torque) == 7 * sizeof(double));
  const auto [slope, mass_ratio, offset_ratio, inertia_factor, angle, spin, torque, resisting] =
      columns_of<T>([&](std::size_t i) { return reinterpret_cast<const double*>(&design_of(i)); });
  T resistance(0);
  if (any(resisting != T(0)))
    resistance = gathered<T>([&](std::size_t i) { return resistance_of(design_of(i)); });
  return {resisted(reduce(slope, mass_ratio, offset_ratio, inertia_factor, torque), resistance), slope, angle,
          spin};
}

/// The same hoop in every lane.
template <class T, class S>
Hoop<T> widened(const Hoop<S>& hoop) {
  return mapped<T>(hoop, [](const S& number) { return T(number); });
}

/// theta [rad].
template <class T>
T slope_of(const Hoop<T>& hoop) {
  using std::atan2;
  return atan2(hoop.sin_slope, hoop.cos_slope);
}

/// The hoop seen from behind the plane, where uphill and downhill, and the signs of angles and spins, are the
/// other way: what rolls uphill here rolls downhill there. way: 1, or -1 to look from behind.
template <class T>
Hoop<T> seen(const Hoop<T>& hoop, const T& way) {
  Hoop<T> seen = hoop;
  seen.sin_slope = way * hoop.sin_slope, seen.drive = way * hoop.drive, seen.thrust = way * hoop.thrust;
  seen.resistance = way * hoop.resistance, seen.aloft = way * hoop.aloft;
  return seen;
}

}  // namespace leapmap
