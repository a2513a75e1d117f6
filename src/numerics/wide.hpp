// SPDX-License-Identifier: GPL-3.0-or-later
/// Two batches side by side as one scalar: while one half waits for a result, the other is worked on. It
/// pays where each step needs the one before: iterations to a root, chains of functions.
#pragma once

#include "numerics/lanes.hpp"

namespace leapmap {

template <class B>
struct WideMask {
  using Half = typename Lanes<B>::Mask;
  Half low, high;
  WideMask() = default;
  WideMask(const Half& l, const Half& h) : low(l), high(h) {}
  explicit WideMask(bool value) : low(value), high(value) {}

  friend WideMask operator&(const WideMask& a, const WideMask& b) { return {a.low & b.low, a.high & b.high}; }
  friend WideMask operator|(const WideMask& a, const WideMask& b) { return {a.low | b.low, a.high | b.high}; }
  friend WideMask operator==(const WideMask& a, const WideMask& b) {
    return {a.low == b.low, a.high == b.high};
  }
  friend WideMask operator!(const WideMask& a) { return {!a.low, !a.high}; }
  friend bool any(const WideMask& a) { return any(a.low | a.high); }
  friend bool all(const WideMask& a) { return all(a.low & a.high); }
};

template <class B>
struct Wide {
  using Scalar = ScalarOf<B>;
  using Mask = WideMask<B>;
  B low, high;
  Wide() = default;
  Wide(const B& l, const B& h) : low(l), high(h) {}
  explicit Wide(Scalar value) : low(value), high(value) {}

  friend Wide operator+(const Wide& a, const Wide& b) { return {a.low + b.low, a.high + b.high}; }
  friend Wide operator-(const Wide& a, const Wide& b) { return {a.low - b.low, a.high - b.high}; }
  friend Wide operator*(const Wide& a, const Wide& b) { return {a.low * b.low, a.high * b.high}; }
  friend Wide operator/(const Wide& a, const Wide& b) { return {a.low / b.low, a.high / b.high}; }
  friend Wide operator-(const Wide& a) { return {-a.low, -a.high}; }
  friend Mask operator<(const Wide& a, const Wide& b) { return {a.low < b.low, a.high < b.high}; }
  friend Mask operator>(const Wide& a, const Wide& b) { return {a.low > b.low, a.high > b.high}; }
  friend Mask operator<=(const Wide& a, const Wide& b) { return {a.low <= b.low, a.high <= b.high}; }
  friend Mask operator>=(const Wide& a, const Wide& b) { return {a.low >= b.low, a.high >= b.high}; }
  friend Mask operator==(const Wide& a, const Wide& b) { return {a.low == b.low, a.high == b.high}; }
  friend Mask operator!=(const Wide& a, const Wide& b) { return !(a == b); }

  friend Wide select(const Mask& mask, const Wide& a, const Wide& b) {
    return {select(mask.low, a.low, b.low), select(mask.high, a.high, b.high)};
  }
  friend Wide larger(const Wide& a, const Wide& b) { return {larger(a.low, b.low), larger(a.high, b.high)}; }
  friend Wide smaller(const Wide& a, const Wide& b) {
    return {smaller(a.low, b.low), smaller(a.high, b.high)};
  }
  friend Wide abs(const Wide& a) { return {abs(a.low), abs(a.high)}; }
  friend Wide sqrt(const Wide& a) { return {sqrt(a.low), sqrt(a.high)}; }
  friend Wide floor(const Wide& a) { return {floor(a.low), floor(a.high)}; }
  friend Wide log(const Wide& a) { return {log(a.low), log(a.high)}; }
  friend Wide acos(const Wide& a) { return {acos(a.low), acos(a.high)}; }
  friend Wide asin(const Wide& a) { return {asin(a.low), asin(a.high)}; }
  friend Wide atan2(const Wide& y, const Wide& x) { return {atan2(y.low, x.low), atan2(y.high, x.high)}; }
  friend Wide reciprocal_sqrt(const Wide& a) { return {reciprocal_sqrt(a.low), reciprocal_sqrt(a.high)}; }
  friend SinCos<Wide> sincos_of(const Wide& a) {
    const SinCos<B> first = sincos_of(a.low), second = sincos_of(a.high);
    return {{first.sin, second.sin}, {first.cos, second.cos}};
  }
};

template <class B>
struct Lanes<Wide<B>> {
  using Scalar = ScalarOf<B>;
  using Mask = WideMask<B>;
  static constexpr std::size_t half = Lanes<B>::count, count = 2 * half;
  static Wide<B> load(const Scalar* from) { return {Lanes<B>::load(from), Lanes<B>::load(from + half)}; }
  static void store(const Wide<B>& value, Scalar* to) {
    Lanes<B>::store(value.low, to), Lanes<B>::store(value.high, to + half);
  }
  static unsigned bits(const Mask& mask) {
    return Lanes<B>::bits(mask.low) | Lanes<B>::bits(mask.high) << half;
  }
};

namespace wide_detail {
template <class T>
struct WideOf {
  using type = T;
};
template <class S, class A>
struct WideOf<xsimd::batch<S, A>> {
  using type = Wide<xsimd::batch<S, A>>;
};
}  // namespace wide_detail

/// Two batches of a kind; a plain number stays one.
template <class T>
using WideOf = typename wide_detail::WideOf<T>::type;

}  // namespace leapmap
