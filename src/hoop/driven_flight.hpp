// SPDX-License-Identifier: GPL-3.0-or-later
/// Free flight with the motor on: a balanced rotor takes its reaction, so that the centre of mass flies its
/// parabola and the angle is a quadratic in time, phi(t) = phi + w t + tau t^2 / (2 Ic).
///
/// No apex and no landing can be missed: between two times y' changes its sign only where bounds of y'', y'''
/// and y'''' allow it, and times are halved until they say whether.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hoop/flight.hpp"
#include "numerics/lanes.hpp"

namespace leapmap {

/// One flight from its lift-off, in sqrt(R/g) and R.
template <class S>
class DrivenFlight {
 public:
  DrivenFlight(const Hoop<S>& hoop, const S& angle, const S& spin, const S& normal_velocity)
      : hoop_(hoop), phi_(trig(angle)), spin_(spin), normal_(normal_velocity) {}

  /// Height zero: it never clears the plane.
  Flight<S> fly() {
    using std::abs, std::sqrt;
    const S rate = abs(spin_) + sqrt(abs(hoop_.aloft));
    const S shortest = S(1e-9) / (S(1) + rate);  // no root at or next to the lift-off itself is one of these
    const S climb = normal_ + hoop_.rho * phi_.sin * spin_,
            gravity = hoop_.cos_slope;  // of the centre of mass
    // y lies within rho (1 - c), above, and rho (1 + c), below, of the centre of mass's parabola.
    const S end = S(1.001) * last_root(hoop_.rho * phi_.versine, climb, gravity);
    if (normal_ > S(0) && at(shortest).rate <= S(0)) return short_rebound();
    if (!(end > shortest)) return {};
    const S below = hoop_.rho * (S(1) + phi_.cos), vertex = climb / gravity;
    const S near = S(2.02) * sqrt(hoop_.rho / gravity);  // the highest apex is so near the vertex
    const S clear = climb * climb - S(2) * gravity * below;
    const S half = climb > S(0) && clear > S(0) ? sqrt(clear) / gravity : S(0);
    const auto take = [&](const S& to) { return segment(to); };
    if (half > near) {  // surely above the plane for long: neither landing nor apex is far from these three
      if (pass(shortest, vertex - half, take) || pass(vertex - near, vertex + near, take)) return flight_;
      from_ = vertex + half;
      return pass(vertex + half, end, take) ? flight_ : Flight<S>{};
    }
    return pass(shortest, end, take) ? flight_ : Flight<S>{};
  }

  /// After fly: when it was deepest below the plane before it cleared it; 0: never.
  const S& lowest_at() const { return lowest_at_; }

 private:
  HeightAbovePlane<S> at(const S& t) const { return height_above_plane(hoop_, phi_, spin_, t, normal_); }

  /// The larger root of level + climb t - gravity t^2 / 2; level >= 0.
  static S last_root(const S& level, const S& climb, const S& gravity) {
    using std::sqrt;
    const S root = sqrt(climb * climb + S(2) * gravity * level);
    return climb > S(0) ? (climb + root) / gravity : root > climb ? S(2) * level / (root - climb) : S(0);
  }

  /// A rebound so slow that it lands before anything else happens.
  Flight<S> short_rebound() const {
    const S fall = -at(S(0)).acceleration, apex = normal_ / fall;
    return {S(0.25) * normal_ * apex, apex, S(2) * apex, S(0)};
  }

  /// y is monotone from the last time to this one; true once the flight has ended.
  bool segment(const S& to) {
    const S y = at(to).value;
    above_ = above_ || y > S(0);
    if (above_ && S(0.5) * y > flight_.height) flight_.height = S(0.5) * y, flight_.apex_time = to;
    if (!above_ && S(0.5) * y < flight_.dip) flight_.dip = S(0.5) * y, lowest_at_ = to;
    const S from = std::exchange(from_, to);
    if (!above_ || y > S(0)) return false;
    const auto height = [&](const S& t) {
      const auto here = at(t);
      return Sample<S>{here.value, here.rate};
    };
    flight_.flight_time = polish_root(height, from, to, from, false, resolution * to);
    return true;
  }

  /// segment up to every turn of y between two times, and to the last of them.
  template <class Take>
  bool pass(const S& from, const S& to, const Take& take) {
    if (!(from < to)) return false;
    return turns(from, to, take) || take(to);
  }

  /// Where y' changes its sign, in order, until `take` returns true.
  template <class Take>
  bool turns(const S& from, const S& to, const Take& take) {
    using std::abs;
    const S half = S(0.5) * (to - from), middle = from + half;
    const auto y = at(middle);
    const S w = std::max(abs(spin_ + hoop_.aloft * from), abs(spin_ + hoop_.aloft * to));
    // Of y'''' and y''' the most; near a grazing lift-off y''' is far below what it is anywhere else.
    const S torque = abs(hoop_.aloft),
            snap = hoop_.rho * (w * w * (w * w + S(6) * torque) + S(3) * torque * torque),
            jerk = std::min(hoop_.rho * w * (w * w + S(3) * torque), abs(y.jerk) + half * snap);
    if (!std::isfinite(y.rate) || !std::isfinite(jerk)) {
      flight_ = {std::numeric_limits<S>::quiet_NaN()};
      return true;  // nothing is known of it
    }
    if (abs(y.rate) > half * (abs(y.acceleration) + S(0.5) * half * jerk)) return false;
    if (abs(y.acceleration) > half * jerk) {
      const bool climbs = at(from).rate > S(0), climbs_on = at(to).rate > S(0);
      if (climbs == climbs_on) return false;
      const auto climb = [&](const S& t) {
        const auto here = at(t);
        return Sample<S>{here.rate, here.acceleration};
      };
      return take(polish_root(climb, from, to, middle, climbs_on, resolution * to));
    }
    if (half <= resolution * to) return false;  // two turns in one
    return turns(from, middle, take) || turns(middle, to, take);
  }

  static constexpr S resolution = S(2) * std::numeric_limits<S>::epsilon();
  const Hoop<S>& hoop_;
  Trig<S> phi_;
  S spin_, normal_;
  Flight<S> flight_{};
  bool above_ = false;
  S from_ = S(0), lowest_at_ = S(0);
};

/// Those flights in lanes, for those in `wanted`.
template <class T>
struct DrivenFlights {
  Flight<T> flight;
  T lowest_at;
};
template <class T>
DrivenFlights<T> fly_driven(const Hoop<T>& hoop, const T& angle, const T& spin, const T& normal_velocity,
                            const MaskOf<T>& wanted) {
  using S = ScalarOf<T>;
  const auto cosine = lanes_of(hoop.cos_slope), rho = lanes_of(hoop.rho), aloft = lanes_of(hoop.aloft),
             angles = lanes_of(angle), spins = lanes_of(spin), normals = lanes_of(normal_velocity);
  LaneArray<T> height{}, apex{}, landing{}, dip{}, lowest{};
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (!(Lanes<T>::bits(wanted) >> i & 1u)) continue;
    Hoop<S> one{};  // of which a flight takes these
    one.cos_slope = cosine[i], one.rho = rho[i], one.aloft = aloft[i];
    DrivenFlight<S> driven(one, angles[i], spins[i], normals[i]);
    const Flight<S> flight = driven.fly();
    height[i] = flight.height, apex[i] = flight.apex_time, landing[i] = flight.flight_time;
    dip[i] = flight.dip, lowest[i] = flight.height > S(0) ? driven.lowest_at() : S(0);
  }
  const auto load = [](const LaneArray<T>& lanes) { return Lanes<T>::load(lanes.data()); };
  return {{load(height), load(apex), load(landing), load(dip)}, load(lowest)};
}

/// The flights a in the lanes of the mask, b in the others.
template <class T>
Flight<T> of_either(const MaskOf<T>& mask, const Flight<T>& a, const Flight<T>& b) {
  return {select(mask, a.height, b.height), select(mask, a.apex_time, b.apex_time),
          select(mask, a.flight_time, b.flight_time), select(mask, a.dip, b.dip)};
}

}  // namespace leapmap
