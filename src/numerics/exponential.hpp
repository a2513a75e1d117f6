// SPDX-License-Identifier: GPL-3.0-or-later
/// The exponential of a number or of a batch of numbers.
#pragma once

#include <cmath>
#include <cstdint>
#include <xsimd/xsimd.hpp>

namespace leapmap {

/// e^x.
template <class T>
T exponential(const T& x) {
  using std::exp;
  return exp(x);
}

/// Of a batch of doubles to 2 units in the last place. It divides by nothing: with AVX2 it takes half of the
/// time that the library takes, with AVX-512 as long. Beyond +-708 it is that of +-708.
///
/// x = k log 2 + r, k an integer, the logarithm in two parts (Cody and Waite); e^r is Taylor's polynomial of
/// degree 13, off by less than 5e-18, four terms at a time so that little waits for little.
template <class A>
xsimd::batch<double, A> exponential(const xsimd::batch<double, A>& x) {
  using T = xsimd::batch<double, A>;
  using Bits = xsimd::batch<std::int64_t, A>;
  constexpr double turns = 1.44269504088896338700, high = 6.93147180369123816490e-01,
                   low = 1.90821492927058770002e-10;
  // Adding it rounds to an integer and leaves that, raised by an exponent's bias, in the low bits.
  constexpr double rounder = 6755399441055744.0 + 1023.0;  // 1.5 * 2^52 + 1023
  const T bounded = xsimd::min(T(708.0), xsimd::max(T(-708.0), x));
  const T rounded = xsimd::fma(bounded, T(turns), T(rounder)), k = rounded - T(rounder);
  const T r = xsimd::fnma(k, T(low), xsimd::fnma(k, T(high), bounded)), r2 = r * r, r4 = r2 * r2;
  const auto pair = [&](double above, double below) { return xsimd::fma(T(above), r, T(below)); };
  const auto four = [&](const T& above, const T& below) { return xsimd::fma(above, r2, below); };
  const T first = four(pair(1.0 / 6, 1.0 / 2), pair(1.0, 1.0)),
          second = four(pair(1.0 / 5040, 1.0 / 720), pair(1.0 / 120, 1.0 / 24)),
          third = four(pair(1.0 / 39916800, 1.0 / 3628800), pair(1.0 / 362880, 1.0 / 40320)),
          last = pair(1.0 / 6227020800, 1.0 / 479001600);
  const T scale = xsimd::bitwise_cast<T>(xsimd::bitwise_cast<Bits>(rounded) << 52);
  return xsimd::fma(xsimd::fma(xsimd::fma(last, r4, third), r4, second), r4, first) * scale;
}

}  // namespace leapmap
