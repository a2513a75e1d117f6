// SPDX-License-Identifier: GPL-3.0-or-later
/// The exponential in lanes against long double.
#include "numerics/exponential.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "numerics/lanes.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

double of_a_lane(double x) { return lanes_of(exponential(Batch(x)))[0]; }

TEST(Exponential, OfABatchIsGoodToTwoUnitsInTheLastPlace) {
  std::mt19937_64 random(5);
  for (const double range : {1e-9, 0.3, 1.0, 40.0, 708.0})
    for (int i = 0; i < 20'000; ++i) {
      LaneArray<Batch> at;
      for (double& x : at) x = testing::uniform(random, -range, range);
      const auto found = lanes_of(exponential(Lanes<Batch>::load(at.data())));
      for (std::size_t k = 0; k < batch_width; ++k) {
        const long double truth = std::exp(static_cast<long double>(at[k]));
        const double unit = std::ldexp(1.0, std::ilogb(static_cast<double>(truth)) - 52);
        EXPECT_LE(std::abs(found[k] - truth), 2.0L * unit) << at[k];
      }
    }
  EXPECT_EQ(of_a_lane(0.0), 1.0);
}

TEST(Exponential, OfABatchEndsWhereNumbersDo) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(of_a_lane(710.0), of_a_lane(708.0));
  EXPECT_EQ(of_a_lane(infinity), of_a_lane(708.0));
  EXPECT_EQ(of_a_lane(-infinity), of_a_lane(-708.0));
  EXPECT_GT(of_a_lane(-708.0), 0.0);
  EXPECT_TRUE(std::isnan(of_a_lane(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace leapmap
