// SPDX-License-Identifier: GPL-3.0-or-later
/// The apex, the dip and the landing of a flight. No root can be missed: the zeros of y'' are known in closed form,
/// between two of them y' is monotone, and between two zeros of y' so is y. The lift-off itself (a double root of y,
/// a triple one after sliding) is where the search starts and is never looked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/flight.hpp"

namespace leapmap {

/// Height, apex, landing and dip of a toss: psi in place of times, heights of rho in place of diameters.
///
/// For one toss that may rise and sink many times. Its walk goes from zero of y'' to zero of y''; of a fast spin's
/// thousands of turns it leaps over those that can hold neither apex nor landing.
template <class S>
Flight<S> walk_toss(const Toss<S>& toss) {
  using std::acos, std::floor, std::sqrt;
  const S two_pi = S(2) * std::numbers::pi_v<S>;
  const S opening = acos(-toss.gravity);  // y'' > 0 for phi + psi in (opening, 2 pi - opening), modulo 2 pi
  const S last = toss_end(toss), resolution = S(2) * std::numeric_limits<S>::epsilon();
  const auto height_at = [&](const S& psi) { return toss_height(toss, psi); };
  const auto climb_at = [&](const S& psi) { return toss_climb(toss, psi); };

  Flight<S> flight;
  bool above = false;
  // y is monotone between from and to; true once the flight has ended.
  const auto segment = [&](const S& from, const S& to) {
    const S y_to = height_at(to).value;
    above = above || y_to > S(0);
    if (above && y_to > flight.height) flight.height = y_to, flight.apex_time = to;
    if (!above) flight.dip = std::min(flight.dip, y_to);
    if (!above || y_to > S(0)) return false;
    flight.flight_time = polish_root(height_at, from, to, from, false, resolution * to);
    return true;
  };

  // With y between L(psi) = psi sin(phi) - gamma psi^2 / 2 - (1 + cos phi) and L + 2, no landing is possible while
  // L > 0, and no apex farther than 2 / sqrt(gamma) from the vertex of L.
  const S s = toss.phi.sin, vertex = s / toss.gravity, around = S(2) / sqrt(toss.gravity);
  const S clearance = s * s - S(2) * toss.gravity * (S(1) + toss.phi.cos);
  const S half_width = clearance > S(0) ? sqrt(clearance) / toss.gravity : S(0);  // of L > 0, about the vertex
  const auto next_of_interest = [&](const S& psi) {
    if (!above || !(psi > vertex - half_width) || !(psi < vertex + half_width)) return psi;
    if (psi < vertex - around) return vertex - around;
    return psi > vertex + around ? vertex + half_width : psi;
  };

  // The angles at which y'' changes sign follow each other as opening, 2 pi - opening, 2 pi + opening, ...
  const auto knot_at = [&](long knot) {
    return two_pi * S((knot + 1) / 2) + (knot % 2 == 0 ? opening : -opening) - toss.angle;
  };
  S start(0), climb_start(0);
  for (long knot = 0; start <= last; ++knot) {
    const S end = knot_at(knot);
    if (end <= start) continue;
    const long leap = 2 * static_cast<long>(floor((toss.angle + next_of_interest(start)) / two_pi)) - 1;
    if (leap > knot) {
      start = knot_at(leap);
      climb_start = climb_at(start).value;
      knot = leap;
      continue;
    }
    const S climb_end = climb_at(end).value;
    if ((climb_start > S(0) && climb_end < S(0)) || (climb_start < S(0) && climb_end > S(0))) {
      const S extremum = polish_root(climb_at, start, end, start + (end - start) * S(0.5), climb_end > S(0),
                                     resolution * end);
      if (segment(start, extremum) || segment(extremum, end)) return flight;
    } else if (segment(start, end)) {
      return flight;
    }
    start = end;
    climb_start = climb_end;
  }
  return {};
}

/// A toss that climbs at most once, lane by lane; `wanted` is narrowed to the lanes that do climb.
///
/// From one turn to the next y' loses 2 pi gamma, so that a toss whose y' stays below that at its first maximum has one
/// climb: one apex, at most one dip before it, and it sinks for ever after. Between the zeros of y'' its y' is near a
/// sine, which gives the guesses.
template <class T>
Flight<T> climb_once(const Toss<T>& toss, const T& opening, const T& turn, MaskOf<T>& wanted) {
  using std::sqrt;
  const T pi(std::numbers::pi_v<ScalarOf<T>>), epsilon(std::numeric_limits<ScalarOf<T>>::epsilon());
  const T gamma = toss.gravity, s = toss.phi.sin;
  const auto height_at = [&](const T& psi) { return toss_height(toss, psi); };
  const auto climb_at = [&](const T& psi) { return toss_climb(toss, psi); };
  const MaskOf<T> never = wanted & !wanted;

  // Apex: sin(eta) + gamma eta = ..., eta = phi + psi - 2 pi (turn + 1) in (-opening, opening).
  const T top = T(2) * pi * (turn + T(1)) - toss.angle;
  const T eta = (s - gamma * top) / (T(1) + gamma);
  const T apex = polish_root(climb_at, top - opening, top + opening, top + eta + eta * eta * eta / (T(6) * (T(1) + gamma)),
                             never, T(2) * epsilon * top, wanted);
  const CurvedSample<T> at_apex = height_at(apex);
  wanted = wanted & (at_apex.value > T(0));

  // Dip: it starts where y'' < 0 and ends on the way up, gamma eta - sin(eta) = ..., eta = phi + psi - pi (2 turn + 1).
  const T bottom = top - pi;
  const T first_knot = bottom - (pi - opening);
  const MaskOf<T> dips = wanted & (first_knot > T(0));
  T dip(0);
  if (any(dips)) {
    const T guess = (gamma * bottom - s) / (T(1) - gamma);
    const T lowest = polish_root(climb_at, first_knot, top - opening, bottom + guess + guess * guess * guess / (T(6) * (T(1) - gamma)),
                                 !never, T(2) * epsilon * top, dips);
    dip = select(dips, smaller(height_at(lowest).value, T(0)), T(0));
  }

  const T fall = sqrt(T(-2) * at_apex.value / at_apex.curvature);
  const T landing = polish_root(height_at, apex, T(1.001) * larger(toss_end(toss), apex), apex + fall, never,
                                T(2) * epsilon * top, wanted);
  return {select(wanted, at_apex.value, T(0)), select(wanted, apex, T(0)), select(wanted, landing, T(0)),
          select(wanted, dip, T(0))};
}

/// The whole flight that starts at lift_off; on SIMD lanes only those in `wanted` are searched, the others are zero.
template <class T>
Flight<T> fly(const Hoop<T>& hoop, const LiftOff<T>& lift_off, MaskOf<T> wanted = MaskOf<T>(true)) {
  using std::abs, std::acos, std::floor, std::sqrt;
  using S = ScalarOf<T>;
  const T pi(std::numbers::pi_v<S>), two_pi = T(2) * pi;
  // y depends on phi and w only through cos(phi + w t) and sin(phi) w: turning backwards is the mirror image.
  const T angle = select(lift_off.spin < T(0), -lift_off.angle, lift_off.angle), spin = abs(lift_off.spin);
  const T gamma = hoop.cos_slope / (hoop.rho * spin * spin);
  const Toss<T> toss{angle - two_pi * floor(angle / two_pi), trig(angle), gamma};

  wanted = wanted & (gamma < T(1));  // otherwise gravity wins from the start
  const T opening = acos(select(wanted, -gamma, T(0)));
  // The first knot at which y' has a maximum, in this turn of phi or the next.
  const T turn = select(toss.angle > two_pi - opening, T(1), T(0));
  const T first_top = two_pi * (turn + T(1)) - opening - toss.angle;
  const T fastest = toss.phi.sin + sqrt(select(wanted, T(1) - gamma * gamma, T(0))) - gamma * first_top;
  wanted = wanted & (fastest > T(0));
  const MaskOf<T> several = wanted & (fastest > two_pi * gamma);

  MaskOf<T> once = wanted & !several;
  Flight<T> flight = climb_once(toss, opening, turn, once);
  if (any(several)) {
    constexpr std::size_t count = Lanes<T>::count;
    const auto lane_of = [](const T& value) {
      std::array<S, count> lanes;
      Lanes<T>::store(value, lanes.data());
      return lanes;
    };
    const auto a = lane_of(toss.angle), s = lane_of(toss.phi.sin), c = lane_of(toss.phi.cos), v = lane_of(toss.phi.versine),
               g = lane_of(gamma);
    auto height = lane_of(flight.height), apex = lane_of(flight.apex_time), landing = lane_of(flight.flight_time),
         dip = lane_of(flight.dip);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(Lanes<T>::bits(several) >> i & 1u)) continue;
      const Flight<S> one = walk_toss(Toss<S>{a[i], {s[i], c[i], v[i]}, g[i]});
      height[i] = one.height, apex[i] = one.apex_time, landing[i] = one.flight_time, dip[i] = one.dip;
    }
    flight = {Lanes<T>::load(height.data()), Lanes<T>::load(apex.data()), Lanes<T>::load(landing.data()),
              Lanes<T>::load(dip.data())};
  }
  const T diameters = T(0.5) * hoop.rho, unit = T(1) / select(spin > T(0), spin, T(1));
  return {flight.height * diameters, flight.apex_time * unit, flight.flight_time * unit, flight.dip * diameters};
}

}  // namespace leapmap
