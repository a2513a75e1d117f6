// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "hoop/flight.hpp"
#include "hoop/units.hpp"
#include "numerics/maximum.hpp"

namespace leapmap {
namespace {

constexpr double finest_step = 0.2;  // of the hoop's angle, or of time: y has at most one turn in it
constexpr int looks = 4;             // within a piece of the flight
constexpr double most_pieces = 1e5;

/// The circle of radius 1 about (x, 1 + y) in flight, and a wall's height. Times in sqrt(R/g), lengths in R.
template <class S>
struct Passage {
  Hoop<S> hoop;
  Trig<S> phi;  ///< at lift-off
  S spin, slip, normal;
  double wall;
  double way;  ///< -1: it flies uphill, and is seen from behind

  S height(const S& t) const { return height_above_plane(hoop, phi, spin, t, normal).value; }
  S climb(const S& t) const { return height_above_plane(hoop, phi, spin, t, normal).rate; }
  /// The fastest turn until then.
  double fastest(double t) const {
    return std::max(std::abs(spin), std::abs(spin + hoop.aloft * t)) + std::sqrt(std::abs(hoop.aloft));
  }

  /// How far ahead of the lift-off the circle reaches at the wall's height or below: of a wall ahead (side 1)
  /// or behind (-1), which it just touches.
  S reach(const S& t, double side) const {
    using std::sqrt;
    const S over = S(1.0 - wall) + height(t), above = over > S(0.0) ? over : S(0.0);
    S square = (S(1.0) - above) * (S(1.0) + above);  // of half a chord, whose rate is infinite where it ends
    if (square < S(0.0)) square -= S(value_of(square));
    return S(way) * travel_in_flight(hoop, phi, spin, slip, t).value + S(side) * sqrt(square);
  }
};

/// A value, and when it is reached.
struct Extreme {
  double value, time;
};

template <class F>
double bisect(const F& is_past, double from, double to) {
  for (double middle = 0.5 * (from + to); from < middle && middle < to; middle = 0.5 * (from + to))
    (is_past(middle) ? to : from) = middle;
  return to;
}

/// The largest of side * reach between two times: it has one maximum there.
Extreme largest(const Passage<double>& passage, double side, double from, double to) {
  const Passage<Rated> rated{mapped<Rated>(passage.hoop, [](double number) { return Rated(number); }),
                             {Rated(passage.phi.sin), Rated(passage.phi.cos), Rated(passage.phi.versine)},
                             Rated(passage.spin),
                             Rated(passage.slip),
                             Rated(passage.normal),
                             passage.wall,
                             passage.way};
  const auto value = [&](double t) { return Rated(side) * rated.reach(Rated::parameter(t, 0), side); };
  const Rated first = value(from), last = value(to);
  Extreme most = first > last ? Extreme{first.value, from} : Extreme{last.value, to};
  if (!(first.by[0] > 0.0 && last.by[0] < 0.0)) return most;
  const double top = top_between(value, from, to, first.by[0], last.by[0]);
  if (const double there = value(top).value; there > most.value) most = {there, top};
  return most;
}

/// The largest of side * reach over [from, to], in which y is monotone, as far as the hoop is lower there
/// than the wall; what is not above `known` need not be found.
Extreme largest_in_piece(const Passage<double>& passage, double side, double from, double to,
                         const Extreme& known) {
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
  if (!(most > known.value - between)) return known;
  const Extreme found = largest(passage, side, std::max(from, at - step), std::min(to, at + step));
  return found.value > known.value ? found : known;
}

/// The largest of side * reach over [from, to] as far as the hoop is lower there than the wall; infinite:
/// that takes too many pieces.
Extreme largest_below(const Passage<double>& passage, double side, double from, double to) {
  const double pieces = std::ceil((to - from) * (1.0 + passage.fastest(to)) / finest_step);
  if (!(pieces < most_pieces)) return {HUGE_VAL, from};
  Extreme most{-HUGE_VAL, from};
  for (double k = 0.0; k < pieces; ++k) {
    const double a = from + (to - from) * k / pieces,
                 b = k + 1.0 < pieces ? from + (to - from) * (k + 1.0) / pieces : to;  // to the last digit
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
std::pair<double, double> surely_above(const Passage<double>& passage) {
  const double climb = passage.normal + passage.hoop.rho * passage.spin * passage.phi.sin;
  const double low = passage.wall + passage.hoop.rho * (1.0 + passage.phi.cos);
  const double root = climb * climb - 2.0 * passage.hoop.cos_slope * low;
  if (!(root > 0.0) || !(climb > 0.0)) return {0.0, 0.0};
  return {2.0 * low / (climb + std::sqrt(root)), (climb + std::sqrt(root)) / passage.hoop.cos_slope};
}

/// What a clearance follows from, of an outcome.
template <class S>
struct Flown {
  S angle, spin, time, range, landing_speed;  ///< time: of the flight [sqrt(R/g)]
};
constexpr std::array flown_numbers{&Outcome::jump_angle, &Outcome::jump_spin, &Outcome::flight_time,
                                   &Outcome::jump_range, &Outcome::landing_normal_speed};

/// Reads each by number(member, unit).
template <class S, class Number>
Flown<S> flown_by(double second, const Number& number) {
  return {number(&Outcome::jump_angle, 1.0), number(&Outcome::jump_spin, 1.0),
          number(&Outcome::flight_time, 1.0 / second), number(&Outcome::jump_range, 1.0),
          number(&Outcome::landing_normal_speed, 1.0)};
}

template <class S>
Passage<S> passage_of(const Hoop<S>& hoop, const Flown<S>& flown, double wall) {
  Passage<S> passage{.hoop = hoop,
                     .phi = trig(flown.angle),
                     .spin = flown.spin,
                     .slip = S(0.0),
                     .normal = S(0.0),
                     .wall = wall,
                     .way = flown.range < S(0.0) ? -1.0 : 1.0};
  // How the contact point leaves the plane follows from how it comes back.
  passage.normal = -flown.landing_speed - passage.climb(flown.time);
  passage.slip =
      (flown.range - travel_in_flight(hoop, passage.phi, flown.spin, S(0.0), flown.time).value) / flown.time;
  return passage;
}

/// Where walls may stand along the way, and when the hoop passes them: ahead of its apex and behind.
struct Clearance {
  Extreme from, to;
};
std::optional<Clearance> find_clearance(const Passage<double>& passage, double apex, double end) {
  auto [above, below] = surely_above(passage);
  if (!(above < below)) above = below = apex;
  const Extreme from = largest_below(passage, 1.0, 0.0, std::min(above, apex));
  Extreme to = largest_below(passage, -1.0, std::max(below, apex), end);
  to.value = -to.value;
  if (!(from.value <= to.value)) return {};
  return Clearance{from, to};
}

/// The derivatives by the parameters asked for, of what is differentiated at hand: a maximum depends on when
/// it is reached to second order only.
void differentiate(const Scene& scene, const Design& design, std::size_t place, const Outcome& outcome,
                   const Clearance& found, const Gradients& flights, Gradients& gradients) {
  const auto number = [&](double Outcome::*member, double unit) {
    DesignDual dual(outcome.*member * unit);
    for (const std::size_t by : flights.wanted().by)
      dual.by[by] = flights.column(member, differentiable[by])[place] * unit;
    return dual;
  };
  const Flown<DesignDual> flown = flown_by<DesignDual>(time_unit(scene), number);
  const Passage<DesignDual> passage = passage_of(reduce(dual_parameters<DesignDual>(design), scene), flown,
                                                 wall_in_radii(scene, design.size));
  const auto reach = [&](const Extreme& at, double side) {
    const bool lands = at.time == flown.time.value;
    return DesignDual(passage.way) * passage.reach(lands ? flown.time : DesignDual(at.time), side);
  };
  const bool back = passage.way < 0.0;
  gradients.put(back ? &Outcome::clears_to : &Outcome::clears_from, place, reach(found.from, 1.0));
  gradients.put(back ? &Outcome::clears_from : &Outcome::clears_to, place, reach(found.to, -1.0));
}

}  // namespace

std::span<double Outcome::*const> numbers_of_flights() { return flown_numbers; }

void find_clearances(const Scene& scene, std::span<const Design> designs, std::span<Outcome> outcomes,
                     const Gradients& flights, Gradients* gradients) {
  const double second = time_unit(scene);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    Outcome& outcome = outcomes[i];
    const double wall = wall_in_radii(scene, designs[i].size);
    if (outcome.status != Status::jumped || !(2.0 * outcome.jump_height > wall)) continue;
    const auto flown = flown_by<double>(
        second, [&](double Outcome::*member, double unit) { return outcome.*member * unit; });
    const Passage<double> passage = passage_of(reduce<double>(designs[i], scene), flown, wall);
    const auto found = find_clearance(passage, outcome.apex_time / second, flown.time);
    if (!found) continue;
    const bool back = passage.way < 0.0;
    outcome.clears_from = back ? -found->to.value : found->from.value;
    outcome.clears_to = back ? -found->from.value : found->to.value;
    if (gradients) differentiate(scene, designs[i], i, outcome, *found, flights, *gradients);
  }
}

}  // namespace leapmap
