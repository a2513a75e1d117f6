// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a smooth function first falls from above to below zero on a short interval.
#pragma once

#include <cmath>
#include <limits>

#include "numerics/events.hpp"
#include "numerics/root.hpp"

namespace leapmap {

/// Whether a smooth function that is above zero at both ends of a short interval, `apart` from each other,
/// surely is so between them: it has no minimum there, or the tangents at the ends meet above zero.
template <class T>
MaskOf<T> stays_above(const Sample<T>& at_a, const Sample<T>& at_b, const T& apart) {
  const T none(ScalarOf<T>(0)), turns = at_b.rate - at_a.rate;  // above zero where there is a minimum
  const T meet = at_a.value * turns + at_a.rate * (at_b.rate * apart - (at_b.value - at_a.value));
  return (at_a.rate >= none) | (at_b.rate <= none) | (meet > none);
}

/// A smooth function on an interval: where it first falls from above to below zero. Its ends' values and
/// rates tell; where they leave a minimum near zero in doubt, it is asked. NaN: it does not fall.
template <class S, class F>
S first_fall(const F& f, const S& a, const S& b, const Sample<S>& at_a, const Sample<S>& at_b) {
  const S none = std::numeric_limits<S>::quiet_NaN(), h = b - a;
  const S resolution = S(2) * std::numeric_limits<S>::epsilon() * (std::abs(a) + std::abs(b));
  if (has_fallen(at_a)) return a;
  if (has_fallen(at_b)) return polish_root(f, a, b, a + h * S(0.5), false, resolution);
  if (stays_above(at_a, at_b, h)) return none;
  // A minimum in doubt, by the cubic's slope; the interval is short, so that it is near there.
  S left = a, right = b, left_rate = at_a.rate, right_rate = at_b.rate;
  for (int i = 0; i < 60 && right - left > resolution; ++i) {
    S x = i % 3 == 2 ? left + (right - left) * S(0.5)
                     : left + (right - left) * left_rate / (left_rate - right_rate);
    if (!(x > left && x < right)) x = left + (right - left) * S(0.5);
    const Sample<S> at = f(x);
    if (at.value < S(0)) return polish_root(f, a, x, a + (x - a) * S(0.5), false, resolution);
    // No fall if even the tangents here stay above zero.
    if (at.value + at.rate * (at.rate > S(0) ? left - x : right - x) > S(0)) return none;
    at.rate < S(0) ? (left = x, left_rate = at.rate) : (right = x, right_rate = at.rate);
  }
  return none;
}

}  // namespace leapmap
