// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/rolling_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hoop/flight_search.hpp"

namespace leapmap {

void RollingMotion::roll(const ContactState<double>& from, double end, bool to_rest) {
  way_ = end < from.angle ? -1.0 : 1.0;
  const double length = std::abs(end - from.angle);
  // The end of a way to rest is come to from the place of rest, where it is known best.
  const double last = to_rest ? std::min(0.5 * length, std::numbers::pi) : 0.0;
  ContactState<double> start = from;
  start.angle *= way_, start.spin *= way_, start.travel *= way_;
  roll_on(start, length - last);
  if (to_rest) roll_to_rest(start, length);
}

/// A turn at a time, as the time integral of many turns would have to be inverted as a whole.
void RollingMotion::roll_on(const ContactState<double>& from, double length) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double turns = std::ceil(length / turn);
  ContactState<double> start = from;
  for (double k = 1.0; k <= turns; ++k) {
    const Roll<double> roll = begin_roll(seen(hoop_, way_), start.angle, start.spin);
    const double most = from.angle + (k == turns ? length : k * turn) - start.angle;
    const double duration = time_.halving(roll, start.angle + most);
    ContactState<double> at = start;
    sampler_.until(start.time + duration, [&](double t) {
      const double x =
          rolled_within(roll, t - start.time, at.angle - start.angle, at.spin * (t - at.time), most);
      at = rolled(roll, start, x, t);
      return shown(at);
    });
    start = rolled(roll, start, most, start.time + duration);
  }
  end_ = start.time;
}

/// The way to where it comes to rest, from where the motion is: the way back from there, backwards in time.
void RollingMotion::roll_to_rest(const ContactState<double>& from, double length) {
  const double last = std::min(0.5 * length, std::numbers::pi);
  const Roll<double> back = begin_roll(seen(hoop_, -way_), -(from.angle + length), 0.0);
  const double duration = time_.halving_past(back, last), rest = end_ + duration;
  const ContactState<double> turn{.angle = back.release};
  sampler_.until(rest, [&](double t) {
    const double x = rolled_within(back, rest - t, 0.0, 0.0, last);
    const ContactState<double> there = rolled(back, turn, x, t);
    return shown({t, from.travel + length - x, -there.angle, there.spin});
  });
  end_ = rest;
}

MotionPoint RollingMotion::shown(ContactState<double> at) const {
  at.angle *= way_, at.spin *= way_, at.travel *= way_;
  return rolling_point(hoop_, at);
}

void RollingMotion::fly(const ContactState<double>& from, double flight_time) {
  sampler_.fly(hoop_, from, flight_time);
  end_ = from.time + flight_time;
}

ContactState<double> RollingMotion::rolled(const Roll<double>& roll, const ContactState<double>& from,
                                           double x, double time) const {
  ContactState<double> to{.time = time, .travel = from.travel + x, .angle = from.angle + x};
  const double E = std::max(vis_viva_past_release(roll, x), 0.0);
  to.spin = x > 0.0 ? std::sqrt(E / contact_inertia(roll.hoop, trig(to.angle))) : from.spin;
  return to;
}

/// How far it rolls in a time: further than `least`, by some `step`, and at most `most`. The root of t(x),
/// whose derivative is 1 / w.
double RollingMotion::rolled_within(const Roll<double>& roll, double duration, double least, double step,
                                    double most) const {
  if (!(duration > 0.0)) return 0.0;
  const auto time_left = [&](double x) {
    const double E = vis_viva_past_release(roll, x);
    return Sample<double>{time_.halving(roll, roll.release + x) - duration,
                          std::sqrt(contact_inertia(roll.hoop, trig(roll.release + x)) / E)};
  };
  // What is left of the turn may be hard to time, so that the end of the bracket is come to from below.
  double reach = std::max(1.5 * step, 1e-6 * most);
  while (least + reach < most && time_left(least + reach).value < 0.0) reach *= 2.0;
  const double resolution = 4.0 * std::numeric_limits<double>::epsilon() * (1.0 + most);
  return polish_root(time_left, least, std::min(least + reach, most * (1.0 + 1e-15)), least + step, true,
                     resolution);
}

}  // namespace leapmap
