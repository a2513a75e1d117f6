// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/gradient.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "leapmap/gradient.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"
#include "support/differences.hpp"

namespace leapmap {
namespace {

using testing::uniform;
using testing::unit_scene;

/// Hoops released any way, with friction of every kind; follows: mu_kinetic is not given.
std::vector<Design> designs_with_friction(std::size_t count, bool follows) {
  std::mt19937_64 random(7);
  std::vector<Design> designs;
  for (std::size_t i = 0; i < count; ++i) {
    Design design = testing::either_way(random);
    design.mu_static = uniform(random, 0.1, 0.9);
    design.mu_kinetic =
        follows ? std::numeric_limits<double>::quiet_NaN() : design.mu_static * uniform(random, 0.5, 1.0);
    design.restitution = random() % 2 != 0 ? 0.0 : uniform(random, 0.0, 0.7);
    design.drive_torque *= random() % 2 != 0 ? 0.0 : 0.3;
    designs.push_back(design);
  }
  return designs;
}

GradientWanted everything() {
  GradientWanted wanted;
  for (const Field& field : map_fields())
    if (const auto* quantity = std::get_if<Quantity>(&field.source)) wanted.of.push_back(quantity->member);
  for (std::size_t k = 0; k < differentiable.size(); ++k) wanted.by.push_back(k);
  return wanted;
}

testing::Comparison compared(std::span<const Design> designs) {
  const Scene scene = unit_scene(Friction::coulomb);
  std::vector<Outcome> outcomes(designs.size());
  Gradients gradients(everything());
  CoulombGradients(1e-10).solve(designs, scene, outcomes, gradients);
  return testing::compare_with_differences(designs, scene, outcomes, gradients, 1e-6);
}

TEST(CoulombGradients, AgreeWithDifferencesOfLongDoublesThroughSlidesHopsAndRebounds) {
  const testing::Comparison found = compared(designs_with_friction(150, false));
  EXPECT_EQ(found.wrong, 0u) << found.first_wrong;
  EXPECT_EQ(found.missing, 0u) << found.first_missing;
  EXPECT_GT(found.compared, 6'000u);
}

TEST(CoulombGradients, ByMuStaticAreOfBothWhereMuKineticFollows) {
  const std::vector<Design> designs = designs_with_friction(100, true);
  const testing::Comparison found = compared(designs);
  EXPECT_EQ(found.wrong, 0u) << found.first_wrong;
  EXPECT_EQ(found.missing, 0u) << found.first_missing;
  EXPECT_GT(found.compared, 3'000u);
  Design equal = designs[0];
  equal.mu_kinetic = equal.mu_static;
  const Scene scene = unit_scene(Friction::coulomb);
  EXPECT_TRUE(std::isnan(gradient(equal, &Outcome::first_jump_time, scene).mu_kinetic));
}

/// A panel of a slide that resolves its values did not resolve their derivatives here: it was 6e-6 off.
TEST(CoulombGradients, AreResolvedWhereASlideNearlyStopsTurning) {
  const std::vector<Design> designs = designs_with_friction(1303, false);
  const testing::Comparison found = compared(std::span(designs).last(1));
  EXPECT_EQ(found.wrong, 0u) << found.first_wrong;
  EXPECT_GT(found.compared, 50u);
}

TEST(CoulombGradients, OfASlideFromRestByTheSpinIsOneOfTimeAndSlip) {
  const std::vector<Design> designs = designs_with_friction(166, false);
  ASSERT_EQ(designs.back().release_spin, 0.0);
  const testing::Comparison found = compared(std::span(designs).last(1));
  EXPECT_EQ(found.wrong, 0u) << found.first_wrong;
  EXPECT_GT(found.compared, 50u);
}

/// Hoops with friction whose spins are of every size from 1e-8 to 1, either way.
std::vector<Design> designs_with_small_spins(std::size_t count) {
  std::mt19937_64 random(45);
  std::vector<Design> designs;
  while (designs.size() < count) {
    Design design = testing::either_way(random);
    design.release_spin =
        std::copysign(std::pow(10.0, uniform(random, -8.0, 0.0)), uniform(random, -1.0, 1.0));
    design.mu_static = uniform(random, 0.05, 0.9);
    design.mu_kinetic = design.mu_static * uniform(random, 0.5, 1.0);
    design.restitution = random() % 2 != 0 ? 0.0 : uniform(random, 0.0, 0.7);
    designs.push_back(design);
  }
  return designs;
}

/// Where a slide sets out with next to no spin, time's derivative by it goes as the spin's inverse square:
/// panels that resolved the values missed it altogether.
TEST(CoulombGradients, AreResolvedFromSpinsOfEverySize) {
  const testing::Comparison found = compared(designs_with_small_spins(testing::how_many(300)));
  EXPECT_EQ(found.wrong, 0u) << found.first_wrong;
  EXPECT_EQ(found.missing, 0u) << found.first_missing;
  EXPECT_GT(found.compared, 1'000u);
}

TEST(CoulombGradients, AreResolvedWhereAHoopStartsToSlideWithAMillionthOfASpin) {
  const Scene scene{.friction = Friction::coulomb};
  Design design{.release_angle = 4.1, .mu_static = 0.2};
  for (const double spin : {1e-8, 1e-6, 1e-5, 2e-4, 9e-4}) {
    design.release_spin = spin;
    // From differences of the solver's own times, and from an independent integration at 1e-6.
    EXPECT_NEAR(gradient(design, &Outcome::jump_time, scene).release_spin, -0.17186, 3e-4) << spin;
  }
}

TEST(CoulombGradients, AreResolvedWhereAHoopTurnsRoundInsideASlide) {
  const Design design{.slope = 0.30637631722143877,
                      .mass_ratio = 2.483827084653167,
                      .offset_ratio = 0.5830303986127652,
                      .release_angle = 4.658042210229609,
                      .release_spin = -0.9399108160617516,
                      .mu_static = 0.10873542033895064,
                      .mu_kinetic = 0.09786187830505558};
  const Scene scene{.friction = Friction::coulomb};
  EXPECT_NEAR(gradient(design, &Outcome::jump_time, scene).mu_kinetic, -1.0760, 1e-4);
  EXPECT_NEAR(gradient(design, &Outcome::jump_height, scene).mu_kinetic, 5.1274, 1e-4);
}

/// Beside Painleve's edge accelerations are so large that derivatives at a given time are lost in their
/// roundings.
TEST(CoulombGradients, AreKnownOfASlideBesidePainlevesEdge) {
  const Design design{.slope = 0.7039494649710462,
                      .mass_ratio = 111.82781160944819,
                      .release_angle = -1.9780398189269073,
                      .mu_static = 0.525,
                      .restitution = 0.3};
  const Scene scene{.friction = Friction::coulomb};
  const auto height_at = [&](double slope) {
    Design other = design;
    other.slope = slope;
    return solve(other, scene, {.tolerance = 1e-12}).jump_height;
  };
  constexpr double step = 1e-5;
  const double difference = (height_at(design.slope + step) - height_at(design.slope - step)) / (2.0 * step);
  EXPECT_NEAR(gradient(design, &Outcome::jump_height, scene).slope, difference, 1e-6);
}

TEST(CoulombGradients, LeaveTheOutcomesAsTheyAre) {
  const Scene scene = unit_scene(Friction::coulomb);
  const std::vector<Design> designs = designs_with_friction(60, false);
  std::vector<Outcome> outcomes(designs.size());
  Gradients gradients(everything());
  CoulombGradients(1e-10).solve(designs, scene, outcomes, gradients);
  CoulombSolver<double> plain(1e-10);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Outcome outcome = plain.solve(designs[i], scene);
    EXPECT_TRUE(same_flags(outcome, outcomes[i]));
    if (outcome.status != Status::jumped) continue;
    EXPECT_EQ(outcome.jump_height, outcomes[i].jump_height);
    EXPECT_EQ(outcome.jump_time, outcomes[i].jump_time);
  }
}

}  // namespace
}  // namespace leapmap
