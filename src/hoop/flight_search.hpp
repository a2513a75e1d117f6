// SPDX-License-Identifier: GPL-3.0-or-later
/// The apex, the dip and the landing of a flight. No root can be missed: the zeros of y'' are known in closed
/// form, between two of them y' is monotone, and between two zeros of y' so is y. The lift-off itself (a
/// double root of y, a triple one after sliding) is where the search starts and is never looked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hoop/driven_flight.hpp"

namespace leapmap {

/// Where a high toss can neither land nor have its highest apex. With y between L(psi) = psi sin(phi) - gamma
/// psi^2 / 2 - (1 + cos phi) and L + 2, no landing is possible while L > 0. And y less its parabola repeats
/// every turn, so that the highest apex is at most half a turn from the vertex.
template <class S>
struct TossLeaps {
  S vertex;
  S half_width;  ///< of L > 0, about the vertex

  TossLeaps(const Toss<S>& toss, const S& launch) {
    using std::sqrt;
    const S s = toss.phi.sin + launch;
    const S clearance = s * s - S(2) * toss.gravity * (S(1) + toss.phi.cos);
    vertex = s / toss.gravity;
    half_width = clearance > S(0) ? sqrt(clearance) / toss.gravity : S(0);
  }

  /// From psi on the next place to look at, of a hoop that is above the plane.
  S next_of_interest(const S& psi) const {
    const S around = S(2) * std::numbers::pi_v<S>;
    if (!(psi > vertex - half_width) || !(psi < vertex + half_width)) return psi;
    if (psi < vertex - around) return vertex - around;
    return psi > vertex + around ? vertex + half_width : psi;
  }
};

/// Height, apex, landing and dip of a toss: psi in place of times, heights of rho in place of diameters.
///
/// For one toss that rises and sinks many times. The walk goes from zero of y'' to zero of y''; of a fast
/// spin's thousands of turns it leaps over those that can hold neither apex nor landing. launch: y' / rho at
/// the start, v_n / (rho w) of a rebound.
template <class S>
Flight<S> walk_toss(const Toss<S>& toss, const S& launch = S(0)) {
  using std::floor;
  const S pi = std::numbers::pi_v<S>, two_pi = S(2) * pi;
  const S resolution = S(2) * std::numeric_limits<S>::epsilon();
  const auto height_at = [&](const S& psi) {
    CurvedSample<S> y = toss_height(toss, psi);
    y.value += launch * psi, y.rate += launch;
    return y;
  };
  const auto climb_at = [&](const S& psi) {
    CurvedSample<S> climb = toss_climb(toss, psi);
    climb.value += launch;
    return climb;
  };

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

  const TossLeaps<S> leaps(toss, launch);
  const S last = toss_end(toss, launch);
  // The zeros of y'': odd knots are the maxima of y', even ones its minima.
  const auto knot_at = [&](long knot) {
    return toss.top + two_pi * S(knot / 2) - (knot % 2 == 0 ? S(2) * (pi - toss.opening) : S(0));
  };
  S start(0), climb_start = launch;
  for (long knot = 0; start <= last; ++knot) {
    // y(psi + 2 pi) - y(psi) = 2 pi (s - gamma (psi + pi)): from half a turn before the vertex on, every turn
    // lies below the one before, so that a hoop that was not above the plane in one of them never is.
    if (!above && start > std::max(leaps.vertex, S(0)) + two_pi) return {};
    const S end = knot_at(knot);
    if (end <= start) continue;
    const S next = above ? leaps.next_of_interest(start) : start;
    const long leap = 2 * static_cast<long>(floor((next - toss.top) / two_pi)) + 1;
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

/// More climbs than this are left to walk_toss.
inline constexpr int most_climbs = 6;

/// A toss up to its apex, in psi and heights of rho, and where to look for its landing: it is between
/// last_apex and sunk, where y only falls; of one that climbs often it is `sunk` itself. Height zero: it
/// never clears the plane.
template <class T>
struct Ascent {
  T height = T(0), apex = T(0), last_apex = T(0), sunk = T(0), dip = T(0);
};

namespace toss_detail {

/// The zero of y' after its minimum at top - 2 (pi - opening), where y has a minimum. There
/// gamma eta - sin(eta) is known, eta the turn past phi + psi = pi: its cubic gives the guess. To more than
/// half of its digits: y there, which is all that is asked of it, is then good to the last.
template <class T>
T bottom(const Toss<T>& toss, const T& top, const MaskOf<T>& wanted) {
  using S = ScalarOf<T>;
  constexpr S half_digits = sizeof(S) > 8 ? S(1e-11L) : S(1e-9L);
  const T pi(std::numbers::pi_v<S>);
  const T valley = top - (pi - toss.opening), slack = T(1) - toss.gravity;
  const T eta = (toss.gravity * valley - toss.phi.sin) / slack;
  return polish_root(
      [&](const T& psi) { return toss_climb(toss, psi); }, larger(valley - (pi - toss.opening), T(0)), top,
      valley + eta + eta * eta * eta / (T(6) * slack), wanted | !wanted, T(half_digits) * top, wanted);
}

/// The zero of y' after its maximum at top, where y has a maximum: likewise, eta the turn past phi + psi = 2
/// pi. resolution: relative.
template <class T>
T crown(const Toss<T>& toss, const T& top, const MaskOf<T>& wanted, ScalarOf<T> resolution) {
  const T middle = top + toss.opening, slack = T(1) + toss.gravity;
  const T eta = (toss.phi.sin - toss.gravity * middle) / slack;
  return polish_root([&](const T& psi) { return toss_climb(toss, psi); }, top, middle + toss.opening,
                     middle + eta + eta * eta * eta / (T(6) * slack), wanted & !wanted,
                     T(resolution) * middle, wanted);
}

/// The same, and y there, for one evaluation less: Halley's step takes a place near the root to its last
/// digits, and Taylor's series y along with it.
template <class T>
struct Crown {
  T at, height;
};
template <class T>
Crown<T> crown_and_height(const Toss<T>& toss, const T& top, const MaskOf<T>& wanted) {
  using S = ScalarOf<T>;
  using std::abs;
  constexpr S epsilon = std::numeric_limits<S>::epsilon();
  const T x = crown(toss, top, wanted, sizeof(S) > 8 ? S(1e-8L) : S(1e-7L));
  const CurvedSample<T> y = toss_height(toss, x);
  const T square = y.curvature * y.curvature;
  const T step = T(-2) * y.rate * y.curvature / (T(2) * square - y.rate * y.jerk), length = abs(step);
  Crown<T> crest{x + step, y.value + step * (y.rate + step * (T(0.5) * y.curvature + step * y.jerk / T(6)))};
  // The step is off by its cube times (jerk / (2 curvature))^2 - y'''' / (6 curvature), where |y''''| <= 1.
  const T off = length * length * length * (T(0.25) * y.jerk * y.jerk + abs(y.curvature) * T(S(1) / S(6)));
  const MaskOf<T> sure = (off <= T(2 * epsilon) * square * x) & (length <= T(1e-4)) & (y.curvature < T(0));
  const MaskOf<T> unsure = wanted & !sure;
  if (any(unsure)) {
    const T at = crown(toss, top, unsure, S(2) * epsilon);
    crest.at = select(unsure, at, crest.at);
    crest.height = select(unsure, toss_height(toss, at).value, crest.height);
  }
  return crest;
}

/// walk_toss lane by lane, for those in `wanted`.
template <class T>
Flight<T> walk(const Toss<T>& toss, const MaskOf<T>& wanted) {
  const auto s = lanes_of(toss.phi.sin), c = lanes_of(toss.phi.cos), v = lanes_of(toss.phi.versine),
             gravity = lanes_of(toss.gravity), swing = lanes_of(toss.swing), opening = lanes_of(toss.opening),
             top = lanes_of(toss.top), fastest = lanes_of(toss.fastest);
  LaneArray<T> height{}, apex{}, landing{}, dip{};
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (!(Lanes<T>::bits(wanted) >> i & 1u)) continue;
    const auto one = walk_toss(
        Toss<ScalarOf<T>>{{s[i], c[i], v[i]}, gravity[i], swing[i], opening[i], top[i], fastest[i]});
    height[i] = one.height, apex[i] = one.apex_time, landing[i] = one.flight_time, dip[i] = one.dip;
  }
  return {Lanes<T>::load(height.data()), Lanes<T>::load(apex.data()), Lanes<T>::load(landing.data()),
          Lanes<T>::load(dip.data())};
}

template <class T>
MaskOf<T> climbs_often(const Toss<T>& toss) {
  return toss.fastest > T(2 * most_climbs * std::numbers::pi_v<ScalarOf<T>>) * toss.gravity;
}

}  // namespace toss_detail

/// The apex of a toss, climb by climb; only lanes in `wanted` are searched, the others have height zero.
template <class T>
Ascent<T> ascend(const Toss<T>& toss, const MaskOf<T>& wanted) {
  using S = ScalarOf<T>;
  const T two_pi(S(2) * std::numbers::pi_v<S>);
  Ascent<T> ascent;
  const MaskOf<T> often = wanted & toss_detail::climbs_often(toss);
  MaskOf<T> climbing = wanted & (toss.fastest > T(0)) & !often, above = wanted & !wanted;
  T top = toss.top, fastest = toss.fastest;
  // from a maximum of y' to the minimum after it
  const T drop = T(2) * (toss.swing + toss.gravity * toss.opening);
  for (bool first = true; any(climbing); first = false) {
    const MaskOf<T> sinking = climbing & (fastest + toss.gravity * two_pi < drop);
    if (!first && any(sinking)) {
      const T at = toss_detail::bottom(toss, top, sinking), y = toss_height(toss, at).value;
      const MaskOf<T> landed = sinking & above & !(y > T(0));
      ascent.sunk = select(landed, at, ascent.sunk);
      climbing = climbing & !landed;
      ascent.dip = select(sinking & !above, smaller(ascent.dip, y), ascent.dip);
    }
    const MaskOf<T> cresting = climbing & (fastest < drop);
    if (any(cresting)) {
      const auto [at, y] = toss_detail::crown_and_height(toss, top, cresting);
      const MaskOf<T> clear = cresting & (y > T(0)), higher = clear & (y > ascent.height);
      above = above | clear;
      ascent.height = select(higher, y, ascent.height);
      ascent.apex = select(higher, at, ascent.apex);
      ascent.last_apex = select(clear, at, ascent.last_apex);
    }
    top = top + two_pi;
    fastest = fastest - toss.gravity * two_pi;
    const MaskOf<T> over = climbing & !(fastest > T(0));
    ascent.sunk = select(over & above, T(1.001) * toss_end(toss), ascent.sunk);
    climbing = climbing & !over;
  }
  if (any(often)) {
    const Flight<T> flight = toss_detail::walk(toss, often);
    ascent.height = select(often, flight.height, ascent.height);
    ascent.apex = select(often, flight.apex_time, ascent.apex);
    ascent.sunk = select(often, flight.flight_time, ascent.sunk);
    ascent.dip = select(often, flight.dip, ascent.dip);
  }
  return ascent;
}

/// The rest of a flight, psi in place of times and heights of rho; zero where it never clears the plane.
/// Lanes outside `wanted` return anything, and without finds_dip so does the dip of all.
template <class T>
Flight<T> descend(const Toss<T>& toss, const Ascent<T>& ascent, const MaskOf<T>& wanted,
                  bool finds_dip = true) {
  using std::sqrt;
  const T pi(std::numbers::pi_v<ScalarOf<T>>), epsilon(std::numeric_limits<ScalarOf<T>>::epsilon());
  const MaskOf<T> flies = wanted & (ascent.apex > T(0));
  const MaskOf<T> often = toss_detail::climbs_often(toss), seldom = flies & !often;
  T dip = select(flies, ascent.dip, T(0));
  const MaskOf<T> dips = seldom & (toss.top > T(2) * (pi - toss.opening));
  if (finds_dip && any(dips)) {
    const T lowest = toss_height(toss, toss_detail::bottom(toss, toss.top, dips)).value;
    dip = select(dips, smaller(dip, lowest), dip);
  }
  const CurvedSample<T> apex = toss_height(toss, ascent.last_apex);
  // The apex's parabola, which comes down late, as y'' falls on.
  const T fall = ascent.sunk - ascent.last_apex;
  const T guess =
      ascent.last_apex + smaller(sqrt(T(-2) * apex.value / apex.curvature), T(ScalarOf<T>(0.93L)) * fall);
  const T landing = polish_root([&](const T& psi) { return toss_height(toss, psi); }, ascent.last_apex,
                                ascent.sunk, guess, wanted & !wanted, T(2) * epsilon * ascent.sunk, seldom);
  return {ascent.height, ascent.apex, select(flies, select(often, ascent.sunk, landing), T(0)), dip};
}

/// A toss's flight in its units.
template <class T>
Flight<T> scaled(const Flight<T>& toss, const Hoop<T>& hoop, const T& spin) {
  using std::abs;
  const T diameters = T(0.5) * hoop.rho, unit = T(1) / abs(spin);
  return {toss.height * diameters, toss.apex_time * unit, toss.flight_time * unit, toss.dip * diameters};
}

/// What is asked of a flight. Numbers that are not asked for are anything.
template <class T>
struct FlightAsked {
  T lands_below = T(HUGE_VAL);  ///< flights that stay below this height land [hoop diameters]
  bool dip = true;
};

/// The flight that starts at lift_off, of a hoop that no motor turns on.
template <class T>
Flight<T> fly_undriven(const Hoop<T>& hoop, const LiftOff<T>& lift_off, const FlightAsked<T>& asked = {}) {
  using std::abs;
  // y depends on phi and w only through cos(phi + w t) and sin(phi) w: turning backwards is the mirror image.
  const T angle = select(lift_off.spin < T(0), -lift_off.angle, lift_off.angle);
  const Toss<T> toss = toss_of(hoop, angle, trig(angle), T(abs(lift_off.spin)));
  const Ascent<T> ascent = ascend(toss, MaskOf<T>(true));
  const MaskOf<T> flies = ascent.height > T(0);
  if (!any(flies)) return {};
  const MaskOf<T> descends = flies & !(ascent.height * (T(0.5) * hoop.rho) >= asked.lands_below);
  Flight<T> flown{ascent.height, ascent.apex};
  if (any(descends)) flown = descend(toss, ascent, descends, asked.dip);
  const Flight<T> flight = scaled(flown, hoop, lift_off.spin);
  const auto of_flying = [&](const T& value) { return select(flies, value, T(0)); };
  return {of_flying(flight.height), of_flying(flight.apex_time), of_flying(flight.flight_time),
          of_flying(flight.dip)};
}

/// The same of any hoop.
template <class T>
Flight<T> fly(const Hoop<T>& hoop, const LiftOff<T>& lift_off, const FlightAsked<T>& asked = {}) {
  const MaskOf<T> driven = hoop.aloft != T(0);
  if (!any(driven)) return fly_undriven(hoop, lift_off, asked);
  const Flight<T> flight = fly_driven(hoop, lift_off.angle, lift_off.spin, T(0), driven).flight;
  return all(driven) ? flight : of_either(driven, flight, fly_undriven(hoop, lift_off, asked));
}

/// The whole flight of a rebound, which leaves with normal velocity v_n > 0. Where gravity wins over the
/// mass's swing (gamma >= 1, any spin that small) y is concave: one apex, one landing.
template <class S>
Flight<S> fly_off(const Hoop<S>& hoop, const LiftOff<S>& lift_off, const S& normal_velocity) {
  using std::abs, std::sqrt;
  if (hoop.aloft != S(0)) return DrivenFlight<S>(hoop, lift_off.angle, lift_off.spin, normal_velocity).fly();
  const S spin = abs(lift_off.spin), swing = hoop.rho * spin * spin;
  const Trig<S> phi = trig(lift_off.spin < S(0) ? -lift_off.angle : lift_off.angle);
  if (swing < hoop.cos_slope) {
    const auto motion_at = [&](const S& t) {
      return height_above_plane(hoop, phi, spin, t, normal_velocity);
    };
    const auto height_at = [&](const S& t) {
      const auto y = motion_at(t);
      return Sample<S>{y.value, y.rate};
    };
    const auto climb_at = [&](const S& t) {
      const auto y = motion_at(t);
      return Sample<S>{y.rate, y.acceleration};
    };
    // y'' lies between -(cos theta + swing) and -(cos theta - swing), so that these bracket apex and landing.
    const S steepest = hoop.cos_slope + swing, resolution = S(2) * std::numeric_limits<S>::epsilon();
    const S first = normal_velocity / steepest;
    S last = S(2) * first;
    while (climb_at(last).value > S(0)) last += last;
    const S apex = polish_root(climb_at, first * S(0.999), last, first, false, resolution * last);
    S end = S(2) * apex;
    while (height_at(end).value > S(0)) end += end;
    const S landing = polish_root(height_at, apex, end, S(2) * apex, false, resolution * end);
    return {S(0.5) * height_at(apex).value, apex, landing, S(0)};
  }
  const Toss<S> toss = toss_of(hoop, lift_off.spin < S(0) ? -lift_off.angle : lift_off.angle, phi, spin);
  return scaled(walk_toss(toss, normal_velocity / (hoop.rho * spin)), hoop, spin);
}

}  // namespace leapmap
