// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/flight.hpp"
#include "physics/rolling.hpp"

namespace leapmap {
namespace {

/// The largest of f between two places, where it has one maximum, by golden section: so near it that its
/// square is rounding.
template <class F>
double largest_near(const F& f, double from, double to) {
  constexpr double golden = 0.6180339887498949;
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(from), std::abs(to));
  const double close = std::max(1e-8 * (to - from), rounding);
  double a = from, b = to, c = b - golden * (b - a), d = a + golden * (b - a), at_c = f(c), at_d = f(d);
  while (b - a > close) {
    if (at_c > at_d)
      b = d, d = c, at_d = at_c, c = b - golden * (b - a), at_c = f(c);
    else
      a = c, c = d, at_c = at_d, d = a + golden * (b - a), at_d = f(d);
  }
  return std::max(at_c, at_d);
}

/// The largest of f over ascending places; between two of them it has one maximum at most.
template <class F>
double largest(const F& f, const std::vector<double>& places) {
  std::vector<double> values;
  for (const double place : places) values.push_back(f(place));
  double most = *std::max_element(values.begin(), values.end());
  for (std::size_t i = 0; i < values.size(); ++i) {  // the maximum may lie beside an end, too
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, values.size() - 1);
    const double rise = values[i] - std::min(values[before], values[after]);
    if (values[i] < values[before] || values[i] < values[after] || values[i] + rise < most) continue;
    most = std::max(most, largest_near(f, places[before], places[after]));
  }
  return most;
}

/// Angles from one to another, close where the weight is at the plane: there the contact's inertia is least,
/// and forces and spins of a heavy weight on the rim have their peaks.
std::vector<double> looks(const Hoop<double>& hoop, double from, double to) {
  constexpr double pi = std::numbers::pi, step = 0.15;
  const double width = std::clamp(std::sqrt(hoop.J_min / std::max(hoop.rho, 1e-300)), 1e-9, 1.0);
  const double last = std::asinh(pi / width);
  const int half = static_cast<int>(std::ceil(last / step));
  std::vector<double> places{from};
  for (double turn = std::floor((from + pi) / (2.0 * pi)); 2.0 * pi * turn - pi < to; ++turn)
    for (int k = -half; k < half; ++k)
      if (const double angle = 2.0 * pi * turn + width * std::sinh(last * k / half);
          angle > from && angle < to)
        places.push_back(angle);
  places.push_back(to);
  // The ends may lie far from their neighbours.
  constexpr int more = 4;
  for (const double end : {places[1], places[places.size() - 2]})
    for (int k = 1; k < more; ++k) {
      const double start = end == places[1] ? from : to;
      places.push_back(start + (end - start) * k / more);
    }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace

void WayMeter::meet_spin(double spin) {
  way_.spin = std::max(way_.spin, std::abs(spin));
  way_.power = std::max(way_.power, hoop_.drive == 0.0 ? 0.0 : hoop_.drive * spin);
}

void WayMeter::roll(const Roll<double>& roll, double from, double to) {
  if (from == to) return;
  const auto square = [&](double angle) {
    const Trig<double> phi = trig(angle);
    return std::max(vis_viva(roll, angle, phi), 0.0) / contact_inertia(hoop_, phi);
  };
  const auto force = [&](double angle) {
    const double spin = std::sqrt(square(angle));
    const Trig<double> phi = trig(angle);
    return normal_force(hoop_, phi, spin, angular_acceleration(hoop_, phi, spin));
  };
  const std::vector<double> places = looks(hoop_, std::min(from, to), std::max(from, to));
  way_.normal_force = std::max(way_.normal_force, largest(force, places));
  const double way = to > from ? 1.0 : -1.0;
  meet_spin(way * std::sqrt(largest(square, places)));
  if (hoop_.drive * way < 0.0)  // it brakes, the least where the hoop is slowest
    meet_spin(way * std::sqrt(std::max(0.0, -largest([&](double angle) { return -square(angle); }, places))));
  turn(to - from);
}

void WayMeter::slide(const std::function<Sliding(double)>& at) {
  constexpr int pieces = 24;
  std::vector<double> places;
  for (int k = 0; k <= pieces; ++k) places.push_back(static_cast<double>(k) / pieces);
  way_.normal_force =
      std::max(way_.normal_force, largest([&](double place) { return at(place).normal_force; }, places));
  for (const double way : {-1.0, 1.0})
    meet_spin(way * largest([&](double place) { return way * at(place).spin; }, places));
}

void WayMeter::fly(double spin, double time) {
  way_.spin = std::max(way_.spin, std::abs(spin));
  if (hoop_.aloft == 0.0) return;
  meet_spin(spin), meet_spin(spin + hoop_.aloft * time);
  turn(turned_in_flight(hoop_, spin, time).value);
}

}  // namespace leapmap
