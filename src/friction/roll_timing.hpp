// SPDX-License-Identifier: GPL-3.0-or-later
/// What the times of rolling phases have in common, timed alone (rolling_leg.hpp) or in lanes
/// (timed_rolls.hpp): by panels in q, x = shift + q^2 past the release.
#pragma once

#include <algorithm>
#include <limits>

#include "hoop/rolling_by_angle.hpp"

namespace leapmap {

/// To how much of a panel's time its nodes are to resolve it, of phases to be timed to a tolerance.
template <class S>
S panel_tolerance(double tolerance) {
  return std::max(S(tolerance) * S(0.1), S(1000) * std::numeric_limits<S>::epsilon());
}

/// The shift in [-length, 0]: near E's zero before the release, where the spin is small and grows, so that q
/// takes that out. Newton's method from the release comes to it from above where E is convex; where it does
/// not, any shift will do.
template <class T>
T zero_before_release(const Roll<T>& roll, const T& length) {
  using S = ScalarOf<T>;
  const T zero(S(0)), two(S(2));
  T x = select(roll.push > zero, T(-roll.released / (two * roll.push)), T(-length));
  MaskOf<T> nearing = (x > -length) & (x < zero);
  for (int k = 0; k < 4 && any(nearing); ++k) {
    const T push = torque(roll.hoop, trig(T(roll.release + x)));
    nearing = nearing & (push > zero);
    x = select(nearing, T(x - vis_viva_past_release(roll, x) / (two * push)), x);
    nearing = nearing & (x > -length) & (x < zero);
  }
  return larger(T(-length), smaller(x, zero));
}

/// What of a panel's time up to q = `to`, relative, no nodes resolve: beside a stall E is a difference of
/// near equals, and its roundings count. thrust: |sin(theta) + tau|; least: of E on the panel.
template <class T>
T time_rounding(const T& released, const T& thrust, const T& to, const T& least) {
  using S = ScalarOf<T>;
  const T terms = T(S(4)) + released + T(S(2)) * to * to * thrust;
  return smaller(T(S(16) * std::numeric_limits<S>::epsilon()) * terms / least, T(S(1e-4)));
}

}  // namespace leapmap
