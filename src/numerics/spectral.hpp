// SPDX-License-Identifier: GPL-3.0-or-later
/// Functions on one panel by their values at Gauss-Legendre nodes: running integrals, values between the
/// nodes, and how well the nodes resolve them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "numerics/dual.hpp"
#include "numerics/lanes.hpp"
#include "numerics/quadrature.hpp"

namespace leapmap {

/// n nodes on (0, 1) for functions of values S, numbers or duals. Values between and integrals up to a node
/// are exact for polynomials of degree n - 1, integrals over the whole panel up to 2 n - 1.
template <class S, std::size_t n>
struct SpectralPanel {
  using Number = ScalarOf<S>;
  using Numbers = std::array<Number, n>;
  using Values = std::array<S, n>;
  using T = AbreastOf<S>;  ///< nodes in lanes
  /// Nodes in a T; one where its lanes are panels of their own.
  static constexpr std::size_t width = std::is_same_v<T, S> ? 1 : Lanes<T>::count;
  static_assert(n % width == 0);
  static_assert(n % 2 == 0 && n >= 6);
  Numbers node, weight;
  std::array<Numbers, n>
      running;  ///< integral of the j-th cardinal polynomial from 0 to node i is running[j][i]
  Numbers barycentric;
  std::array<Numbers, n>
      expansion;               ///< Legendre coefficient k of the j-th cardinal polynomial is expansion[j][k]
  Numbers last, last_but_one;  ///< the last two, by j
  Numbers fourth;              ///< fourth derivatives of Legendre's polynomials at 1
  /// From each knot to the next, the knots being both ends and the nodes: a third of the way h, and what a
  /// cubic's inner coefficients in Bernstein's form may be off by for a fourth derivative of 1, h^4 / 288.
  std::array<Number, n + 1> third, bent;

  SpectralPanel() {
    const GaussRule<long double> rule = gauss_rule<long double>(n);
    // Legendre's P_k(2 x - 1) at the nodes and its integral from 0 to x, which is (P_{k+1} - P_{k-1}) / (2 (2
    // k + 1)).
    const auto legendre = [](long double x) {
      std::array<long double, n + 1> P;
      P[0] = 1, P[1] = 2 * x - 1;
      for (std::size_t k = 1; k < n; ++k) {
        const auto m = static_cast<long double>(k);
        P[k + 1] = ((2 * m + 1) * (2 * x - 1) * P[k] - m * P[k - 1]) / (m + 1);
      }
      return P;
    };
    for (std::size_t k = 0; k < n; ++k) {
      node[k] = Number(rule.node[k]), weight[k] = Number(rule.weight[k]);
      long double product = k < 4 ? 0 : 1;  // (k + 4)! / (k - 4)!
      for (std::size_t m = k < 4 ? 0 : k - 3; m <= k + 4; ++m) product *= static_cast<long double>(m);
      fourth[k] = Number(product / 24);
    }
    for (std::size_t k = 0; k <= n; ++k) {
      const long double h = (k == n ? 1 : rule.node[k]) - (k == 0 ? 0 : rule.node[k - 1]);
      third[k] = Number(h / 3), bent[k] = Number(h * h * h * h / 288);
    }
    for (std::size_t j = 0; j < n; ++j) {
      const auto at_j = legendre(rule.node[j]);
      for (std::size_t i = 0; i < n; ++i) {
        const auto at_i = legendre(rule.node[i]);
        long double sum = rule.node[i];  // k = 0: integral of 1
        for (std::size_t k = 1; k < n; ++k) sum += at_j[k] * (at_i[k + 1] - at_i[k - 1]) / 2;
        running[j][i] = Number(rule.weight[j] * sum);
      }
      for (std::size_t k = 0; k < n; ++k)
        expansion[j][k] = Number(rule.weight[j] * at_j[k] * static_cast<long double>(2 * k + 1));
      last[j] = expansion[j][n - 1], last_but_one[j] = expansion[j][n - 2];
      const long double x = rule.node[j];
      barycentric[j] = Number((j % 2 == 0 ? 1 : -1) * std::sqrt(x * (1 - x) * rule.weight[j]));
    }
    for (std::size_t j = 0; j < half; ++j)
      for (std::size_t i = 0; i < half; ++i) {
        const Number one = running[j][i], opposite = running[n - 1 - j][i];
        running_of_sums_[j][i] = (one + opposite) / 2, running_of_differences_[j][i] = (one - opposite) / 2;
      }
  }

  /// Integrals of f from 0 to each node.
  Values integrals(const Values& f) const {
    if constexpr (width > 1) {
      return product(running, f);
    } else {
      const Folded folded = fold(f);
      return integrals(folded, dot(weight, folded.sum));
    }
  }
  /// Integral of f over the panel.
  S integral(const Values& f) const { return dot(weight, f); }
  /// Both, and f's tail, for less than they cost one by one.
  struct Integrated {
    Values running;
    S whole;
    ValueOf<S> tail;
  };
  Integrated integrated(const Values& f) const {
    if constexpr (width > 1) {
      return {integrals(f), integral(f), tail(f)};
    } else {
      const Folded folded = fold(f);
      const S whole = dot(weight, folded.sum);
      return {integrals(folded, whole), whole, tail(folded)};
    }
  }
  /// f's values at node i and at as many after it as a T holds.
  static T at(const Values& f, std::size_t i) {
    if constexpr (width == 1) {
      return f[i];
    } else {
      return Lanes<T>::load(f.data() + i);
    }
  }
  static void put(const T& value, Values& f, std::size_t i) {
    if constexpr (width == 1) {
      f[i] = value;
    } else {
      Lanes<T>::store(value, f.data() + i);
    }
  }
  /// The same of numbers that all panels share.
  static T shared(const Numbers& numbers, std::size_t i) {
    if constexpr (width == 1) {
      return T(numbers[i]);
    } else {
      return Lanes<T>::load(numbers.data() + i);
    }
  }
  /// Several functions at x in [0, 1], by the barycentric formula, for little more than one of them costs.
  template <std::size_t count>
  std::array<S, count> values(const std::array<const Values*, count>& functions, const S& x) const {
    const T zero(Number(0));
    std::array<T, count> above;
    T below;
    // If x is on a node its share is infinite, and the sums are no numbers: then once more, with next to
    // nothing in place of no way at all.
    const auto add_up = [&](const auto& away_from) {
      above.fill(zero), below = zero;
      for (std::size_t i = 0; i < n; i += width) {
        const T share = shared(barycentric, i) * reciprocal(away_from(i));
        for (std::size_t k = 0; k < count; ++k) above[k] += share * at(*functions[k], i);
        below += share;
      }
    };
    add_up([&](std::size_t i) { return T(x) - shared(node, i); });
    if (!all(below - below == zero))
      add_up([&](std::size_t i) {
        const T away = T(x) - shared(node, i);
        return select(away == zero, T(Number(1e-290)), away);
      });
    std::array<S, count> there;
    for (std::size_t k = 0; k < count; ++k) there[k] = sum(above[k]) / sum(below);
    return there;
  }
  /// The longest way between neighbours among the nodes and both ends.
  Number longest_spacing() const { return node[n / 2] - node[n / 2 - 1]; }
  /// A bound of f's fourth derivative, as that of a Legendre polynomial is largest at the panel's ends, and
  /// f's tail.
  struct Roughness {
    S fourth;
    ValueOf<S> tail;
  };
  Roughness roughness(const Values& f) const {
    using std::abs;
    if constexpr (width > 1) {
      T bound(Number(0));
      const Values coefficients = product(expansion, f);
      for (std::size_t k = 0; k < n; k += width)
        bound += times(fourth.data() + k, T(abs(at(coefficients, k))));
      return {sum(bound), larger(largest_part(coefficients[n - 2]), largest_part(coefficients[n - 1]))};
    } else {
      // Of the first four there is no such derivative; and no sum waits for all those before it.
      constexpr std::size_t some = (n - 4) % 10 == 0 ? 10 : 2;
      const Folded folded = fold(f);
      std::array<S, 2> bounds;
      bounds.fill(S(Number(0)));
      std::array<S, some> coefficients;
      for (std::size_t first = 4; first < n; first += some) {
        coefficients.fill(S(Number(0)));
        for (std::size_t j = 0; j < half; ++j)
          for (std::size_t k = 0; k < some; ++k)
            coefficients[k] +=
                times(&expansion[j][first + k], k % 2 == 0 ? folded.sum[j] : folded.difference[j]);
        for (std::size_t k = 0; k < some; ++k)
          bounds[k % 2] += times(fourth.data() + first + k, S(abs(coefficients[k])));
      }
      return {bounds[0] + bounds[1],
              larger(largest_part(coefficients[some - 2]), largest_part(coefficients[some - 1]))};
    }
  }
  /// The larger of f's last two Legendre coefficients, about the error of values between the nodes. Integrals
  /// up to a place are off by about 1 / (4 n) of it. Where f is of size 1, the integral over the panel is off
  /// by about its square. Of duals, of all derivatives too.
  ValueOf<S> tail(const Values& f) const {
    return larger(largest_part(dot(last_but_one, f)), largest_part(dot(last, f)));
  }

 private:
  static constexpr std::size_t half = n / 2;
  static constexpr std::size_t rows = half % 6 == 0 ? 6 : 1;  // at once: their sums stay in registers
  using Halves = std::array<S, half>;
  /// Sums and differences of the values at x and 1 - x, for the nodes below 1/2. Of Legendre's polynomials
  /// the even ones see the sums alone, the odd ones the differences; so do their integrals, but for the whole
  /// of the sums: half of the products are left.
  struct Folded {
    Halves sum, difference;
  };
  static Folded fold(const Values& f) {
    Folded folded;
    for (std::size_t j = 0; j < half; ++j)
      folded.sum[j] = f[j] + f[n - 1 - j], folded.difference[j] = f[j] - f[n - 1 - j];
    return folded;
  }
  Values integrals(const Folded& f, const S& whole) const {
    Values values;
    for (std::size_t first = 0; first < half; first += rows) {
      std::array<S, rows> even, odd;  // about the panel's middle, of f
      even.fill(S(Number(0))), odd.fill(S(Number(0)));
      for (std::size_t j = 0; j < half; ++j)
        for (std::size_t i = 0; i < rows; ++i) {
          even[i] += times(&running_of_sums_[j][first + i], f.sum[j]);
          odd[i] += times(&running_of_differences_[j][first + i], f.difference[j]);
        }
      for (std::size_t i = 0; i < rows; ++i) {
        values[first + i] = odd[i] + even[i];
        values[n - 1 - first - i] = odd[i] + (whole - even[i]);
      }
    }
    return values;
  }
  ValueOf<S> tail(const Folded& f) const {
    return larger(largest_part(dot(last_but_one, f.sum)), largest_part(dot(last, f.difference)));
  }
  /// The sum of the matrix's columns, column j times f[j].
  static Values product(const std::array<Numbers, n>& columns, const Values& f) {
    // So many rows at once that their sums stay in registers.
    constexpr std::size_t all = n / width, rows_at_once = all <= 8 ? all : all % 8 == 0 ? 8 : 6;
    static_assert(all % rows_at_once == 0);
    Values values;
    for (std::size_t first = 0; first < all; first += rows_at_once) {
      std::array<T, rows_at_once> sums;
      sums.fill(T(Number(0)));
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < rows_at_once; ++i)
          sums[i] += times(columns[j].data() + (first + i) * width, T(f[j]));
      for (std::size_t i = 0; i < rows_at_once; ++i) put(sums[i], values, (first + i) * width);
    }
    return values;
  }
  static S sum(const T& value) {
    if constexpr (width > 1 && has_derivatives<T>) {
      return sum_of_lanes(value);
    } else if constexpr (width > 1) {
      return hadd(value);
    } else {
      return value;
    }
  }
  /// Values times as many factors.
  static T times(const Number* factors, const T& values) {
    if constexpr (has_derivatives<T>) {
      return scaled(values, Lanes<ValueOf<T>>::load(factors));
    } else if constexpr (width == 1) {
      return T(*factors) * values;
    } else {
      return Lanes<T>::load(factors) * values;
    }
  }
  static S dot(const Numbers& a, const Values& b) {
    T products(Number(0));
    for (std::size_t i = 0; i < n; i += width) products += times(a.data() + i, at(b, i));
    return sum(products);
  }
  static S dot(const Numbers& a, const Halves& b) {
    S products(Number(0));
    for (std::size_t j = 0; j < half; ++j) products += times(&a[j], b[j]);
    return products;
  }

  std::array<std::array<Number, half>, half> running_of_sums_, running_of_differences_;
};

}  // namespace leapmap
