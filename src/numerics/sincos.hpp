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

namespace sincos_detail {

// a b + c, in one instruction where this is compiled for a machine that has it.
inline double multiply_add(double a, double b, double c) { return a * b + c; }
template <class A>
xsimd::batch<double, A> multiply_add(const xsimd::batch<double, A>& a, const xsimd::batch<double, A>& b,
                                     const xsimd::batch<double, A>& c) {
  return xsimd::fma(a, b, c);
}

/// By polynomials, those of fdlibm, which take Estrin's order so that little waits for little.
template <class T>
SinCos<T> of_small(const T& x) {
  const T z = x * x, z2 = z * z;
  const auto pair = [&](double high, double low) { return multiply_add(T(high), z, T(low)); };
  const T sine = multiply_add(multiply_add(pair(1.58969099521155010221e-10, -2.50507602534068634195e-08), z2,
                                           pair(2.75573137070700676789e-06, -1.98412698298579493134e-04)),
                              z2, pair(8.33333333332248946124e-03, -1.66666666666666324348e-01));
  const T cosine =
      multiply_add(multiply_add(pair(-1.13596475577881948265e-11, 2.08757232129817482790e-09), z2,
                                pair(-2.75573143513906633035e-07, 2.48015872894767294178e-05)),
                   z2, pair(-1.38888888888741095749e-03, 4.16666666666666019037e-02));
  return {multiply_add(sine * z, x, x), multiply_add(cosine, z2, multiply_add(T(-0.5), z, T(1.0)))};
}

/// An angle less so many quarter-turns, in two parts (Cody and Waite), the first of 33 bits, so that it goes
/// off exactly with or without FMA.
template <class T>
T less_quarters(const T& x, const T& quarters) {
  return multiply_add(quarters, T(-6.07710050650619224932e-11),
                      multiply_add(quarters, T(-1.57079632673412561417), x));
}

constexpr double quarters_a_radian = 0.63661977236758134308, largest = 1e6;
/// Adding it rounds to an integer, and leaves that in the low bits.
constexpr double rounder = 6755399441055744.0;  // 1.5 * 2^52

}  // namespace sincos_detail

/// Of doubles, alone or in a batch, to 1.6 units in the last place, or 1e-26 |x|: a third of the time that
/// the library takes, to which angles beyond a million are left.
inline SinCos<double> sincos_of_small(double x) { return sincos_detail::of_small(x); }
template <class A>
SinCos<xsimd::batch<double, A>> sincos_of_small(const xsimd::batch<double, A>& x) {
  return sincos_detail::of_small(x);
}

inline SinCos<double> sincos_of(double x) {
  using namespace sincos_detail;
  if (!(std::abs(x) < largest)) return {std::sin(x), std::cos(x)};
  const double quarters = multiply_add(x, quarters_a_radian, rounder) - rounder;
  const auto quadrant = static_cast<std::int64_t>(quarters);
  const auto [s, c] = of_small(less_quarters(x, quarters));
  // An odd quarter swaps sine and cosine; the quarters' second bit turns the sine's sign, that of the next
  // quarter the cosine's.
  const double sine = quadrant & 1 ? c : s, cosine = quadrant & 1 ? s : c;
  return {quadrant & 2 ? -sine : sine, (quadrant + 1) & 2 ? -cosine : cosine};
}

template <class A>
SinCos<xsimd::batch<double, A>> sincos_of(const xsimd::batch<double, A>& x) {
  using namespace sincos_detail;
  using T = xsimd::batch<double, A>;
  using Bits = xsimd::batch<std::int64_t, A>;
  if (!xsimd::all(xsimd::abs(x) < T(largest))) {  // also where x is not a number
    const auto [s, c] = xsimd::sincos(x);
    return {s, c};
  }
  const T rounded = multiply_add(x, T(quarters_a_radian), T(rounder));
  const Bits quadrant = xsimd::bitwise_cast<Bits>(rounded);
  const auto [s, c] = of_small(less_quarters(x, T(rounded - T(rounder))));
  // As above.
  const auto odd = xsimd::bitwise_cast<T>((quadrant & Bits(1)) << 62) > T(0.0);  // 2 or 0
  const auto turned = [](const T& value, const Bits& by) {
    return xsimd::bitwise_cast<T>(xsimd::bitwise_cast<Bits>(value) ^ ((by & Bits(2)) << 62));
  };
  return {turned(xsimd::select(odd, c, s), quadrant), turned(xsimd::select(odd, s, c), quadrant + Bits(1))};
}

}  // namespace leapmap
