// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops as made: the laws by which they are.
#include "tolerance/made_hoops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/designs.hpp"
#include "support/scattered.hpp"

namespace leapmap {
namespace {

using testing::plausible;

std::vector<Design> hoops(const Scatter& scatter, const Design& drawn) {
  MadeHoops made(scatter, {}, {}, points_of(scatter));
  made.draw(drawn);
  std::vector<Design> designs(made.samples());
  made.fill(0, designs);
  return designs;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(Scatter, HoopsAreMadeByTheLawsAskedFor) {
  Scatter scatter = plausible();
  scatter.samples = 1 << 14;
  const Design drawn{.slope = 0.4, .mass_ratio = 3.0};
  std::vector<double> slopes, squares, ratios, angles;
  for (const Design& made : hoops(scatter, drawn)) {
    slopes.push_back(made.slope), squares.push_back(std::pow(made.slope - 0.4, 2));
    ratios.push_back(std::pow(made.mass_ratio - 3.0, 2));
    angles.push_back(std::abs(made.release_angle - drawn.release_angle));
    EXPECT_EQ(made.offset_ratio, drawn.offset_ratio);
  }
  // Sobol' points of 16 thousand are right to some ten thousandths.
  EXPECT_NEAR(mean_of(slopes), 0.4, 1e-5);
  EXPECT_NEAR(std::sqrt(mean_of(squares)), degrees(1.5), 1e-4 * degrees(1.5) * 10.0);
  EXPECT_NEAR(std::sqrt(mean_of(ratios)), 0.12, 1e-3 * 0.12);
  EXPECT_NEAR(mean_of(angles), degrees(2.0), 1e-3 * degrees(2.0));
  EXPECT_LE(*std::ranges::max_element(angles), degrees(4.0) * (1.0 + 1e-12));
}

/// At L/R = 1 half of a normal law is cut off, and the mean of the rest is sqrt(2 / pi) widths below.
TEST(Scatter, LawsAreCutOffWhereAParameterMayNotBeAndTheShareIsTold) {
  const Scatter scatter{{{"offset_ratio", Spread::Law::normal, 0.01}}, 1 << 14};
  std::vector<double> ratios;
  for (const Design& made : hoops(scatter, {})) {
    EXPECT_LE(made.offset_ratio, 1.0);
    ratios.push_back(made.offset_ratio);
  }
  EXPECT_NEAR(mean_of(ratios), 1.0 - 0.01 * std::sqrt(2.0 / std::numbers::pi), 1e-5);
  MadeHoops made(scatter, {}, {}, points_of(scatter));
  EXPECT_NEAR(made.draw({}), 0.5, 1e-12);
  EXPECT_NEAR(made.draw({.offset_ratio = 0.98}), 0.5 * std::erfc(std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(made.draw({.offset_ratio = 0.5}), 0.0);
}

TEST(Scatter, EveryHoopMadeIsOneThatCanBe) {
  std::mt19937_64 random(5);
  using enum Spread::Law;
  const Scene coulomb{.friction = Friction::coulomb};
  const Scatter scatter{{{"slope", normal, 0.7},
                         {"mass_ratio", uniform, 150.0, true},
                         {"offset_ratio", uniform, 0.4},
                         {"inertia_factor", normal, 60.0, true},
                         {"mu_static", normal, 80.0, true},
                         {"restitution", uniform, 0.5}}};
  for (int i = 0; i < 100; ++i) {
    Design drawn = testing::random_design(random);
    drawn.restitution = i % 2, drawn.offset_ratio = i % 3 == 0 ? 0.0 : 1.0;
    for (const Design& made : hoops(scatter, drawn)) {
      ASSERT_TRUE(is_allowed(made, coulomb));
      ASSERT_TRUE(std::isnan(made.mu_kinetic)) << "it follows mu_static";
    }
  }
}

}  // namespace
}  // namespace leapmap
