// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/root.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace leapmap {
namespace {

TEST(PolishRoot, FindsASimpleRootToTheLastDigitsFromEitherSide) {
  int evaluations = 0;
  const auto f = [&](double x) {
    ++evaluations;
    return Sample<double>{std::cos(x), -std::sin(x)};
  };
  EXPECT_NEAR(polish_root(f, 0.0, 3.0, 1.0, false, 1e-16), std::acos(0.0), 3e-16);
  EXPECT_LT(evaluations, 10) << "Newton's convergence is lost";
  const auto rising = [](double x) { return Sample<double>{std::sin(x - 1.0), std::cos(x - 1.0)}; };
  EXPECT_NEAR(polish_root(rising, 0.0, 2.0, 1.9, true, 1e-16), 1.0, 3e-16);
}

TEST(PolishRoot, StaysInItsBracketWhereNewtonWouldLeave) {
  // From 3 Newton on atan runs away.
  const auto f = [](double x) { return Sample<double>{std::atan(x), 1.0 / (1.0 + x * x)}; };
  EXPECT_NEAR(polish_root(f, -10.0, 20.0, 15.0, true, 1e-15), 0.0, 1e-15);
}

TEST(PolishRoot, ConvergesAtATripleRootAndWithAWrongDerivative) {
  const auto triple = [](double x) { return Sample<double>{std::pow(x - 0.3, 3), 3 * std::pow(x - 0.3, 2)}; };
  EXPECT_NEAR(polish_root(triple, 0.0, 1.0, 0.9, true, 1e-15), 0.3, 1e-14);
  const auto wrong = [](double x) {
    return Sample<double>{x * x - 2.0, 0.0};
  };  // no usable derivative at all
  EXPECT_NEAR(polish_root(wrong, 0.0, 2.0, 0.5, true, 1e-15), std::sqrt(2.0), 2e-15);
}

TEST(PolishRoot, AFailedEvaluationIsNeverASilentRoot) {
  const auto f = [](double x) { return Sample<double>{x > 0.4 ? NAN : x - 1.0, 1.0}; };
  EXPECT_TRUE(std::isnan(polish_root(f, 0.0, 2.0, 0.1, true, 1e-15)));
}

}  // namespace
}  // namespace leapmap
