// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/lanes.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "numerics/root.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

TEST(Lanes, BitsTellEachLaneOfAMask) {
  for (std::size_t lane = 0; lane < batch_width; ++lane) {
    LaneArray<Batch> values{};
    values[lane] = 1.0;
    EXPECT_EQ(Lanes<Batch>::bits(Lanes<Batch>::load(values.data()) > Batch(0.5)), 1u << lane);
  }
  EXPECT_EQ(Lanes<double>::bits(true), 1u);
}

TEST(Lanes, MovedUpTheFirstLaneIsTheLastOfThoseBefore) {
  LaneArray<Batch> before, lanes;
  for (std::size_t i = 0; i < lanes.size(); ++i)
    before[i] = static_cast<double>(i) - static_cast<double>(lanes.size() - 1),
    lanes[i] = static_cast<double>(i + 1);
  const auto moved = lanes_of(moved_up(Lanes<Batch>::load(before.data()), Lanes<Batch>::load(lanes.data())));
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_EQ(moved[i], static_cast<double>(i));
  EXPECT_EQ(moved_up(3.0, 5.0), 3.0);
}

TEST(Lanes, ReciprocalSquareRootIsGoodToTwoRoundings) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const double x = std::exp(testing::uniform(random, -300.0, 300.0));
    const double truth = static_cast<double>(1.0L / std::sqrt(static_cast<long double>(x)));
    EXPECT_NEAR(lanes_of(reciprocal_sqrt(Batch(x)))[0] / truth, 1.0, 4.5e-16) << x;
  }
}

TEST(Lanes, ARootSearchedInALaneDoesNotDependOnItsNeighbours) {
  // Kepler's equation with the lanes' own constants: alone, or beside harder ones.
  const auto solve = [](const LaneArray<Batch>& m) {
    const Batch mean = Lanes<Batch>::load(m.data());
    const auto f = [&](const Batch& x) {
      const SinCos<Batch> t = sincos_of(x);
      return CurvedSample<Batch>{x - Batch(0.9) * t.sin - mean, Batch(1.0) - Batch(0.9) * t.cos,
                                 Batch(0.9) * t.sin, Batch(0.9) * t.cos};
    };
    return lanes_of(
        polish_root(f, mean - Batch(1.0), mean + Batch(1.0), mean, mean == mean, Batch(1e-15), mean == mean));
  };
  LaneArray<Batch> same, mixed;
  same.fill(0.3);
  for (std::size_t i = 0; i < batch_width; ++i) mixed[i] = 0.3 + 1e-3 * static_cast<double>(i * i);
  EXPECT_EQ(solve(same)[0], solve(mixed)[0]);
  for (std::size_t i = 0; i < batch_width; ++i) {
    const double x = solve(mixed)[i];
    EXPECT_NEAR(x - 0.9 * std::sin(x), mixed[i], 3e-16);
  }
}

}  // namespace
}  // namespace leapmap
