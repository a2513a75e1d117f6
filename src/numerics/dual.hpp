// SPDX-License-Identifier: GPL-3.0-or-later
/// Dual numbers: a value and its derivatives by N parameters, carried through every operation.
///
/// A template on its scalar gives derivatives to rounding when it is used on a Dual, and on the lanes of a
/// batch those of as many designs. Comparisons look at values only. A root that was found in plain numbers is
/// given its derivatives by one Newton step in duals, x - f(x) / f'(x).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "numerics/lanes.hpp"

namespace leapmap {

template <class T, std::size_t N>
struct Dual {
  using Scalar = ScalarOf<T>;
  static constexpr std::size_t derivatives = N;

  T value = T(Scalar(0));
  std::array<T, N> by = zeros();  ///< derivatives, by each parameter

  Dual() = default;
  /// A constant.
  explicit Dual(const T& constant) : value(constant) {}
  explicit Dual(Scalar constant) requires(!std::is_same_v<T, Scalar>) : value(constant) {}
  /// The same in every lane.
  template <class S>
  explicit Dual(const Dual<S, N>& same) requires(std::is_same_v<S, Scalar> && !std::is_same_v<T, S>)
      : value(same.value) {
    for (std::size_t k = 0; k < N; ++k) by[k] = T(same.by[k]);
  }
  /// Parameter number k.
  static Dual parameter(const T& value, std::size_t k) {
    Dual x(value);
    x.by[k] = T(Scalar(1));
    return x;
  }

  /// f(*this), by f and f' of the value.
  Dual through(const T& f, const T& slope) const {
    return made(f, [&](std::size_t k) { return slope * by[k]; });
  }

  friend Dual operator+(const Dual& a, const Dual& b) {
    return made(a.value + b.value, [&](std::size_t k) { return a.by[k] + b.by[k]; });
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return made(a.value - b.value, [&](std::size_t k) { return a.by[k] - b.by[k]; });
  }
  friend Dual operator-(const Dual& a) {
    return made(-a.value, [&](std::size_t k) { return -a.by[k]; });
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return made(a.value * b.value, [&](std::size_t k) { return a.by[k] * b.value + a.value * b.by[k]; });
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = T(Scalar(1)) / b.value, quotient = a.value / b.value;
    return made(quotient, [&](std::size_t k) { return (a.by[k] - quotient * b.by[k]) * inverse; });
  }

  // With a number, which has no derivatives.
  friend Dual operator+(const Dual& a, Scalar b) { return moved(a, a.value + b); }
  friend Dual operator+(Scalar a, const Dual& b) { return moved(b, a + b.value); }
  friend Dual operator-(const Dual& a, Scalar b) { return moved(a, a.value - b); }
  friend Dual operator-(Scalar a, const Dual& b) { return a + -b; }
  friend Dual operator*(const Dual& a, Scalar b) {
    return made(a.value * b, [&](std::size_t k) { return a.by[k] * b; });
  }
  friend Dual operator*(Scalar a, const Dual& b) { return b * a; }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend MaskOf<T> operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend MaskOf<T> operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend MaskOf<T> operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend MaskOf<T> operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }
  friend MaskOf<T> operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend MaskOf<T> operator!=(const Dual& a, const Dual& b) { return a.value != b.value; }
  friend Dual select(const MaskOf<T>& mask, const Dual& a, const Dual& b) {
    using leapmap::select;
    return made(select(mask, a.value, b.value),
                [&](std::size_t k) { return select(mask, a.by[k], b.by[k]); });
  }

  friend Dual abs(const Dual& a) { return select(a.value < T(Scalar(0)), -a, a); }
  friend Dual floor(const Dual& a) {
    using std::floor;
    return Dual(floor(a.value));
  }
  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const T root = sqrt(a.value);
    return a.through_edge(root, T(Scalar(0.5)) / root);
  }
  friend Dual asin(const Dual& a) {
    using std::asin;
    return a.through_edge(asin(a.value), a.slope_of_arc());
  }
  friend Dual acos(const Dual& a) {
    using std::acos;
    return a.through_edge(acos(a.value), -a.slope_of_arc());
  }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const T inverse = T(Scalar(1)) / (x.value * x.value + y.value * y.value);
    return made(atan2(y.value, x.value),
                [&](std::size_t k) { return (x.value * y.by[k] - y.value * x.by[k]) * inverse; });
  }
  friend Dual exp(const Dual& a) {
    using std::exp;
    const T grown = exp(a.value);
    return a.through(grown, grown);
  }
  friend Dual reciprocal_sqrt(const Dual& a) {
    using leapmap::reciprocal_sqrt;
    const T inverse = reciprocal_sqrt(a.value);
    return a.through(inverse, T(Scalar(-0.5)) * inverse * inverse * inverse);
  }
  /// Whether the value is.
  friend bool isfinite(const Dual& a) requires std::is_same_v<T, Scalar> { return std::isfinite(a.value); }
  friend SinCos<Dual> sincos_of_small(const Dual& a) {
    using leapmap::sincos_of_small;
    const auto [s, c] = sincos_of_small(a.value);
    return {a.through(s, c), a.through(c, -s)};
  }
  friend SinCos<Dual> sincos_of(const Dual& a) {
    const auto [s, c] = sincos_of(a.value);
    return {a.through(s, c), a.through(c, -s)};
  }

 private:
  static std::array<T, N> zeros() {
    std::array<T, N> all;
    all.fill(T(Scalar(0)));
    return all;
  }
  /// With a's derivatives.
  static Dual moved(const Dual& a, const T& value) {
    Dual x(a);
    x.value = value;
    return x;
  }
  template <class Rate>
  static Dual made(const T& value, const Rate& rate) {
    Dual x(value);
    for (std::size_t k = 0; k < N; ++k) x.by[k] = rate(k);
    return x;
  }
  /// The same where the slope may be infinite: what a parameter does not act on it does not act on there
  /// either.
  Dual through_edge(const T& f, const T& slope) const {
    using leapmap::select;
    const T none(Scalar(0));
    return made(f, [&](std::size_t k) { return select(by[k] == none, none, slope * by[k]); });
  }
  /// 1 / sqrt(1 - value^2)
  T slope_of_arc() const {
    using std::sqrt;
    const T one(Scalar(1));
    return one / sqrt((one - value) * (one + value));
  }
};

/// Of the values: to and from numbers derivatives are neither loaded nor stored. Duals of numbers are lanes
/// of a dual of batches.
template <class T, std::size_t N>
struct Lanes<Dual<T, N>> : Lanes<T> {
  static Dual<T, N> load(const ScalarOf<T>* from) { return Dual<T, N>(Lanes<T>::load(from)); }
  static void store(const Dual<T, N>& dual, ScalarOf<T>* to) { Lanes<T>::store(dual.value, to); }
  static Dual<T, N> load(const Dual<ScalarOf<T>, N>* from) {
    Dual<T, N> dual(gathered<T>([&](std::size_t i) { return from[i].value; }));
    for (std::size_t k = 0; k < N; ++k)
      dual.by[k] = gathered<T>([&](std::size_t i) { return from[i].by[k]; });
    return dual;
  }
  static void store(const Dual<T, N>& dual, Dual<ScalarOf<T>, N>* to) {
    const LaneArray<T> values = lanes_of(dual.value);
    for (std::size_t i = 0; i < values.size(); ++i) to[i].value = values[i];
    for (std::size_t k = 0; k < N; ++k) {
      const LaneArray<T> by = lanes_of(dual.by[k]);
      for (std::size_t i = 0; i < by.size(); ++i) to[i].by[k] = by[i];
    }
  }
};

template <class T, std::size_t N>
struct Abreast<Dual<T, N>> {
  using Type = Dual<AbreastOf<T>, N>;
};
template <class D, class S, std::size_t N>
D abreast(const Dual<S, N>& dual) {
  return D(dual);
}
template <class T, std::size_t N>
Dual<ScalarOf<T>, N> sum_of_lanes(const Dual<T, N>& duals) {
  Dual<ScalarOf<T>, N> sum(sum_of_lanes(duals.value));
  for (std::size_t k = 0; k < N; ++k) sum.by[k] = sum_of_lanes(duals.by[k]);
  return sum;
}

template <class T>
inline constexpr bool has_derivatives = false;
template <class T, std::size_t N>
inline constexpr bool has_derivatives<Dual<T, N>> = true;

/// A number, or a dual without its derivatives.
template <class T>
const T& value_of(const T& number) {
  return number;
}
template <class T, std::size_t N>
const T& value_of(const Dual<T, N>& dual) {
  return dual.value;
}

template <class T>
using ValueOf = std::decay_t<decltype(value_of(std::declval<const T&>()))>;

/// The size of a number, and of a dual the largest among those of its value and its derivatives.
template <class T>
T largest_part(const T& number) {
  using std::abs;
  return abs(number);
}
template <class T, std::size_t N>
T largest_part(const Dual<T, N>& dual) {
  using std::abs;
  T most = abs(dual.value);
  for (const T& derivative : dual.by) most = larger(most, T(abs(derivative)));
  return most;
}

/// A number, or a dual, times a number in each lane.
template <class T>
T scaled(const T& number, const T& by) {
  return number * by;
}
template <class T, std::size_t N>
Dual<T, N> scaled(const Dual<T, N>& dual, const T& by) {
  return dual.through(dual.value * by, by);
}

/// A root x of f that was found in plain numbers, with its derivatives: f, there in duals, and its slope.
template <class T, std::size_t N>
Dual<T, N> with_derivatives(const T& root, const Dual<T, N>& f, const T& slope) {
  Dual<T, N> x(root);
  for (std::size_t k = 0; k < N; ++k) x.by[k] = -f.by[k] / slope;
  return x;
}

}  // namespace leapmap
