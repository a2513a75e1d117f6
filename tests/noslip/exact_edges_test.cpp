// SPDX-License-Identifier: GPL-3.0-or-later
/// The exact solver where designs sit on an edge: releases that do not set out, runway ends, grazes, hairs
/// off equilibria and stalls.
#include <gtest/gtest.h>

#include "support/exact.hpp"

namespace leapmap {
namespace {

using testing::reference, testing::relative, testing::solve_all, testing::told;

Outcome solve_one(const Design& design, const Scene& scene = {}) {
  return solve_all<Batch>({design}, scene, 1e-12)[0];
}

TEST(ExactSolver, TellsStallsAndReleasesThatDoNotSetOut) {
  Design design;
  design.slope = 0.3;
  design.release_angle = 0.0;
  design.release_spin = -0.5;
  EXPECT_EQ(solve_one(design).status, Status::stalled) << "uphill";
  design.release_spin = 0.0;
  design.release_angle = std::numbers::pi - 1.0;  // rolls back
  EXPECT_EQ(solve_one(design).status, Status::stalled);
  design.slope = 0.0;
  design.release_angle = 0.0;
  design.release_spin = 1.0;  // swings, and comes back before the top
  EXPECT_EQ(solve_one(design).status, Status::stalled);
  design.release_angle = std::numbers::pi;
  design.release_spin = 10.0;
  EXPECT_EQ(solve_one(design).status, Status::airborne_at_release);
}

TEST(ExactSolver, AHoopWithoutAnOffsetNeverLiftsOff) {
  Design design;
  design.mass_ratio = 0.0;
  EXPECT_EQ(solve_one(design).status, Status::no_jump);
  EXPECT_EQ(solve_one(design).candidates, 0);
  design.mass_ratio = 3.0;
  design.offset_ratio = 0.0;
  EXPECT_EQ(solve_one(design).status, Status::no_jump);
}

TEST(ExactSolver, TheRunwaysEndAndTheHopHeightDecideAsTheyShould) {
  const Design design = testing::paper_hoop();  // lift-offs 1.43 and 1.72 revolutions after release
  Scene scene;
  scene.runway = 1.0;
  EXPECT_EQ(solve_one(design, scene).candidates, 1) << "the first is at 0.7 revolutions";
  EXPECT_EQ(solve_one(design, scene).status, Status::no_jump);
  const double angle = 13.948749008421659 - std::numbers::pi;
  scene.runway = angle / (2.0 * std::numbers::pi) * (1.0 + 1e-12);
  EXPECT_EQ(solve_one(design, scene).status, Status::jumped);
  scene.runway *= 1.0 - 2e-12;
  EXPECT_EQ(solve_one(design, scene).status, Status::no_jump);
  scene.runway = 5.0;
  scene.hop_height = 0.0;
  EXPECT_EQ(solve_one(design, scene).candidates, 1);
  EXPECT_EQ(solve_one(design, scene).spurious_first_jump, 0);
  scene.hop_height = 0.99;
  EXPECT_GT(solve_one(design, scene).jump_height, 0.99);
}

/// At the last double beside a fold G is a few roundings below zero, above and below again.
TEST(ExactSolver, TwoFallsWithoutARiseBetweenThemAreOneLiftOff) {
  const Design design{.slope = 0.23231079335097146,
                      .mass_ratio = 1.0747589491649074,
                      .offset_ratio = 0.31454737851461906,
                      .release_angle = 3.5031155950809674,
                      .release_spin = 1.1867380068603381};
  FoundLiftOffs told;
  Outcome outcome;
  ExactSolver<double>(1e-12).solve({&design, 1}, {}, {&outcome, 1}, &told);
  EXPECT_EQ(outcome.status, Status::jumped);
  EXPECT_LE(outcome.candidates, 3) << "the graze counts once or not at all";
  EXPECT_GE(outcome.candidates, 2);
}

TEST(ExactSolver, OnAFlatPlaneItDecidesTheGrazeAtMassRatio13AHairFromEitherSide) {
  // Released at rest a hair past the top, N grazes zero where the cosine from the top is -5/13.
  Design design;
  design.slope = 0.0;
  design.release_angle = std::numbers::pi + 1e-6;
  Scene scene;
  scene.runway = 0.6;
  scene.hop_height = 0.0;
  for (const double distance : {1e-4, 1e-8, 1e-11}) {
    design.mass_ratio = 13.0 * (1.0 + distance);
    EXPECT_EQ(solve_one(design, scene).candidates, 1) << distance;
    design.mass_ratio = 13.0 * (1.0 - distance);
    EXPECT_EQ(solve_one(design, scene).candidates, 0) << distance;
  }
}

TEST(ExactSolver, AReleaseAHairPastTheUnstableEquilibriumLiftsOffWhateverTheHair) {
  // Each tenth of the hair adds a constant to the time: the motion grows exponentially from it.
  Design design;
  const double equilibrium =
      std::numbers::pi - std::asin(std::sin(design.slope) / (20.0 / 28.2)) - design.slope;
  std::vector<double> times;
  for (const double hair : {1e-3, 1e-5, 1e-7, 1e-9}) {
    design.release_angle = equilibrium + hair;
    const Outcome outcome = solve_one(design, testing::unit_scene());
    EXPECT_EQ(outcome.status, Status::jumped) << hair;
    times.push_back(outcome.jump_time);
  }
  const double step = times[1] - times[0];
  EXPECT_GT(step, 1.0);
  EXPECT_NEAR(times[2] - times[1], step, 1e-3);  // the constant is reached like the hair itself
  EXPECT_NEAR(times[3] - times[2], step, 1e-3);
}

/// Designs on which earlier versions, or other methods, went wrong.
TEST(ExactSolver, ALooseToleranceMissesNoSpikeOfTheTime) {
  const std::vector<std::pair<double, Design>> cases{
      {1e-3,
       {0.4699780057964516, 1898.4783603414612, 0.86578748422260754, 0.5, -0.40628755222287083,
        2.3911550967083923}},
      {1e-2,
       {0.54865600114787505, 2.2472453901810825, 0.99999998993881134, 0.93698486119555513,
        0.99039440216520469, 0.37573276662727711}},
      {1e-1,
       {2.2194412131503659e-09, 11.368102906201514, 0.99999093189518418, 8.9521227717562928e-06,
        3.1223786397434963, 0.0095034009349929428}},
      {1e-3,
       {0.60160982562145282, 6.9082059410512677, 1.0, 0.0, -10.731207624221467, 9.3458654851786261e-12}},
      {1e-10,
       {1.2119473583694391, 11.694154552151653, 1.0, 77760615433.56958, 6.0914227265803866,
        229.6010602045499}}};
  for (const auto& [tolerance, design] : cases) {
    const Outcome ours = solve_all<Batch>({design}, Scene{}, tolerance)[0],
                  truth = reference({design}, Scene{})[0];
    EXPECT_TRUE(same_flags(ours, truth)) << told(design);
    EXPECT_LE(relative(ours.first_jump_time, truth.first_jump_time), tolerance) << told(design);
  }
}

TEST(ExactSolver, AHairFromAStallItEndsWithANumberOrWithFailed) {
  std::vector<Design> designs;
  Design paper = testing::paper_hoop();
  for (const auto& [angle, spin] : {std::pair{1.0, 0.65103936160503106}, {1000.0, 0.66965809370612239}}) {
    paper.release_angle = angle;
    for (const double nudge : {-1e-12, -1e-15, 0.0, 1e-15, 1e-12, 1e-9}) {
      paper.release_spin = spin * (1.0 + nudge);
      designs.push_back(paper);
    }
  }
  designs.push_back(
      {0.16133632270881876, 98954864695.251709, 1.0, 0.5, 2.3528226500176368, 0.24533301874889513});
  designs.push_back({0.1232432324299282, 106.00316768436441, 1.0, 0.5, 350585.7845222436, 1.118e-11});
  designs.push_back(
      {0.267092567604634, 15783130.56, 0.99999999751976365, 1.0, 2.6074075003662545, 3.8457e-11});
  for (const double tolerance : {1e-3, 1e-10, 1e-15}) {
    for (const Outcome& o : solve_all<Batch>(designs, Scene{}, tolerance)) {
      EXPECT_TRUE(o.status == Status::failed || o.candidates == 0 || std::isfinite(o.first_jump_time));
      EXPECT_TRUE(o.status != Status::jumped || std::isfinite(o.jump_time));
    }
  }
}

TEST(ExactSolver, AFlightThatNeverClearsThePlaneHasNoDipEvenIfItCountsAsTheJump) {
  const Design design{0.3190873, 150914.0, 0.61935165, 0.57923, -0.449154, 1.5};
  Scene scene;
  scene.hop_height = 0.0;
  const Outcome outcome = solve_one(design, scene);
  ASSERT_EQ(outcome.status, Status::jumped);
  EXPECT_EQ(outcome.jump_height, 0.0);
  EXPECT_EQ(outcome.dip, 0.0);
  EXPECT_EQ(outcome.flight_time, 0.0);
}

}  // namespace
}  // namespace leapmap
