// SPDX-License-Identifier: GPL-3.0-or-later
/// A lift-off from rolling that was found in plain numbers, with its derivatives.
#pragma once

#include <cmath>
#include <limits>

#include "hoop/rolling_by_angle.hpp"
#include "numerics/dual.hpp"

namespace leapmap {

/// A lift-off with its derivatives, as seen on its leg.
template <class D>
struct LiftOffDual {
  D angle, spin;
};

/// A lift-off that was found in plain numbers. Where G hardly falls, on a fold, the root itself is known to
/// so few digits that the derivative's own error would be beyond a millionth of it: NaN.
template <class D, class T>
LiftOffDual<D> lift_off_at(const Roll<D>& roll, const T& angle) {
  using std::abs, std::sqrt;
  using S = ScalarOf<T>;
  const Roll<T> known = plain(roll);
  const CurvedSample<T> G = lift(known, angle);
  const Trig<T> at = trig(angle);
  const LiftTerms<T> terms = lift_terms(known.hoop, at);
  const T rho = known.hoop.rho;
  const T rounding =
      T(S(8) * std::numeric_limits<S>::epsilon()) *
      (abs(terms.P) * terms.J +
       rho * abs(terms.K) * (abs(known.level) + T(2) * (abs(angle * known.hoop.thrust) + rho)));
  const MaskOf<T> folded = !(rounding * abs(G.curvature) <= T(S(1e-6)) * G.rate * G.rate);
  const T slope = select(folded, T(std::numeric_limits<S>::quiet_NaN()), G.rate);

  const D here(angle);
  const Trig<D> there = trig(here);
  const D E = vis_viva(roll, here, there);
  const D root = with_derivatives(
      angle, lift(roll.hoop, lift_terms(roll.hoop, there), E, D(2) * torque(roll.hoop, there)).value, slope);
  const Trig<D> phi = trig(root);
  return {root, sqrt(vis_viva(roll, root, phi) / contact_inertia(roll.hoop, phi))};
}

}  // namespace leapmap
