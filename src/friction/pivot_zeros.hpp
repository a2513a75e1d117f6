// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a slide's pivot (hoop/sliding.hpp) vanishes in the complex plane of the angle, and how long a
/// panel may be for it: all that a slide divides by is the pivot, so that this tells before a panel is solved
/// whether its nodes will resolve it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "hoop/parameters.hpp"

namespace leapmap {

/// The zeros at angle[k] +- i height[k], modulo a turn; one off the real axis comes twice. Nearly all to
/// three digits or more, which is enough for a length; where two all but meet they are rough, or not numbers.
template <class T>
struct PivotZeros {
  std::array<T, 4> angle, height;
};

namespace pivot_zeros_detail {

template <class T>
struct Complex {
  T re, im;
  friend Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator/(const Complex& a, const Complex& b) {
    const T inverse = T(ScalarOf<T>(1)) / (b.re * b.re + b.im * b.im);
    return a * Complex{b.re * inverse, -b.im * inverse};
  }
};

}  // namespace pivot_zeros_detail

/// friction: m = mu_kinetic sign(v). With z = e^(i phi) the pivot times z^2 is a polynomial of degree 4; over
/// its first coefficient, -rho^2 (1 + i m) / 4, it is
///   z^4 + a z^3 - b z^2 - a z + (1 - i m) / (1 + i m),
///   a = -2 i m / (rho (1 + i m)),   b = (4 Ic / rho^2 + 2) / (1 + i m).
/// Its zeros come by the iteration of Durand and Kerner from those of m = 0, turned a little apart.
template <class T>
PivotZeros<T> pivot_zeros(const Hoop<T>& hoop, const T& friction) {
  using std::abs, std::atan2, std::log, std::sqrt;
  using S = ScalarOf<T>;
  using C = pivot_zeros_detail::Complex<T>;
  constexpr int iterations = 9;
  const T one(S(1)), zero(S(0)), two(S(2)), rho = hoop.rho, m = friction;
  const C first{one, m};
  const C a = C{zero, -two * m / rho} / first, b = C{T(S(4)) * hoop.Ic / (rho * rho) + two, zero} / first,
          last = C{one, -m} / first;
  const T sine = sqrt(hoop.Ic) / rho, large = sine + sqrt(one + sine * sine), small = one / large;
  const T cos_ahead(S(0.98)), sin_ahead(S(0.2)), cos_behind(S(0.995)), sin_behind(S(0.1));
  std::array<C, 4> z{C{small * cos_ahead, small * sin_ahead}, C{large * cos_ahead, large * sin_ahead},
                     C{-small * cos_behind, small * sin_behind}, C{-large * cos_behind, large * sin_behind}};
  for (int k = 0; k < iterations; ++k)
    for (std::size_t i = 0; i < z.size(); ++i) {
      const C value = (((z[i] + a) * z[i] - b) * z[i] - a) * z[i] + last;
      const C apart = (z[i] - z[(i + 1) % 4]) * (z[i] - z[(i + 2) % 4]) * (z[i] - z[(i + 3) % 4]);
      z[i] = z[i] - value / apart;
    }
  PivotZeros<T> zeros;
  for (std::size_t i = 0; i < z.size(); ++i) {
    zeros.angle[i] = atan2(z[i].im, z[i].re);
    zeros.height[i] = abs(T(S(0.5)) * log(z[i].re * z[i].re + z[i].im * z[i].im));
  }
  return zeros;
}

/// How long a panel from `angle` on may be, whose nodes lie evenly in q, |phi - angle| = shift + q^2
/// (sliding_panel.hpp), for all zeros to stay outside of its ellipse: that on which the distances to the
/// panel's ends sum up to `stretch` times the panel. way: 1 or -1.
///
/// A zero at q0 + xi + i eta, q0 the panel's beginning, is a = |xi + i eta| away from it, so that it is on
/// the ellipse of the panel of length u where a + |xi - u + i eta| = stretch u: u = 2 (stretch a - xi) /
/// (stretch^2 - 1).
template <class T>
T resolved_length(const PivotZeros<T>& zeros, const T& angle, const T& way, const T& shift,
                  const ScalarOf<T>& stretch, const T& longest) {
  using std::floor, std::sqrt;
  using S = ScalarOf<T>;
  const T turn(S(2) * pi_of<S>), half(S(0.5)), begin = sqrt(-shift);
  T length = longest;
  for (std::size_t k = 0; k < zeros.angle.size(); ++k) {
    const T ahead = way * (zeros.angle[k] - angle);
    // From a quarter-turn behind the panel's start on.
    const T x = ahead - turn * floor(ahead / turn + T(S(0.25))) - shift, y = zeros.height[k];
    const T size = sqrt(x * x + y * y), re = sqrt(half * (size + x)), im = sqrt(half * (size - x));
    const T xi = re - begin, away = sqrt(xi * xi + im * im);
    const T u = T(S(2) / (stretch * stretch - S(1))) * (T(stretch) * away - xi);
    const T told = shift + (begin + u) * (begin + u);
    length = select(told < length, told, length);  // a zero that is no number limits nothing
  }
  return length;
}

}  // namespace leapmap
