// SPDX-License-Identifier: GPL-3.0-or-later
/// Gauss-Legendre rules of any length, on any scalar, and how long they must be.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace leapmap {

/// Nodes in (0, 1), rising, and weights that sum to 1.
template <class S>
struct GaussRule {
  std::vector<S> node, weight;
};

/// The rule of n nodes, exact for polynomials up to degree 2 n - 1: zeros of P_n by Newton's iteration.
template <class S>
GaussRule<S> gauss_rule(std::size_t n) {
  using std::abs, std::acos, std::cos;
  GaussRule<S> rule{std::vector<S>(n), std::vector<S>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    S x = cos(acos(S(-1)) * (S(i) + S(0.75L)) / (S(n) + S(0.5L)));
    S rate(1);
    for (int iteration = 0; iteration < 100; ++iteration) {
      S last(1), value = x;
      for (std::size_t k = 2; k <= n; ++k) {
        const S next = (S(2 * k - 1) * x * value - S(k - 1) * last) / S(k);
        last = value;
        value = next;
      }
      rate = n == 1 ? S(1) : S(n) * (x * value - last) / (x * x - S(1));
      const S step = value / rate;
      x -= step;
      if (abs(step) <= S(2) * std::numeric_limits<S>::epsilon()) break;
    }
    rule.node[n - 1 - i] = (S(1) + x) / S(2);
    rule.weight[n - 1 - i] = S(1) / ((S(1) - x * x) * rate * rate);
  }
  return rule;
}

}  // namespace leapmap
