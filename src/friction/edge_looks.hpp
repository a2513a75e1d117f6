// SPDX-License-Identifier: GPL-3.0-or-later
/// How near a slide in lanes may come to Painleve's edge, where its pivot falls to zero (painleve.hpp), and
/// how far that is, by looks at the pivot.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "hoop/sliding.hpp"

namespace leapmap {

/// Looks all round a turn at the pivots of as many designs as T has lanes.
template <class T>
class EdgeLooks {
 public:
  using S = ScalarOf<T>;

  EdgeLooks() {
    for (std::size_t k = 0; k < looks_a_turn; ++k) {
      const Trig<S> phi = trig(S(2) * pi_of<S> * S(k) / S(looks_a_turn));
      sin_[k] = phi.sin, cos_[k] = phi.cos;
    }
  }

  /// Zero if the pivot is above zero all round; else what it is at least, so near to an edge. It is
  /// Ic + (rho s)^2 - m rho s (1 - rho c), and between two looks, h apart, it comes down by at most h^2 / 8
  /// times |pivot''| <= 2 rho^2 + |m| rho (1 + 2 rho). Sliding the other way it goes through the same values.
  T least_pivot(const Hoop<T>& hoop, const T& friction) const {
    using std::abs;
    const T rho = hoop.rho, one(S(1)), two(S(2));
    T least(std::numeric_limits<S>::max());
    for (std::size_t k = 0; k < looks_a_turn; ++k) {
      const T s = rho * T(sin_[k]);
      least = smaller(least, s * (s - friction * (one - rho * T(cos_[k]))));
    }
    const T size = abs(friction) * rho;
    const T off = T(S(apart * apart / 8.0)) * (two * rho * rho + size * (one + two * rho));
    return select(hoop.Ic + least > off, T(S(0)), T(S(near_edge)) * (rho * rho + size * (one + rho)));
  }

 private:
  static constexpr std::size_t looks_a_turn = 48;
  static constexpr double apart = 2.0 * std::numbers::pi / double(looks_a_turn);  // [rad]
  static constexpr double near_edge = 0.05;  // nearer n0 needs care [rad]

  std::array<S, looks_a_turn> sin_, cos_;
};

/// How much of the way to an angle `length` on a slide's pivot stays above `least`, as some looks tell.
template <class T>
T way_to_edge(const Hoop<T>& hoop, const T& friction, const Trig<T>& phi, const T& way, const T& least,
              const T& length) {
  using S = ScalarOf<T>;
  constexpr int looks = 8;
  const T step = length * T(S(1) / S(looks));
  const SinCos<T> turned = sincos_of(way * step);
  const auto spare_at = [&](const T& s, const T& c) {
    return sliding_coefficients(hoop, Trig<T>{s, c, T(S(1)) - c}, friction).pivot - least;
  };
  T sine = phi.sin, cosine = phi.cos, clear = length, before = spare_at(sine, cosine);
  const MaskOf<T> is_there = before <= T(S(0));
  for (int k = 1; k <= looks; ++k) {
    const T last = sine;
    sine = sine * turned.cos + cosine * turned.sin, cosine = cosine * turned.cos - last * turned.sin;
    const T spare = spare_at(sine, cosine);
    const MaskOf<T> first = (spare <= T(S(0))) & (clear == length);
    clear = select(first, step * (T(S(k)) - spare / (spare - before)), clear);
    before = spare;
  }
  return select(is_there, T(S(0)), clear);
}

}  // namespace leapmap
