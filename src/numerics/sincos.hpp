// SPDX-License-Identifier: GPL-3.0-or-later
/// Sine and cosine together, of a number or of a batch of numbers.
#pragma once

#include <cmath>
#include <cstdint>
#include <xsimd/xsimd.hpp>

namespace leapmap {

template <class T>
struct SinCos {
  T sin, cos;
};

template <class T>
SinCos<T> sincos_of(const T& x) {
  using std::cos, std::sin;
  return {sin(x), cos(x)};
}

/// The same for |x| <= pi / 4.
template <class T>
SinCos<T> sincos_of_small(const T& x) {
  return sincos_of(x);
}
/// By polynomials, those of fdlibm, which take Estrin's order so that little waits for little.
template <class A>
SinCos<xsimd::batch<double, A>> sincos_of_small(const xsimd::batch<double, A>& x) {
  using T = xsimd::batch<double, A>;
  const T z = x * x, z2 = z * z;
  const auto pair = [&](double high, double low) { return xsimd::fma(T(high), z, T(low)); };
  const T sine = xsimd::fma(xsimd::fma(pair(1.58969099521155010221e-10, -2.50507602534068634195e-08), z2,
                                       pair(2.75573137070700676789e-06, -1.98412698298579493134e-04)),
                            z2, pair(8.33333333332248946124e-03, -1.66666666666666324348e-01));
  const T cosine = xsimd::fma(xsimd::fma(pair(-1.13596475577881948265e-11, 2.08757232129817482790e-09), z2,
                                         pair(-2.75573143513906633035e-07, 2.48015872894767294178e-05)),
                              z2, pair(-1.38888888888741095749e-03, 4.16666666666666019037e-02));
  return {xsimd::fma(sine * z, x, x), xsimd::fma(cosine, z2, xsimd::fnma(T(0.5), z, T(1.0)))};
}

/// On a batch of doubles, to 1.6 units in the last place, or 1e-26 |x|. A multiple of a quarter-turn is taken
/// off in two parts (Cody and Waite), the first of 33 bits, so that it goes off exactly with or without FMA.
/// A third of the time of xsimd's, to which the largest angles are left.
template <class A>
SinCos<xsimd::batch<double, A>> sincos_of(const xsimd::batch<double, A>& x) {
  using T = xsimd::batch<double, A>;
  using Bits = xsimd::batch<std::int64_t, A>;
  if (!xsimd::all(xsimd::abs(x) < T(1e6))) {  // also where x is not a number
    const auto [s, c] = xsimd::sincos(x);
    return {s, c};
  }
  // Adding 1.5 * 2^52 rounds to an integer, and leaves it in the low bits.
  const T rounder(6755399441055744.0), rounded = xsimd::fma(x, T(0.63661977236758134308), rounder);
  const T quarters = rounded - rounder;
  const Bits quadrant = xsimd::bitwise_cast<Bits>(rounded);
  const auto [s, c] = sincos_of_small(xsimd::fnma(quarters, T(6.07710050650619224932e-11),
                                                  xsimd::fnma(quarters, T(1.57079632673412561417), x)));
  // An odd quarter swaps sine and cosine; the quarters' second bit turns the sine's sign, that of the next
  // quarter the cosine's.
  const auto odd = xsimd::bitwise_cast<T>((quadrant & Bits(1)) << 62) > T(0.0);  // 2 or 0
  const auto turned = [](const T& value, const Bits& by) {
    return xsimd::bitwise_cast<T>(xsimd::bitwise_cast<Bits>(value) ^ ((by & Bits(2)) << 62));
  };
  return {turned(xsimd::select(odd, c, s), quadrant), turned(xsimd::select(odd, s, c), quadrant + Bits(1))};
}

}  // namespace leapmap
