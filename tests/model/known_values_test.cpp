// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers of rolling without slip that are known in closed form or from independent programs.
#include <gtest/gtest.h>

#include <cmath>

#include "hoop/rolling.hpp"
#include "noslip/model.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

using testing::adaptive;

// Integration at 1e-13 errs by about 1e-12 over the two revolutions to the jump; nothing here amplifies it.
constexpr double integrated = 1e-11;

TEST(KnownValues, ThePapersHoopFromRest) {
  const Motion motion =
      noslip::tell_by_integration(testing::paper_hoop(), testing::unit_scene(), adaptive("gsl-rk8pd", 1e-13));
  ASSERT_EQ(motion.candidates.size(), 2u);
  EXPECT_NEAR(motion.candidates[0].t, 6.0995372752511926, integrated);
  EXPECT_NEAR(motion.candidates[0].height, 0.0034444672, 1e-10);  // as many digits as the table has
  EXPECT_EQ(motion.outcome.status, Status::jumped);
  EXPECT_EQ(motion.outcome.spurious_first_jump, 1);
  EXPECT_EQ(motion.outcome.candidates, 2);
  EXPECT_NEAR(motion.outcome.jump_time, 8.3639138031881432, integrated);
  EXPECT_NEAR(motion.outcome.jump_angle, 13.948749008421659, integrated);
  EXPECT_NEAR(motion.outcome.jump_height, 0.98280096607011718, integrated);
  EXPECT_NEAR(motion.outcome.apex_time, 2.0366447495066650, integrated);
  EXPECT_NEAR(motion.outcome.flight_time, 3.0959138626199405, integrated);
}

TEST(KnownValues, TheSameInThePapersUnits) {
  const Scene scene;  // R = 0.041 m, g = 9.81 m/s^2
  const Outcome outcome = testing::solve(testing::paper_hoop(), scene);
  EXPECT_NEAR(outcome.jump_height, 0.98, 0.005);
  EXPECT_NEAR(outcome.apex_time, 0.1317, 5e-5);
  EXPECT_NEAR(outcome.flight_time, 0.2001, 5e-5);
}

TEST(KnownValues, TheReleaseThatPutsTheCandidatesAtThePapersTimes) {
  const Scene scene;
  const double second = time_unit(scene);
  Design design = testing::paper_hoop();
  design.release_angle = 4.515558;
  design.release_spin = 17.13540 * second;
  const Motion motion = noslip::tell_by_integration(design, scene, adaptive("gsl-rk8pd", 1e-12));
  ASSERT_EQ(motion.candidates.size(), 2u);
  // The release is given to 7 digits; the heights and times are given to the digits compared.
  EXPECT_NEAR(motion.candidates[0].t, 0.17, 1e-6);
  EXPECT_NEAR(motion.candidates[1].t, 0.32, 1e-6);
  EXPECT_NEAR(motion.candidates[0].height, 0.0074, 5e-5);
  EXPECT_NEAR(motion.outcome.jump_height, 0.9965, 5e-5);
  EXPECT_NEAR(motion.outcome.apex_time, 0.1310, 5e-5);
  EXPECT_NEAR(motion.outcome.flight_time, 0.2003, 5e-5);
}

/// A thin hoop with its mass on the rim on a flat plane, at the top with spin w0: does it ever reach N = 0?
bool ever_lifts(double rho, double spin) {
  Design design;
  design.slope = 0.0;
  design.mass_ratio = rho / (1.0 - rho);
  design.release_spin = spin;
  Scene scene;
  scene.hop_height = 0.0;
  scene.runway = 1.0;
  const Status status = testing::solve(design, scene, "gsl-rk8pd", 1e-13).status;
  return status == Status::jumped || status == Status::airborne_at_release;
}

TEST(KnownValues, OnAFlatPlaneAHoopLiftsIffItsSpinIsAboveTheClosedForm) {
  for (const double rho : {0.2, 0.35, 0.5, 0.6, 0.75, 0.9}) {
    const double square = rho <= 0.5 ? 1.0 / rho : std::sqrt(27.0 * (1.0 - rho) / (1.0 + rho)) - 1.0;
    const double threshold = std::sqrt(square);
    // 1e-9 either side of the threshold N's minimum is 1e-9 from zero, and the integration is good to 1e-12.
    EXPECT_TRUE(ever_lifts(rho, threshold * (1.0 + 1e-9))) << rho;
    EXPECT_FALSE(ever_lifts(rho, threshold * (1.0 - 1e-9))) << rho;
  }
}

TEST(KnownValues, FromRestOnAFlatPlaneItLiftsOnlyAboveAMassRatioOf13WhereNGrazesZero) {
  // Released at rest a hair past the top: closed form cos = -5/13 from the top, 112.620 degrees.
  Design design;
  design.slope = 0.0;
  design.release_angle = std::numbers::pi + 1e-6;
  Scene scene;
  scene.runway = 0.6;
  scene.hop_height = 0.0;
  for (const double side : {-1.0, 1.0}) {
    design.mass_ratio = 13.0 * (1.0 + side * 1e-8);
    const Motion motion = noslip::tell_by_integration(design, scene, adaptive("gsl-rk8pd", 1e-13), 0.0, 1e-6);
    EXPECT_EQ(motion.outcome.candidates, side > 0 ? 1 : 0) << side;
    ASSERT_EQ(motion.grazes.size(), 1u) << "the graze must be told";
    EXPECT_EQ(motion.grazes[0].normal_force<0.0, side> 0);
    // A distance of 1e-8 in the mass ratio moves the minimum by its square root at most.
    EXPECT_NEAR(motion.grazes[0].phi - std::numbers::pi, std::acos(-5.0 / 13.0), 1e-4);
    EXPECT_NEAR(std::acos(-5.0 / 13.0) * 180.0 / std::numbers::pi, 112.620, 5e-4);
  }
}

TEST(KnownValues, FromRestAtTheTopOfASlopeItNeverStallsAndWithoutEndOfTheRunwayLiftsOff) {
  std::mt19937_64 random(7);
  Scene scene;
  scene.runway = 2000.0;
  scene.hop_height = 0.0;
  for (int i = 0; i < 60; ++i) {
    Design design;
    design.slope = testing::uniform(random, 0.02, 1.4);
    design.mass_ratio = std::exp(testing::uniform(random, std::log(0.05), std::log(50.0)));
    design.offset_ratio = testing::uniform(random, 0.2, 1.0);
    EXPECT_EQ(testing::solve(design, scene, "gsl-rk8pd", 1e-9).status, Status::jumped)
        << design.slope << " " << design.mass_ratio << " " << design.offset_ratio;
  }
}

}  // namespace
}  // namespace leapmap
