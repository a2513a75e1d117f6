// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/sobol_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "numerics/sobol_indices.hpp"

namespace leapmap {
namespace {

TEST(SobolPoints, FillEveryStratumOfEveryDimensionOnceInEachReplicate) {
  constexpr std::size_t each = 64;
  const SobolPoints points(10, SobolPoints::replicates * each, 7);
  for (std::size_t d = 0; d < points.dimensions(); ++d)
    for (std::size_t r = 0; r < SobolPoints::replicates; ++r) {
      std::set<int> strata;
      for (std::size_t i = 0; i < each; ++i) {
        const double u = points.column(d)[r * each + i];
        ASSERT_TRUE(u > 0.0 && u < 1.0);
        strata.insert(static_cast<int>(u * each));
      }
      EXPECT_EQ(strata.size(), each) << "dimension " << d << ", replicate " << r;
    }
}

TEST(SobolPoints, AreTheSameForTheSameSeedAndOthersForAnotherSeedOrReplicate) {
  const SobolPoints a(3, 160, 1), b(3, 160, 1), c(3, 160, 2), wider(6, 160, 1);
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t i = 0; i < 160; ++i) {
      EXPECT_EQ(a.column(d)[i], b.column(d)[i]);
      EXPECT_EQ(a.column(d)[i], wider.column(d)[i]) << "more dimensions leave the first as they are";
      EXPECT_NE(a.column(d)[i], c.column(d)[i]);
      EXPECT_NE(a.column(d)[i], a.column(d)[(i + 10) % 160]);
    }
}

/// The mean of a product over the unit cube, 1/4, is right within 1.96 errors about as often as that says.
TEST(SobolPoints, TellAnErrorThatHoldsAsOftenAsItSays) {
  constexpr int seeds = 400;
  int held = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const SobolPoints points(2, SobolPoints::replicates * 32, static_cast<std::uint64_t>(seed));
    std::array<double, SobolPoints::replicates> means{};
    std::array<std::size_t, SobolPoints::replicates> counts;
    counts.fill(points.a_replicate());
    double whole = 0.0;
    for (std::size_t i = 0; i < points.samples(); ++i) {
      const double value = points.column(0)[i] * points.column(1)[i];
      means[i / points.a_replicate()] += value / static_cast<double>(points.a_replicate());
      whole += value / static_cast<double>(points.samples());
    }
    held += std::abs(whole - 0.25) <= 1.96 * error_of(whole, means, counts);
  }
  // Of 400 trials at 95 % three standard deviations are 13.
  EXPECT_GE(held, 367);
  EXPECT_LE(held, 393);
}

TEST(SobolPoints, AnErrorFromTooFewReplicatesIsNotTold) {
  std::array<double, SobolPoints::replicates> values{};
  std::array<std::size_t, SobolPoints::replicates> counts{};
  for (std::size_t r = 0; r < 7; ++r) counts[r] = 5;
  EXPECT_TRUE(std::isnan(error_of(0.0, values, counts)));
  counts[7] = 5;
  EXPECT_EQ(error_of(0.0, values, counts), 0.0);
}

/// Ishigami's sin x + 7 sin^2 y + 0.1 z^4 sin x over [-pi, pi]^3, whose indices are known. outputs: where
/// there(x) does not hold there is none.
template <class There>
std::vector<SobolIndex> ishigami(std::size_t samples, const There& there) {
  constexpr std::size_t inputs = 3;
  const SobolPoints points(2 * inputs, samples, 3);
  std::vector<std::vector<double>> outputs;
  for (const std::vector<std::size_t>& dimensions : pick_and_freeze(inputs)) {
    outputs.emplace_back(samples);
    for (std::size_t i = 0; i < samples; ++i) {
      std::array<double, inputs> x{};
      for (std::size_t k = 0; k < inputs; ++k)
        x[k] = std::numbers::pi * (2.0 * points.column(dimensions[k])[i] - 1.0);
      outputs.back()[i] = there(x) ? std::sin(x[0]) + 7.0 * std::sin(x[1]) * std::sin(x[1]) +
                                         0.1 * std::pow(x[2], 4) * std::sin(x[0])
                                   : std::nan("");
    }
  }
  return sobol_indices(outputs);
}

TEST(SobolIndices, OfIshigamisFunctionAreTheKnownOnesWithinTheirErrors) {
  constexpr double pi4 = std::numbers::pi * std::numbers::pi * std::numbers::pi * std::numbers::pi;
  constexpr double a = 7.0, b = 0.1;
  const double v1 = 0.5 * (1.0 + b * pi4 / 5.0) * (1.0 + b * pi4 / 5.0), v2 = a * a / 8.0,
               v13 = b * b * pi4 * pi4 * 8.0 / 225.0, v = v1 + v2 + v13;
  const std::array first{v1 / v, v2 / v, 0.0}, total{(v1 + v13) / v, v2 / v, v13 / v};
  const auto indices = ishigami(SobolPoints::replicates * 1024, [](const auto&) { return true; });
  ASSERT_EQ(indices.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    // Four standard errors, none of which is larger than the sixteen thousand points of pseudo-random numbers
    // give.
    EXPECT_NEAR(indices[k].first.value, first[k], 4.0 * indices[k].first.error) << k;
    EXPECT_NEAR(indices[k].total.value, total[k], 4.0 * indices[k].total.error) << k;
    EXPECT_LT(indices[k].first.error, 0.01);
    EXPECT_LT(indices[k].total.error, 0.01);
    EXPECT_EQ(indices[k].pairs, 1.0);
  }
}

/// Without x < 0 the inputs stay independent, so that the indices are those of the function over half the
/// cube.
TEST(SobolIndices, OfAnOutputThatIsNotAlwaysThereAreAmongPairsThatAre) {
  const auto some = ishigami(SobolPoints::replicates * 4096, [](const auto& x) { return x[0] >= 0.0; });
  // x over [0, pi], where sin has the mean 2 / pi and the mean square 1 / 2.
  constexpr double pi = std::numbers::pi, pi4 = pi * pi * pi * pi;
  const double mean_z = 1.0 + 0.1 * pi4 / 5.0, square_z = 1.0 + 0.2 * pi4 / 5.0 + 0.01 * pi4 * pi4 / 9.0;
  const double mean_x = 2.0 / pi, square_x = 0.5;
  const double v2 = 49.0 / 8.0, v1 = mean_z * mean_z * (square_x - mean_x * mean_x),
               v = v2 + square_x * square_z - mean_x * mean_x * mean_z * mean_z;
  EXPECT_NEAR(some[0].pairs, 0.25, 0.01) << "two values of x, each there in half of all cases";
  EXPECT_NEAR(some[1].first.value, v2 / v, 4.0 * some[1].first.error);
  EXPECT_NEAR(some[0].first.value, v1 / v, 4.0 * some[0].first.error);
  EXPECT_LT(some[0].first.error, 0.01);
}

TEST(SobolIndices, OfWhatDoesNotVaryAreNaN) {
  const std::vector<std::vector<double>> outputs(3, std::vector<double>(160, 1.0));
  const auto indices = sobol_indices(outputs);
  EXPECT_TRUE(std::isnan(indices[0].first.value) && std::isnan(indices[0].total.value));
  EXPECT_TRUE(std::isnan(indices[0].first.error) && std::isnan(indices[0].total.error));
}

}  // namespace
}  // namespace leapmap
