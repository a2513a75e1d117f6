// SPDX-License-Identifier: GPL-3.0-or-later
/// Designs aimed at the places where a solver changes its mind: random ones never meet them.
#pragma once

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>

#include "hoop/rolling_by_angle.hpp"
#include "leapmap/design.hpp"
#include "noslip/lift_off_scan.hpp"
#include "support/designs.hpp"

namespace leapmap::testing {

/// How many designs a test aims: LEAPMAP_AIMED if it is set.
inline std::size_t how_many(std::size_t otherwise) {
  const char* asked = std::getenv("LEAPMAP_AIMED");
  return asked ? std::strtoull(asked, nullptr, 10) : otherwise;
}

/// x moved by so many units in its last place.
inline double nudged(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, 1e300);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -1e300);
  return x;
}

/// A design whose normal force vanishes at a node of the scan, but for up to three units in the last place of
/// its release spin; or at the release itself. Unset: this draw cannot.
inline std::optional<Design> aimed_at_a_node(std::mt19937_64& random) {
  Design design;
  design.slope = uniform(random, 0.02, 1.2);
  design.mass_ratio = std::exp(uniform(random, -2.0, 5.0));
  design.offset_ratio = uniform(random, 0.0, 1.0) < 0.3 ? 1.0 : uniform(random, 0.2, 1.0);
  design.inertia_factor = uniform(random, 0.0, 1.0) < 0.5 ? 1.0 : 0.5;
  const double step = 2.0 * std::numbers::pi / nodes_a_turn;
  const auto whole = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const int release_node = whole(-24, 72);
  const bool on_node = whole(0, 3) == 0;  // released on a node, too
  design.release_angle =
      on_node ? nudged(release_node * step, whole(-3, 3)) : (release_node + uniform(random, 0.0, 1.0)) * step;
  const bool at_release = whole(0, 9) == 0;
  const double angle = at_release ? design.release_angle : (release_node + whole(1, 100)) * step;

  // G = P J + rho K E = 0 tells E there, and the energy integral the spin at release, all in long double.
  const Hoop<long double> hoop = reduce<long double>(design);
  const Roll<long double> rest = begin_roll(hoop, static_cast<long double>(design.release_angle), 0.0L);
  const CurvedSample<long double> at_rest = lift(rest, static_cast<long double>(angle));
  Roll<long double> more = rest;
  more.level += 1.0L;
  const long double slope_by_E = lift(more, static_cast<long double>(angle)).value - at_rest.value;
  const long double released = -at_rest.value / slope_by_E;
  if (!(released > 0.0L)) return std::nullopt;
  design.release_spin = static_cast<double>(std::sqrt(released / contact_inertia(hoop, rest.release_trig)));
  if (!(design.release_spin < 10.0)) return std::nullopt;
  design.release_spin = nudged(design.release_spin, whole(-3, 3));
  return design;
}

}  // namespace leapmap::testing
