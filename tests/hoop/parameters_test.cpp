// SPDX-License-Identifier: GPL-3.0-or-later
#include "hoop/parameters.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/designs.hpp"

namespace leapmap {
namespace {

TEST(Parameters, DerivedGroupsEqualTheirDefinitions) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Design d = testing::random_design(random);
    const Hoop<long double> hoop = reduce<long double>(d);
    const long double beta = d.mass_ratio, lambda = d.offset_ratio, kappa = d.inertia_factor;
    const long double alpha = beta / (1 + beta), rho = alpha * lambda;
    const long double J0 = kappa / (1 + beta) + alpha * lambda * lambda;
    // A few roundings of long double on numbers of order one.
    const long double tolerance = 1e-18L;
    EXPECT_LE(std::abs(hoop.rho - (rho)), tolerance);
    EXPECT_LE(std::abs(hoop.clearance - (1 - rho)), tolerance);
    EXPECT_LE(std::abs(hoop.Ic - (J0 - rho * rho)), tolerance);
    EXPECT_LE(std::abs(hoop.J_min - (J0 + 1 - 2 * rho)), tolerance);
  }
}

TEST(Parameters, LeastInertiaKeepsItsDigitsForAMassOnTheRimOfANearlyMasslessHoop) {
  Design design;
  design.mass_ratio = 1e9;
  const Hoop<double> hoop = reduce<double>(design);
  // (kappa + 1) / (1 + beta), exactly, when the mass is on the rim; two roundings.
  EXPECT_NEAR(hoop.J_min / (2.0 / (1.0 + 1e9)), 1.0, 4e-16);
  EXPECT_NEAR(hoop.Ic / ((1.0 + 1e9 / (1.0 + 1e9)) / (1.0 + 1e9)), 1.0, 4e-16);
}

TEST(Parameters, WithoutAPointMassTheHoopIsSymmetric) {
  Design design;
  design.mass_ratio = 0.0;
  const Hoop<double> hoop = reduce<double>(design);
  EXPECT_EQ(hoop.rho, 0.0);
  EXPECT_EQ(hoop.Ic, 1.0);
  EXPECT_EQ(hoop.J_min, 2.0);
}

}  // namespace
}  // namespace leapmap
