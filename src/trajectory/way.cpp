// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "hoop/flight.hpp"
#include "hoop/rolling.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {
namespace {

/// Where f, which tells its rate, is largest over ascending places; between two of them it has one maximum at
/// most. What is as large as an end but for rounding is the end, which may move.
template <class F>
double place_of_largest(const F& f, const std::vector<double>& places) {
  std::vector<Rated> values;
  for (const double place : places) values.push_back(f(place));
  const bool falls = values.front() > values.back();
  double most = (falls ? values.front() : values.back()).value, best = falls ? places.front() : places.back();
  most += 4.0 * std::numeric_limits<double>::epsilon() * std::abs(most);
  const auto meet = [&](double place, double value) {
    if (value > most) most = value, best = place;
  };
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    meet(places[i], values[i].value);
    const double now = values[i].by[0], then = values[i + 1].by[0];
    if (!(now > 0.0 && then < 0.0)) continue;
    const double top = top_between(f, places[i], places[i + 1], now, then);
    meet(top, f(top).value);
  }
  return best;
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

/// The largest so far, or the last of those that are as large.
template <class S>
void take_larger(S& most, const S& value) {
  if (!(value < most)) most = value;
}

/// Of a roll, at an angle.
template <class S>
S vis_viva_at(const Roll<S>& roll, const S& angle, const Trig<S>& phi) {
  S E = vis_viva(roll, angle, phi);
  if (E < S(0.0)) E -= S(value_of(E));  // a rounding; its rate is none
  return E;
}
template <class S>
S force_at(const Roll<S>& roll, const S& angle) {
  const Trig<S> phi = trig(angle);
  const LiftTerms<S> terms = lift_terms(roll.hoop, phi);
  return (terms.P * terms.J + roll.hoop.rho * terms.K * vis_viva_at(roll, angle, phi)) / (terms.J * terms.J);
}
template <class S>
S spin_squared_at(const Roll<S>& roll, const S& angle) {
  const Trig<S> phi = trig(angle);
  return vis_viva_at(roll, angle, phi) / contact_inertia(roll.hoop, phi);
}

/// Where a roll turns round, which is known in plain numbers.
template <class S>
S turn_at(const Roll<S>& roll, double angle) {
  if constexpr (has_derivatives<S>)
    return with_derivatives(angle, vis_viva_past_release(roll, S(S(angle) - roll.release)),
                            2.0 * torque(plain(roll).hoop, trig(angle)));
  else
    return angle;
}

/// What has a kink where `number` is zero, and is zero there.
template <class S>
S kink_at_zero_of(const S& number) {
  S kink(0.0);
  if constexpr (has_derivatives<S>)
    for (std::size_t k = 0; k < kink.by.size(); ++k)
      if (number.by[k] != 0.0) kink.by[k] = std::numeric_limits<double>::quiet_NaN();
  return kink;
}

}  // namespace

template <class S>
WayMeter<S>::WayMeter(const Hoop<S>& hoop, const S& spin) : hoop_(hoop), turns_on_(any_aloft(hoop)) {
  meet_spin(spin);
}

template <class S>
void WayMeter<S>::meet_spin(const S& spin) {
  take_larger(way_.spin, S(abs(spin)));
  take_larger(way_.power, hoop_.motor() == S(0.0) ? kink_at_zero_of(hoop_.motor()) : hoop_.motor() * spin);
}

template <class S>
void WayMeter<S>::roll(const Roll<S>& roll, const S& spin, std::span<const double> turns, const S& to) {
  S from = roll.release, begins = spin;
  for (const double turn : turns) {
    const S there = turn_at(roll, turn);
    roll_on(roll, from, begins, there);
    from = there, begins = S(0.0);
  }
  roll_on(roll, from, begins, to);
}

/// Without turning round. spin: at the start, of which it has the derivatives from rest, too.
template <class S>
void WayMeter<S>::roll_on(const Roll<S>& roll, const S& from, const S& spin, const S& to) {
  if (from == to) return;
  const auto known = widened<Rated>(plain(roll));
  const bool ahead = from < to;
  const double first = value_of(from), last = value_of(to);
  const std::vector<double> places = looks(plain(roll).hoop, std::min(first, last), std::max(first, last));
  const auto place_of = [&](double sign, const auto& f) {
    return place_of_largest([&](double at) { return Rated(sign) * f(known, Rated::parameter(at, 0)); },
                            places);
  };
  const auto angle_at = [&](double place) { return place == first ? from : place == last ? to : S(place); };
  const S way(ahead ? 1.0 : -1.0);
  const auto spin_at = [&](double place) {
    if (place == first) return spin;
    const S square = spin_squared_at(roll, angle_at(place));
    return square > S(0.0) ? way * sqrt(square) : S(0.0);
  };
  take_larger(way_.normal_force, force_at(roll, angle_at(place_of(1.0, force_at<Rated>))));
  meet_spin(spin_at(place_of(1.0, spin_squared_at<Rated>)));
  if (hoop_.motor() * way < S(0.0))  // it brakes, the least where the hoop is slowest
    meet_spin(spin_at(place_of(-1.0, spin_squared_at<Rated>)));
  turn(to - from);
}

template <class S>
void WayMeter<S>::meet(const ForceAndSpin<S>& at) {
  take_larger(way_.normal_force, at.normal_force);
  meet_spin(at.spin);
}

template <class S>
void WayMeter<S>::slide(const std::function<ForceAndSpin<Rated>(double)>& known,
                        const std::function<ForceAndSpin<S>(double)>& at) {
  constexpr int pieces = 24;
  std::vector<double> places;
  for (int k = 0; k <= pieces; ++k) places.push_back(static_cast<double>(k) / pieces);
  const auto meet_largest = [&](const auto& f) { meet(at(place_of_largest(f, places))); };
  meet_largest([&](double place) { return known(place).normal_force; });
  for (const double way : {-1.0, 1.0})
    meet_largest([&](double place) { return Rated(way) * known(place).spin; });
}

template <class S>
void WayMeter<S>::fly(const S& spin, const S& time) {
  take_larger(way_.spin, S(abs(spin)));
  if (!turns_on_) return;
  meet_spin(spin), meet_spin(spin + hoop_.aloft * time);
  turn(turned_in_flight(hoop_, spin, time).value);
}

#ifdef LEAPMAP_KERNELS
template class WayMeter<double>;
template class WayMeter<RollingDual>;
template class WayMeter<DesignDual>;
#endif

}  // namespace leapmap
