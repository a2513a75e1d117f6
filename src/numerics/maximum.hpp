// SPDX-License-Identifier: GPL-3.0-or-later
/// Maxima by the zeros of their rates: a maximum's value shows where it lies to half the digits only.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/dual.hpp"

namespace leapmap {

/// A number and its rate.
using Rated = Dual<double, 1>;

/// Where f's rate falls through zero between two places, by false position with weights halved where one end
/// stays (Illinois).
template <class F>
double top_between(const F& f, double from, double to, double rate_from, double rate_to) {
  const double close = 4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(from), std::abs(to));
  constexpr int most_steps = 100;
  for (int step = 0; step < most_steps && to - from > close; ++step) {
    const double guess = from + (to - from) * (rate_from / (rate_from - rate_to));
    const double place = from < guess && guess < to ? guess : 0.5 * (from + to);
    const double rate = f(place).by[0];
    if (rate == 0.0 || place == from || place == to) return place;
    if (rate > 0.0)
      from = place, rate_from = rate, rate_to *= 0.5;
    else
      to = place, rate_to = rate, rate_from *= 0.5;
  }
  return 0.5 * (from + to);
}

}  // namespace leapmap
