// SPDX-License-Identifier: GPL-3.0-or-later
/// Sine and cosine in lanes against long double, and two batches as one.
#include "numerics/sincos.hpp"

#include <gtest/gtest.h>

#include <random>

#include "numerics/wide.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

TEST(SinCos, OfABatchAndOfANumberAreGoodToTheLastPlaceOrNearZeroToRoundingsOfTheAngle) {
  std::mt19937_64 random(21);
  for (int i = 0; i < 100'000; ++i) {
    LaneArray<Batch> angles;
    for (double& angle : angles) {
      angle = std::exp2(testing::uniform(random, -30.0, 19.0)) * (random() % 2 == 0 ? 1.0 : -1.0);
      if (random() % 4 == 0)
        angle = std::round(angle) * (std::numbers::pi / 2);  // near a zero of one of them
    }
    const SinCos<Batch> found = sincos_of(Lanes<Batch>::load(angles.data()));
    const auto sines = lanes_of(found.sin), cosines = lanes_of(found.cos);
    for (std::size_t k = 0; k < batch_width; ++k) {
      const long double x = angles[k];
      // 1.6 units in the last place, as is promised; 2e-19 of the angle is for that of long double
      const auto slack = [&](long double truth) {
        return 1.6L * 2.23e-16L * std::abs(truth) + 2e-19L * std::abs(x);
      };
      EXPECT_LE(std::abs(sines[k] - std::sin(x)), slack(std::sin(x))) << angles[k];
      EXPECT_LE(std::abs(cosines[k] - std::cos(x)), slack(std::cos(x))) << angles[k];
      const SinCos<double> alone = sincos_of(angles[k]);
      EXPECT_LE(std::abs(alone.sin - std::sin(x)), slack(std::sin(x))) << angles[k];
      EXPECT_LE(std::abs(alone.cos - std::cos(x)), slack(std::cos(x))) << angles[k];
    }
  }
}

TEST(SinCos, OfABatchAndOfANumberKnowHugeAnglesAndWhatIsNoNumber) {
  for (const double angle : {1e7, -3e15, 1e300}) {
    const SinCos<Batch> found = sincos_of(Batch(angle));
    EXPECT_NEAR(lanes_of(found.sin)[0], std::sin(angle), 1e-15);  // a few roundings
    EXPECT_NEAR(lanes_of(found.cos)[batch_width - 1], std::cos(angle), 1e-15);
    EXPECT_EQ(sincos_of(angle).sin, std::sin(angle));
  }
  for (const double angle :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(std::isnan(lanes_of(sincos_of(Batch(angle)).sin)[0]) && std::isnan(sincos_of(angle).sin));
}

TEST(Wide, DoesWhatItsHalvesDo) {
  using W = WideOf<Batch>;
  std::mt19937_64 random(22);
  for (int i = 0; i < 1000; ++i) {
    LaneArray<W> a, b;
    for (double& x : a) x = testing::uniform(random, -1.0, 1.0);
    for (double& x : b) x = testing::uniform(random, -1.0, 1.0);
    const auto same = [&](const auto& f) {
      const auto wide = lanes_of(f(Lanes<W>::load(a.data()), Lanes<W>::load(b.data())));
      for (std::size_t first = 0; first < wide.size(); first += batch_width) {
        const auto half =
            lanes_of(f(Lanes<Batch>::load(a.data() + first), Lanes<Batch>::load(b.data() + first)));
        for (std::size_t k = 0; k < batch_width; ++k) EXPECT_EQ(wide[first + k], half[k]);
      }
    };
    same([](const auto& x, const auto& y) { return x * y; });
    same([](const auto& x, const auto& y) { return x / y; });
    same([](const auto& x, const auto& y) { return x + -y; });
    same([](const auto& x, const auto& y) {
      return select((x > y) & !(x == y), larger(x, y), smaller(-x, y));
    });
    same([](const auto& x, const auto& y) {
      return sqrt(abs(x)) + log(abs(x)) + floor(x * y) + acos(x) + asin(y) + atan2(x, y);
    });
    same([](const auto& x, const auto& y) { return sincos_of(x).sin * sincos_of(y).cos; });
  }
  LaneArray<W> numbers;
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<double>(k);
  const W ramp = Lanes<W>::load(numbers.data());
  EXPECT_EQ(Lanes<W>::bits(ramp < W(3.0)), 7u);
  EXPECT_TRUE(any(ramp > W(2.0 * batch_width - 1.5)) && !all(ramp > W(0.0)) && all(ramp >= W(0.0)));
}

}  // namespace
}  // namespace leapmap
