// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "referee/motion.hpp"

namespace leapmap::referee {
namespace {

/// The root of f between a and b, where it has different signs, to the last bit.
template <class F>
double bisect(const F& f, double a, double b) {
  const bool above = f(a) > 0.0;
  for (double middle = a + (b - a) / 2; a < middle && middle < b; middle = a + (b - a) / 2)
    ((f(middle) > 0.0) == above ? a : b) = middle;
  return b;
}

}  // namespace

Motion flying(const Body& body, const Motion& lift_off, double time) {
  const double a = body.arm(), w = lift_off.spin, spin = w + body.turn * time;
  const double phi = lift_off.phi + w * time + body.turn * time * time / 2;
  const double s0 = std::sin(lift_off.phi), c0 = std::cos(lift_off.phi), s = std::sin(phi), c = std::cos(phi);
  const double along = body.g_along, across = -body.g_across;
  // of the centre of mass, (x - a sin phi, y - a cos phi)
  const double x_rate = lift_off.x_rate - a * c0 * w + along * time;
  const double y_rate = lift_off.y_rate + a * s0 * w + across * time;
  const double x = lift_off.x - a * s0 + (lift_off.x_rate - a * c0 * w) * time + along * time * time / 2;
  const double y = lift_off.y - a * c0 + (lift_off.y_rate + a * s0 * w) * time + across * time * time / 2;
  return {x + a * s, y + a * c, phi, x_rate + a * c * spin, y_rate - a * s * spin, spin};
}

Flown fly(const Body& body, const Motion& lift_off) {
  const auto height = [&](double time) { return flying(body, lift_off, time).y - body.R; };
  const auto rate = [&](double time) { return flying(body, lift_off, time).y_rate; };
  const double slow = std::sqrt(body.g / body.R) + std::sqrt(std::abs(body.turn));
  long looks_left = 100'000;
  Flown flown;
  std::optional<double> landing;
  bool above = false;
  double before = 0.0;  // where the flight was last looked at
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * body.R;
  const auto look = [&](double time, bool at_extremum) {
    const double y = height(time);
    if (y > (above ? 0.0 : rounding)) {
      above = true;
      if (at_extremum && y > flown.height) flown.height = y, flown.apex_time = time;
    } else if (above) {
      landing = bisect(height, before, time);
    } else {
      flown.dip = std::min(flown.dip, y);
    }
    before = time;
  };
  double rate_before = lift_off.y_rate, spin = lift_off.spin, time = 0.0;
  while (!landing) {
    if (--looks_left < 0) return {.failed = true};
    const double from = std::exchange(time, time + 0.01 / (std::abs(spin) + slow));
    const double rate_here = rate(time);
    if ((rate_before > 0.0) != (rate_here > 0.0)) look(bisect(rate, from, time), true);
    if (!landing) look(time, false);
    rate_before = rate_here;
    const Motion here = flying(body, lift_off, time);
    spin = here.spin;
    const double falls = here.y_rate + body.arm() * std::sin(here.phi) * here.spin;
    const double centre_of_mass = here.y - body.arm() * std::cos(here.phi) - body.R;
    if (!above && falls < 0.0 && centre_of_mass < -body.arm()) return {};
  }
  flown.landing_time = *landing;
  return flown;
}

}  // namespace leapmap::referee
