// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrate/rolling_integration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hoop/rolling.hpp"
#include "noslip/model.hpp"
#include "support/designs.hpp"
#include "support/print.hpp"

namespace leapmap {
namespace {

using testing::adaptive;

class EveryMethod : public ::testing::TestWithParam<GslStepper> {};
INSTANTIATE_TEST_SUITE_P(Gsl, EveryMethod, ::testing::ValuesIn(gsl_steppers().begin(), gsl_steppers().end()),
                         [](const auto& tested) { return std::string(tested.param.name.substr(4)); });

TEST_P(EveryMethod, SolvesThePapersHoop) {
  // The first-order method takes 1e5 steps for 1e-6; the others are asked for more.
  const double tolerance = GetParam().name == "gsl-rk1imp" ? 1e-7 : 1e-9;
  const Outcome outcome =
      testing::solve(testing::paper_hoop(), testing::unit_scene(), GetParam().name, tolerance);
  ASSERT_EQ(outcome.status, Status::jumped);
  EXPECT_EQ(outcome.candidates, 2);
  EXPECT_EQ(outcome.spurious_first_jump, 1);
  // Local errors add up over thousands of steps: some ten thousand tolerances for the low orders.
  EXPECT_NEAR(outcome.jump_time, 8.3639138031881432, 1e4 * tolerance);
  EXPECT_NEAR(outcome.jump_height, 0.98280096607011718, 1e4 * tolerance);
}

TEST_P(EveryMethod, GivesUpInBoundedTimeOnATolerancesNoDoubleCanReach) {
  IntegrationOptions options = adaptive(GetParam().name, 1e-18);
  options.max_steps = 20'000;
  const Outcome outcome = RollingIntegration(options).solve(testing::paper_hoop(), {});
  // Either GSL's error estimate is fooled and it ends with a jump, or the design is failed; it is never
  // silent.
  if (outcome.status == Status::jumped) {
    EXPECT_NEAR(outcome.jump_height, 0.98280096607011718, 1e-6);
  } else {
    EXPECT_EQ(outcome.status, Status::failed);
    EXPECT_TRUE(std::isnan(outcome.jump_height));
    EXPECT_EQ(outcome.candidates, 0);
  }
}

TEST(RollingIntegration, TwoMethodsAgreeOnRandomDesigns) {
  std::mt19937_64 random(8);
  RollingIntegration eighth(adaptive("gsl-rk8pd", 1e-12)), fifth(adaptive("gsl-rkck", 1e-12));
  for (int i = 0; i < 1500; ++i) {
    const Design design = testing::random_design(random);
    const Outcome a = eighth.solve(design, {}), b = fifth.solve(design, {});
    ASSERT_EQ(a.status, b.status) << i;
    ASSERT_EQ(a.spurious_first_jump, b.spurious_first_jump) << i;
    ASSERT_EQ(a.candidates, b.candidates) << i;
    if (a.status != Status::jumped) continue;
    EXPECT_NEAR(a.jump_height, b.jump_height, 1e-9) << i;  // rkck's global error, measured 1e-10
    EXPECT_NEAR(a.jump_time, b.jump_time, 1e-9 * a.jump_time) << i;
  }
}

TEST(RollingIntegration, PairsAreFoundAtLooseTolerancesWithLongSteps) {
  // Without looking at extrema between samples rk8pd at 1e-6 gets hundreds of such flags wrong in 10,000.
  std::mt19937_64 random(9);
  RollingIntegration tight(adaptive("gsl-rk8pd", 1e-12)), loose(adaptive("gsl-rk8pd", 1e-6));
  Scene scene;
  scene.runway = 4.0;
  for (int i = 0; i < 3000; ++i) {
    Design design;
    design.slope = testing::uniform(random, 0.1, 0.8);
    design.mass_ratio = testing::uniform(random, 0.5, 10.0);
    design.offset_ratio = testing::uniform(random, 0.3, 1.0);
    const Outcome a = tight.solve(design, scene), b = loose.solve(design, scene);
    EXPECT_EQ(a.status, b.status) << i;
    EXPECT_EQ(a.spurious_first_jump, b.spurious_first_jump) << i;
    EXPECT_EQ(a.candidates, b.candidates) << i;
  }
}

TEST(RollingIntegration, EnergyAtTheLiftOffIsThatOfTheRelease) {
  std::mt19937_64 random(10);
  RollingIntegration rolling(adaptive("gsl-rk8pd", 1e-12));
  int jumps = 0;
  for (int i = 0; i < 500; ++i) {
    const Design design = testing::random_design(random);
    const Outcome outcome = rolling.solve(design, {});
    if (outcome.status != Status::jumped) continue;
    ++jumps;
    const Hoop<double> hoop = reduce<double>(design);
    EXPECT_NEAR(rolling_energy(hoop, outcome.jump_angle, outcome.jump_spin),
                rolling_energy(hoop, design.release_angle, design.release_spin),
                1e-10);  // some hundred steps of 1e-12
    const Trig<double> phi = trig(outcome.jump_angle);
    EXPECT_NEAR(
        normal_force(hoop, phi, outcome.jump_spin, angular_acceleration(hoop, phi, outcome.jump_spin)), 0.0,
        1e-13)
        << "the lift-off is polished to rounding";
  }
  EXPECT_GT(jumps, 200);
}

TEST(RollingIntegration, AHoopThatStartsUphillTurnsRound) {
  Design design;
  design.release_spin = -0.1;
  EXPECT_EQ(testing::solve(design).status, Status::jumped);
  design.release_spin = 0.0;
  design.release_angle = 0.2;  // at rest between two angles of rest it rocks to and fro
  design.slope = 0.01;
  EXPECT_EQ(testing::solve(design).status, Status::stalled);
}

TEST(RollingIntegration, AHoopThatRocksBackStalls) {
  Design design;
  design.slope = 0.02;
  design.release_angle = 5.0;  // the mass falls through the bottom and cannot come over the top again
  const Outcome outcome = testing::solve(design);
  EXPECT_EQ(outcome.status, Status::stalled);
  EXPECT_EQ(outcome.candidates, 0);
  EXPECT_EQ(outcome.spurious_first_jump, Outcome::no_lift_off);
  EXPECT_TRUE(std::isnan(outcome.jump_time));
}

TEST(RollingIntegration, ATurningPointInsideOneLongStepIsAStallToo) {
  Design design;
  design.slope = 0.02;
  design.release_angle = 5.0;
  IntegrationOptions options = adaptive("gsl-rk8pd", 1e-10);
  options.control.fixed_step = 1.0;
  EXPECT_EQ(RollingIntegration(options).solve(design, {}).status, Status::stalled);
}

TEST(RollingIntegration, APlaneThatWouldHaveToPullAtReleaseIsAirborne) {
  Design design;
  design.release_spin = 3.0;
  EXPECT_EQ(testing::solve(design).status, Status::airborne_at_release);
}

TEST(RollingIntegration, TheRunwayEndsTheSearch) {
  Scene scene;
  const Outcome jumped = testing::solve(testing::paper_hoop(), scene);
  const double rolled = jumped.jump_distance / (2.0 * std::numbers::pi);
  EXPECT_NEAR(jumped.jump_distance, jumped.jump_angle - std::numbers::pi, 1e-14);
  scene.runway = rolled * (1.0 + 1e-9);
  EXPECT_EQ(testing::solve(testing::paper_hoop(), scene).status, Status::jumped);
  scene.runway = rolled * (1.0 - 1e-9);
  const Outcome ended = testing::solve(testing::paper_hoop(), scene);
  EXPECT_EQ(ended.status, Status::no_jump);
  EXPECT_EQ(ended.candidates, 1);
  EXPECT_EQ(ended.spurious_first_jump, 1);
}

TEST(RollingIntegration, HopHeightDecidesWhichLiftOffIsTheJump) {
  Scene scene;
  scene.hop_height = 0.0;
  const Outcome first = testing::solve(testing::paper_hoop(), scene);
  EXPECT_EQ(first.candidates, 1);
  EXPECT_EQ(first.spurious_first_jump, 0);
  EXPECT_NEAR(first.jump_height, 0.0034444672, 1e-10);
  scene.hop_height = 100.0;
  const Outcome never = testing::solve(testing::paper_hoop(), scene);
  EXPECT_EQ(never.status, Status::no_jump);
  EXPECT_GT(never.candidates, 2);
}

TEST(RollingIntegration, AHoopWithoutAPointMassNeverJumps) {
  Design design;
  design.mass_ratio = 0.0;
  const Outcome outcome = testing::solve(design);
  EXPECT_EQ(outcome.status, Status::no_jump);
  EXPECT_EQ(outcome.candidates, 0);
}

TEST(RollingIntegration, FixedStepsThatAreTooLongAreFailedOrFinished) {
  IntegrationOptions options = adaptive("gsl-rk4", 1e-10);
  for (const double step : {0.5, 2.0, 10.0, 100.0}) {
    options.control.fixed_step = step;
    options.max_steps = 10'000;
    const Outcome outcome = RollingIntegration(options).solve(testing::paper_hoop(), {});
    if (outcome.status == Status::jumped) {
      // At most the energy drift that is let pass: 5 % of 1 + the kinetic energy of 4 here, over J of order
      // one.
      EXPECT_LT(std::abs(outcome.jump_spin - 2.3312558443174480), 0.2) << step;
    } else {
      EXPECT_TRUE(std::isnan(outcome.jump_height)) << step;
    }
  }
}

TEST(RollingIntegration, LooseTolerancesAndLongStepsFailOrStayTrueNeverAbsurd) {
  std::mt19937_64 random(12);
  for (const GslStepper& stepper : gsl_steppers()) {
    for (const auto& [tolerance, fixed_step] :
         {std::pair{1e-1, 0.0}, {1e-2, 0.0}, {1e-6, 1.0}, {1e-6, 0.3}}) {
      IntegrationOptions options = adaptive(stepper.name, tolerance);
      options.control.fixed_step = fixed_step;
      options.max_steps = 2000;
      RollingIntegration rolling(options);
      for (int i = 0; i < 60; ++i) {
        const Design design = testing::random_design(random);
        const Outcome outcome = rolling.solve(design, {});
        if (outcome.status != Status::jumped) continue;
        const Hoop<double> hoop = reduce<double>(design);
        const Trig<double> phi = trig(outcome.jump_angle);
        const double force =
            normal_force(hoop, phi, outcome.jump_spin, angular_acceleration(hoop, phi, outcome.jump_spin));
        // Explicit one-step methods polish to rounding; an implicit one solves its stages, and a multistep
        // one ends its step, with an error of its own, loose as the tolerance is.
        EXPECT_NEAR(force, 0.0, stepper.multistep || stepper.implicit ? 0.1 : 1e-9)
            << stepper.name << " " << tolerance;
        const double released = rolling_energy(hoop, design.release_angle, design.release_spin);
        const double kinetic = 0.5 * contact_inertia(hoop, phi) * outcome.jump_spin * outcome.jump_spin;
        EXPECT_NEAR(rolling_energy(hoop, outcome.jump_angle, outcome.jump_spin), released,
                    0.05 * (1.0 + kinetic))
            << stepper.name << " " << tolerance;
        EXPECT_GE(outcome.jump_spin, 0.0);
      }
    }
  }
}

TEST(RollingIntegration, AMaximumThatGrazesZeroIsToldTheRightWay) {
  // The normal force is below zero and comes up to about 0 as the slope changes (found by bisection on the
  // slope).
  Design design;
  design.mass_ratio = 26.910985925928966, design.offset_ratio = 0.5790407338101254;
  design.inertia_factor = 0.5197902014240358, design.release_spin = 0.8917110704451572;
  Scene scene;
  scene.hop_height = 100.0;
  const auto motion_at = [&](double slope) {
    design.slope = slope;
    return noslip::tell_by_integration(design, scene, adaptive("gsl-rk8pd", 1e-13), 0.0, 1e-2);
  };
  double low = 0.210, high = 0.212;
  const std::size_t at_low = motion_at(low).candidates.size(), at_high = motion_at(high).candidates.size();
  ASSERT_NE(at_low, at_high);
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (motion_at(middle).candidates.size() == at_low ? low : high) = middle;
  }
  for (const double slope : {low, high}) {
    const Motion motion = motion_at(slope);
    const auto graze =
        std::ranges::min_element(motion.grazes, {}, [](const Graze& g) { return std::abs(g.normal_force); });
    ASSERT_NE(graze, motion.grazes.end());
    EXPECT_LT(std::abs(graze->normal_force), 1e-6);
    EXPECT_EQ(graze->makes_lift_off(), motion.candidates.size() == std::max(at_low, at_high)) << slope;
  }
}

TEST(RollingIntegration, TooFewStepsAreAFailureNotANumber) {
  IntegrationOptions options = adaptive("gsl-rk8pd", 1e-10);
  options.max_steps = 5;
  const Outcome outcome = RollingIntegration(options).solve(testing::paper_hoop(), {});
  EXPECT_EQ(outcome.status, Status::failed);
  EXPECT_TRUE(std::isnan(outcome.jump_height));
}

TEST(RollingIntegration, AWorkspaceGivesTheSameBitsWhateverItSolvedBefore) {
  std::mt19937_64 random(11);
  RollingIntegration used(adaptive("gsl-rk8pd", 1e-10));
  for (int i = 0; i < 50; ++i) {
    const Design design = testing::random_design(random);
    const Outcome fresh = RollingIntegration(adaptive("gsl-rk8pd", 1e-10)).solve(design, {});
    const Outcome again = used.solve(design, {});
    EXPECT_EQ(fresh.status, again.status);
    if (fresh.status != Status::jumped) continue;
    EXPECT_EQ(fresh.jump_time, again.jump_time);
    EXPECT_EQ(fresh.jump_height, again.jump_height);
  }
}

}  // namespace
}  // namespace leapmap
