// SPDX-License-Identifier: GPL-3.0-or-later
/// How long a hoop takes to roll, enclosed: the time is the integral of sqrt(J / E) over the angle.
#pragma once

#include <cmath>

#include "proof/forms.hpp"
#include "proof/motion.hpp"

namespace leapmap {

/// From one angle past the release to another [sqrt(R/g)], of one design, by Arb's integration of analytic
/// functions. E has to be above zero between. Not finite where it does not succeed.
Ball travel_time(const Roll<Ball>& roll, const Ball& from, const Ball& to);

namespace travel_detail {

/// sqrt(J / E), or from rest, where that is infinite, the same times sqrt(x).
template <class T>
T slowness(const Roll<T>& roll, const Ball& x, bool from_rest) {
  const Hoop<T>& hoop = roll.hoop;
  const Ball half = x * Ball(0.5), less_sinc = Ball(1) - sinc(x), versine = sincos_of(half).sin * sinc(half);
  const T E = T(2) * (roll.push + hoop.rho * (sin_from_vertical(hoop, roll.release_trig) * T(less_sinc) -
                                              cos_from_vertical(hoop, roll.release_trig) * T(versine)));
  const T J = contact_inertia(hoop, trig(T(roll.release + T(x))));
  return sqrt(J / (from_rest ? E : roll.released + E * T(x)));
}

}  // namespace travel_detail

/// The same of all designs of a box, from their release: by the mean-value form, as the time changes with the
/// end, and with E and J on the way.
template <std::size_t N>
Ball travel_time(const Forms<N>& forms, const Both<Roll, N>& roll, const BothNumbers<N>& to) {
  constexpr double step = 0.1;  // rad
  const bool from_rest = roll.middle.released == Ball(0);
  const double surely = to.all.value.lower(), pieces = std::ceil(surely / step);
  std::array<Ball, N> by{};
  const auto add = [&](const Ball& from, const Ball& end) {
    const BoxDual<N> slow = travel_detail::slowness(roll.all, hull(from, end), from_rest);
    const Ball weight = from_rest ? Ball(2) * (sqrt(end) - sqrt(from)) : end - from;
    for (std::size_t k = 0; k < N; ++k) by[k] = by[k] + slow.by[k + 1] * weight;
  };
  for (double k = 0.0; k < pieces; ++k)
    add(Ball(surely * (k / pieces)), Ball(k + 1.0 < pieces ? surely * ((k + 1.0) / pieces) : surely));
  add(Ball(surely), to.all.value);
  const Ball last = travel_detail::slowness(roll.all, to.all.value, from_rest).value;
  const Ball at_end = from_rest ? last / sqrt(to.all.value) : last;
  Ball time = travel_time(roll.middle, Ball(0), to.middle);
  for (std::size_t k = 0; k < N; ++k) time = time + (by[k] + at_end * to.all.by[k + 1]) * forms.reach[k];
  return time;
}

}  // namespace leapmap
