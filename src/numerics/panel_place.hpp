// SPDX-License-Identifier: GPL-3.0-or-later
/// Where an integral over a panel comes to a given value.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/spectral.hpp"

namespace leapmap {

/// A SpectralPanel of whatever kind, made at the first call.
template <class Panel>
const Panel& shared_panel() {
  static const Panel panel;
  return panel;
}

/// The place in [0, 1] where the integral from 0 of a function above zero is `reached`: between two knots by
/// the cubic that has the inverse function's values and slopes there, then by Newton's method, one step of
/// which is mostly enough. integrals, values: of the function, at the nodes. whole: its integral over the
/// panel. Good to roundings of a well resolved panel.
template <std::size_t n>
double place_of_integral(const SpectralPanel<double, n>& panel,
                         const typename SpectralPanel<double, n>::Values& integrals,
                         const typename SpectralPanel<double, n>::Values& values, double whole,
                         double reached) {
  constexpr double enough = 1e-8;  // a step's square is a rounding
  constexpr int most_steps = 4;
  const auto next = static_cast<std::size_t>(std::upper_bound(integrals.begin(), integrals.end(), reached) -
                                             integrals.begin());
  const bool first = next == 0, last = next == n;
  const double from = first ? 0.0 : panel.node[next - 1], to = last ? 1.0 : panel.node[next];
  const double begin = first ? 0.0 : integrals[next - 1], end = last ? whole : integrals[next];
  const double share = (reached - begin) / (end - begin), length = to - from;
  // Of the ends the function is not known: there it is taken to be what it is at the node beside.
  const double rise_from = (end - begin) / values[first ? 0 : next - 1],
               rise_to = (end - begin) / values[last ? n - 1 : next];
  double place = from + share * (rise_from + share * (3.0 * length - 2.0 * rise_from - rise_to +
                                                      share * (rise_from + rise_to - 2.0 * length)));
  for (int k = 0; k < most_steps; ++k) {
    place = std::clamp(place, 0.0, 1.0);
    const auto [integral, value] = panel.template values<2>({&integrals, &values}, place);
    const double step = (reached - integral) / value;
    place += step;
    if (!(std::abs(step) > enough)) break;
  }
  return std::clamp(place, 0.0, 1.0);
}

}  // namespace leapmap
