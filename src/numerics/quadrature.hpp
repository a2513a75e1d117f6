// SPDX-License-Identifier: GPL-3.0-or-later
/// Gauss-Legendre rules of any length, on any scalar.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace leapmap {

/// Nodes in (0, 1), rising, and weights that sum to 1.
template <class S>
struct GaussRule {
  std::vector<S> node, weight;
};

/// The rule of n nodes, exact for polynomials up to degree 2 n - 1: zeros of P_n by Newton's iteration, in
/// long double because the weights near the ends lose some n roundings.
template <class S>
GaussRule<S> gauss_rule(std::size_t n) {
  using Wide = long double;
  GaussRule<S> rule{std::vector<S>(n), std::vector<S>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    Wide x = std::cos(std::numbers::pi_v<Wide> * (Wide(i) + 0.75L) / (Wide(n) + 0.5L));
    Wide rate = 1;
    for (int iteration = 0; iteration < 100; ++iteration) {
      Wide last = 1, value = x;
      for (std::size_t k = 2; k <= n; ++k) {
        const Wide next = (Wide(2 * k - 1) * x * value - Wide(k - 1) * last) / Wide(k);
        last = value;
        value = next;
      }
      rate = n == 1 ? Wide(1) : Wide(n) * (x * value - last) / (x * x - 1);
      const Wide step = value / rate;
      x -= step;
      if (std::abs(step) <= 2 * std::numeric_limits<Wide>::epsilon()) break;
    }
    rule.node[n - 1 - i] = S((1 + x) / 2);
    rule.weight[n - 1 - i] = S(1 / ((1 - x * x) * rate * rate));
  }
  return rule;
}

}  // namespace leapmap
