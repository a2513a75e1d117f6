// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/quadrature.hpp"

#include <gtest/gtest.h>

namespace leapmap {
namespace {

template <class S>
void integrates_polynomials_exactly(S tolerance) {
  for (std::size_t n = 1; n <= 96; ++n) {
    const GaussRule<S> rule = gauss_rule<S>(n);
    for (std::size_t power = 0; power < 2 * n; power += 1 + n / 4) {
      S sum(0);
      for (std::size_t i = 0; i < n; ++i) sum += rule.weight[i] * std::pow(rule.node[i], S(power));
      EXPECT_NEAR(static_cast<double>(sum * S(power + 1) - S(1)), 0.0,
                  static_cast<double>(tolerance * S(power + 1)))
          << n << " nodes, power " << power;
    }
  }
}

// A node off by a rounding changes x^p by p roundings.
TEST(GaussRule, IsExactForPolynomialsUpToTwiceItsLength) {
  integrates_polynomials_exactly<double>(7e-16);
  integrates_polynomials_exactly<long double>(2e-17L);  // some n roundings in the weights
}

TEST(GaussRule, OneNodeMoreDoesNotIntegrateTheFirstPowerBeyondItsOrder) {
  const GaussRule<double> rule = gauss_rule<double>(3);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) sum += rule.weight[i] * std::pow(rule.node[i], 6);
  EXPECT_GT(std::abs(sum - 1.0 / 7.0), 1e-5);  // the error term of x^6: (3!)^4 / (7 (6!)^2) = 3.6e-4
}

}  // namespace
}  // namespace leapmap
