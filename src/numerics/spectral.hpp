// SPDX-License-Identifier: GPL-3.0-or-later
/// Functions on one panel by their values at Gauss-Legendre nodes: running integrals, values between the
/// nodes, and how well the nodes resolve them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "numerics/quadrature.hpp"

namespace leapmap {

/// n nodes on (0, 1). Values between and integrals up to a node are exact for polynomials of degree n - 1,
/// integrals over the whole panel up to 2 n - 1.
template <class S, std::size_t n>
struct SpectralPanel {
  using Values = std::array<S, n>;
  Values node, weight;
  std::array<Values, n>
      running;  ///< integral of the j-th cardinal polynomial from 0 to node i is running[j][i]
  Values barycentric;
  std::array<Values, 2> last;  ///< rows that give the last two Legendre coefficients

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
    for (std::size_t i = 0; i < n; ++i) node[i] = S(rule.node[i]), weight[i] = S(rule.weight[i]);
    for (std::size_t j = 0; j < n; ++j) {
      const auto at_j = legendre(rule.node[j]);
      for (std::size_t i = 0; i < n; ++i) {
        const auto at_i = legendre(rule.node[i]);
        long double sum = rule.node[i];  // k = 0: integral of 1
        for (std::size_t k = 1; k < n; ++k) sum += at_j[k] * (at_i[k + 1] - at_i[k - 1]) / 2;
        running[j][i] = S(rule.weight[j] * sum);
      }
      for (std::size_t k = 0; k < 2; ++k)
        last[k][j] = S(rule.weight[j] * at_j[n - 2 + k] * static_cast<long double>(2 * (n - 2 + k) + 1));
      const long double x = rule.node[j];
      barycentric[j] = S((j % 2 == 0 ? 1 : -1) * std::sqrt(x * (1 - x) * rule.weight[j]));
    }
  }

  /// Integrals of f from 0 to each node.
  Values integrals(const Values& f) const {
    Values sums{};
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) sums[i] += running[j][i] * f[j];
    return sums;
  }
  /// Integral of f over the panel.
  S integral(const Values& f) const {
    S sum(0);
    for (std::size_t i = 0; i < n; ++i) sum += weight[i] * f[i];
    return sum;
  }
  /// f at x in [0, 1], by the barycentric formula.
  S value(const Values& f, const S& x) const {
    S above(0), below(0);
    for (std::size_t i = 0; i < n; ++i) {
      if (x == node[i]) return f[i];
      const S share = barycentric[i] / (x - node[i]);
      above += share * f[i], below += share;
    }
    return above / below;
  }
  /// The larger of f's last two Legendre coefficients: about the error of values between the nodes, and the
  /// square root of that of the integral, both where f is of size 1.
  S tail(const Values& f) const {
    using std::abs, std::max;
    S a(0), b(0);
    for (std::size_t i = 0; i < n; ++i) a += last[0][i] * f[i], b += last[1][i] * f[i];
    return max(abs(a), abs(b));
  }
};

}  // namespace leapmap
