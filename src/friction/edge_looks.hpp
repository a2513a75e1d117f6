// SPDX-License-Identifier: GPL-3.0-or-later
/// How near a slide in lanes may come to Painleve's edge, where its pivot falls to zero (painleve.hpp), and
/// how far that is, by looks at the pivot.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "hoop/sliding.hpp"

namespace leapmap {

/// Looks all round a turn, as many at once as T has lanes.
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
  /// times |pivot''| <= 2 rho^2 + |m| rho (1 + 2 rho).
  S least_pivot(const Hoop<S>& hoop, const S& friction) const {
    const T rho(hoop.rho), m(friction), one(S(1));
    T least(std::numeric_limits<S>::max());
    for (std::size_t k = 0; k < looks_a_turn; k += width) {
      const T s = rho * Lanes<T>::load(sin_.data() + k), c = Lanes<T>::load(cos_.data() + k);
      least = smaller(least, s * (s - m * (one - rho * c)));
    }
    const auto lanes = lanes_of(least);
    const S step = S(2) * pi_of<S> / S(looks_a_turn), size = std::abs(friction) * hoop.rho;
    const S off = step * step / S(8) * (S(2) * hoop.rho * hoop.rho + size * (S(1) + S(2) * hoop.rho));
    if (hoop.Ic + *std::min_element(lanes.begin(), lanes.end()) > off) return S(0);
    return S(near_edge) * (hoop.rho * hoop.rho + size * (S(1) + hoop.rho));
  }

 private:
  static constexpr std::size_t looks_a_turn = 48, width = Lanes<T>::count;
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
