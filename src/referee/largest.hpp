// SPDX-License-Identifier: GPL-3.0-or-later
/// The largest values that functions of a state have within a step of an integration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "numerics/gsl_integrator.hpp"

namespace leapmap::referee {

/// Raises numbers of `most` to what the step in hand has of them up to a time of the step; look(state): as
/// they are there.
/// Looks at the interpolated step first: the method's own states cost a step each. Where that comes near the
/// largest one so far, closes in by golden sections of the method's own.
template <std::size_t D, class Numbers, std::size_t N, class Look>
void raise_to_largest(const GslIntegrator<D>& integrator, double end, const Look& look,
                      const std::array<double Numbers::*, N>& numbers, Numbers& most) {
  constexpr int parts = 8;
  // What an interpolation over a long step may be off, as a share of how much the number changes in it.
  constexpr double doubt = 0.1;
  std::array<Numbers, parts + 1> seen;
  for (int k = 0; k <= parts; ++k)
    seen[static_cast<std::size_t>(k)] = look(interpolate(integrator.step(), end * k / parts));
  for (double Numbers::*const of : numbers) {
    const auto [least, best] = std::ranges::minmax_element(seen, {}, of);
    const double change = (*best).*of - (*least).*of;
    if (!((*best).*of + doubt * change > most.*of)) continue;
    const auto at = [&](double tau) {
      State<D> y = tau > 0.0 ? integrator.step().y1 : integrator.step().y0;
      if (tau > 0.0 && tau < integrator.step().h) integrator.retake(tau, y);
      const double number = look(y).*of;
      most.*of = std::max(most.*of, number);
      return number;
    };
    const auto place = static_cast<int>(best - seen.begin());
    if (place == 0 || place == parts) at(place == 0 ? 0.0 : end);
    // Still growing at an end of the step: that is the largest of it, and the next step goes on.
    constexpr double flat = 0.6;  // growth over growth before; a third: the top is at the end
    const auto grows_towards = [&](std::size_t last, std::size_t before, std::size_t first) {
      return seen[last].*of - seen[before].*of > flat * (seen[before].*of - seen[first].*of);
    };
    if ((place == parts && grows_towards(parts, parts - 1, parts - 2)) ||
        (place == 0 && grows_towards(0, 1, 2)))
      continue;
    double low = end * std::max(place - 1, 0) / parts, high = end * std::min(place + 1, parts) / parts;
    constexpr double golden = 0.6180339887498949;
    double left = high - golden * (high - low), right = low + golden * (high - low);
    double at_left = at(left), at_right = at(right);
    while (high - low > 1e-6 * end) {  // a maximum is flat: its value is known to the square of that
      if (at_left < at_right) {
        low = left, left = right, at_left = at_right;
        at_right = at(right = low + golden * (high - low));
      } else {
        high = right, right = left, at_right = at_left;
        at_left = at(left = high - golden * (high - low));
      }
    }
  }
}

}  // namespace leapmap::referee
