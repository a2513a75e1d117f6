// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/flight.hpp"
#include "trajectory/units.hpp"

namespace leapmap {
namespace {

constexpr double finest_step = 0.2;  // of the hoop's angle, or of time: y has at most one turn in it
constexpr int looks = 4;             // within a piece of the flight
constexpr double most_pieces = 1e5;

/// The circle of radius 1 about (x, 1 + y) in flight, and a wall's height. Times in sqrt(R/g), lengths in R.
struct Passage {
  Hoop<double> hoop;
  Trig<double> phi;  ///< at lift-off
  double spin, slip, normal, wall;
  double way;  ///< -1: it flies uphill, and is seen from behind

  double height(double t) const { return height_above_plane(hoop, phi, spin, t, normal).value; }
  /// The fastest turn until then.
  double fastest(double t) const {
    return std::max(std::abs(spin), std::abs(spin + hoop.aloft * t)) + std::sqrt(std::abs(hoop.aloft));
  }
  double climb(double t) const { return height_above_plane(hoop, phi, spin, t, normal).rate; }

  /// How far ahead of the lift-off the circle reaches at the wall's height or below: of a wall ahead (side 1)
  /// or behind (-1), which it just touches.
  double reach(double t, double side) const {
    const double above = std::max(0.0, 1.0 + height(t) - wall);
    return way * travel_in_flight(hoop, phi, spin, slip, t).value +
           side * std::sqrt(std::max(0.0, (1.0 - above) * (1.0 + above)));
  }
};

template <class F>
double bisect(const F& is_past, double from, double to) {
  for (double middle = 0.5 * (from + to); from < middle && middle < to; middle = 0.5 * (from + to))
    (is_past(middle) ? to : from) = middle;
  return to;
}

/// The largest of side * reach between two times, by golden section: it has one maximum there.
double largest(const Passage& passage, double side, double from, double to) {
  constexpr double golden = 0.6180339887498949;
  const auto value = [&](double t) { return side * passage.reach(t, side); };
  double a = from, b = to, c = b - golden * (b - a), d = a + golden * (b - a), at_c = value(c),
         at_d = value(d);
  while (b - a > 1e-9 * (to + finest_step)) {  // flat at the top: its square is rounding
    if (at_c > at_d) {
      b = d, d = c, at_d = at_c, c = b - golden * (b - a), at_c = value(c);
    } else {
      a = c, c = d, at_c = at_d, d = a + golden * (b - a), at_d = value(d);
    }
  }
  return std::max({at_c, at_d, value(from), value(to)});
}

/// The largest of side * reach over [from, to], in which y is monotone, as far as the hoop is lower there
/// than the wall; what is not above `known` need not be found.
double largest_in_piece(const Passage& passage, double side, double from, double to, double known) {
  const auto is_low = [&](double t) { return passage.height(t) < passage.wall; };
  const bool low_first = is_low(from), low_last = is_low(to);
  if (!low_first && !low_last) return known;
  if (low_first != low_last) {
    const double edge = bisect([&](double t) { return is_low(t) == low_last; }, from, to);
    (low_first ? to : from) = edge;
  }
  const double step = (to - from) / looks;
  double most = -HUGE_VAL, at = from;
  for (int k = 0; k <= looks; ++k)
    if (const double seen = side * passage.reach(from + step * k, side); seen > most)
      most = seen, at = from + step * k;
  constexpr double between = 0.05;  // what lies between two looks adds less than that
  if (!(most > known - between)) return known;
  return std::max(known, largest(passage, side, std::max(from, at - step), std::min(to, at + step)));
}

/// The largest of side * reach over [from, to] as far as the hoop is lower there than the wall; infinite:
/// that takes too many pieces.
double largest_below(const Passage& passage, double side, double from, double to) {
  const double pieces = std::ceil((to - from) * (1.0 + passage.fastest(to)) / finest_step);
  if (!(pieces < most_pieces)) return HUGE_VAL;
  double most = -HUGE_VAL;
  for (double k = 0.0; k < pieces; ++k) {
    const double a = from + (to - from) * k / pieces, b = from + (to - from) * (k + 1.0) / pieces;
    const bool rises = passage.climb(a) > 0.0;
    double turn = b;
    if (rises != (passage.climb(b) > 0.0))
      turn = bisect([&](double t) { return (passage.climb(t) > 0.0) != rises; }, a, b);
    most = largest_in_piece(passage, side, a, turn, most);
    if (turn < b) most = largest_in_piece(passage, side, turn, b, most);
  }
  return most;
}

/// The times between which the centre of mass is so high that the hoop is above the wall at any angle; none:
/// equal.
std::pair<double, double> surely_above(const Passage& passage) {
  const double climb = passage.normal + passage.hoop.rho * passage.spin * passage.phi.sin;
  const double low = passage.wall + passage.hoop.rho * (1.0 + passage.phi.cos);
  const double root = climb * climb - 2.0 * passage.hoop.cos_slope * low;
  if (!(root > 0.0) || !(climb > 0.0)) return {0.0, 0.0};
  return {2.0 * low / (climb + std::sqrt(root)), (climb + std::sqrt(root)) / passage.hoop.cos_slope};
}

void find_clearance(const Scene& scene, const Design& design, Outcome& outcome) {
  const double second = time_unit(scene), apex = outcome.apex_time / second,
               end = outcome.flight_time / second;
  Passage passage{.hoop = reduce<double>(design, scene),
                  .phi = trig(outcome.jump_angle),
                  .spin = outcome.jump_spin,
                  .slip = 0.0,
                  .normal = 0.0,
                  .wall = 2.0 * scene.clear_height,
                  .way = outcome.jump_range < 0.0 ? -1.0 : 1.0};
  // How the contact point leaves the plane follows from how it comes back.
  passage.normal = -outcome.landing_normal_speed - passage.climb(end);
  passage.slip =
      (outcome.jump_range - travel_in_flight(passage.hoop, passage.phi, passage.spin, 0.0, end).value) / end;
  if (!(2.0 * outcome.jump_height > passage.wall)) return;
  auto [above, below] = surely_above(passage);
  if (!(above < below)) above = below = apex;
  const double from = largest_below(passage, 1.0, 0.0, std::min(above, apex)),
               to = -largest_below(passage, -1.0, std::max(below, apex), end);
  if (!(from <= to)) return;
  outcome.clears_from = passage.way < 0.0 ? -to : from;
  outcome.clears_to = passage.way < 0.0 ? -from : to;
}

}  // namespace

void find_clearances(const Scene& scene, std::span<const Design> designs, std::span<Outcome> outcomes) {
  for (std::size_t i = 0; i < designs.size(); ++i)
    if (outcomes[i].status == Status::jumped) find_clearance(scene, designs[i], outcomes[i]);
}

}  // namespace leapmap
