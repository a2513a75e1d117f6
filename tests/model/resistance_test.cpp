// SPDX-License-Identifier: GPL-3.0-or-later
/// A torque against the rotation while the hoop touches the plane.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "leapmap/gradient.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/trace.hpp"
#include "model/model.hpp"
#include "referee/referee.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {
namespace {

using testing::uniform;

class Resistance : public ::testing::TestWithParam<Friction> {};
INSTANTIATE_TEST_SUITE_P(BothModels, Resistance, ::testing::Values(Friction::sticking, Friction::coulomb),
                         [](const auto& model) { return std::string(model_of(model.param).name); });

Design resisted_design(std::mt19937_64& random, Friction friction) {
  Design design = testing::either_way(random, friction);
  design.resisting_torque = uniform(random, 0.0, 0.15);
  if (random() % 2 == 0) design.drive_torque = uniform(random, -0.3, 0.3);
  if (random() % 3 == 0) design.release_spin = 0.0;
  return design;
}

/// The reference solver turns the torque round with the spin itself, and shares no formula.
TEST_P(Resistance, IsWhatTheRefereeFinds) {
  std::mt19937_64 random(71);
  const Scene scene = testing::unit_scene(GetParam());
  referee::Referee referee(scene, 1e-12);
  const std::size_t count = testing::how_many(60);
  std::size_t jumps = 0, stalls = 0, reverses = 0, wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Design design = resisted_design(random, GetParam());
    const Outcome o = solve(design, scene);
    if (o.status == Status::failed) {
      reverses += o.failure && std::string(o.failure).find("reverses") != std::string::npos;
      continue;
    }
    const Outcome judged = referee.solve(design);
    if (judged.status == Status::failed) continue;
    wrong += !same_flags(o, judged);
    stalls += o.status == Status::stalled;
    if (o.status != Status::jumped || !same_flags(o, judged)) continue;
    ++jumps;
    const double grown = 1e-9 * (1.0 + std::abs(o.jump_spin));  // of an integration's error of 1e-12
    EXPECT_NEAR(o.jump_height, judged.jump_height, grown * (1.0 + o.jump_height)) << i;
    EXPECT_NEAR(o.jump_time, judged.jump_time, grown * (1.0 + o.jump_time)) << i;
    EXPECT_NEAR(o.jump_angle, judged.jump_angle, grown * (1.0 + std::abs(o.jump_angle))) << i;
    EXPECT_NEAR(o.flight_time, judged.flight_time, grown * (1.0 + o.flight_time)) << i;
  }
  EXPECT_GT(jumps, count / 5);
  EXPECT_GT(stalls + reverses, 0u);
  EXPECT_LE(wrong, count / 50) << "designs within an integration's error of an event";
}

TEST_P(Resistance, IsALesserDriveForAHoopThatNeverReverses) {
  std::mt19937_64 random(72);
  Scene scene = testing::unit_scene(GetParam());
  scene.motor_in_flight = false;
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    Design design{.slope = uniform(random, 0.2, 0.6),
                  .mass_ratio = uniform(random, 0.5, 5.0),
                  .offset_ratio = uniform(random, 0.5, 1.0),
                  .release_angle = uniform(random, 3.2, 4.0)};
    if (GetParam() == Friction::coulomb) design.mu_static = uniform(random, 0.3, 1.0);
    design.drive_torque = 0.3, design.resisting_torque = 0.3;  // so that no motor idles in flight
    Design lesser = design;
    lesser.drive_torque = lesser.resisting_torque = 0.0;
    const Outcome o = solve(design, scene), same = solve(lesser, scene);
    if (o.status != Status::jumped || same.status != Status::jumped) continue;
    ++compared;
    // 0.3 - 0.3 is 0; only the way to the direction of the release differs.
    EXPECT_NEAR(o.jump_height, same.jump_height, 1e-13 * (1.0 + same.jump_height)) << i;
    EXPECT_NEAR(o.jump_time, same.jump_time, 1e-12 * (1.0 + same.jump_time)) << i;
  }
  EXPECT_GT(compared, 50);
}

TEST_P(Resistance, HoldsAHoopThatSlopeAndMotorPushLess) {
  Scene scene = testing::unit_scene(GetParam());
  Design design{.slope = 0.1, .mass_ratio = 1.0, .release_angle = 3.2};
  if (GetParam() == Friction::coulomb) design.mu_static = 1.0;
  design.resisting_torque = 0.5;
  EXPECT_EQ(solve(design, scene).status, Status::stalled);
  design.resisting_torque = 0.0;
  EXPECT_NE(solve(design, scene).status, Status::stalled);
}

/// What is held at rest but slides is not given a torque of its own.
TEST(ResistanceAtRest, IsNotKnownWhereAHeldHoopSlides) {
  Design held{.slope = -0.22249184677905087,
              .mass_ratio = 1.4319773973024237,
              .offset_ratio = 0.5393832943930835,
              .inertia_factor = 0.743500073154723,
              .release_angle = 3.5981771270771548,
              .drive_torque = 0.22565008353774724,
              .resisting_torque = 0.15098836585453088,
              .mu_static = 0.1396679420375566,
              .mu_kinetic = 0.09145620295860407};
  const Scene scene = testing::unit_scene(Friction::coulomb);
  for (const char* method : {"exact", "gsl-rk8pd"})
    EXPECT_EQ(solve(held, scene, {.method = method}).status, Status::failed) << method;
  // Slides at once, and turns against the way in which it would roll: an integrator must see that, too.
  const Design reverses{.slope = 0.4240544443945584,
                        .mass_ratio = 1.7446677767316139,
                        .offset_ratio = 0.694511459120131,
                        .inertia_factor = 0.6251886850453716,
                        .release_angle = 2.383035199450249,
                        .drive_torque = -0.1265877748685478,
                        .resisting_torque = 0.19089243269739714,
                        .mu_static = 0.27536068390854096,
                        .mu_kinetic = 0.0391451697887068};
  for (const char* method : {"exact", "gsl-rk8pd"})
    EXPECT_EQ(solve(reverses, scene, {.method = method}).status, Status::failed) << method;
}

TEST_P(Resistance, HasAStatusWhereItWouldReverse) {
  Scene scene = testing::unit_scene(GetParam());
  Design design{.slope = 0.4, .mass_ratio = 1.0, .offset_ratio = 0.3, .release_spin = -1.0};
  if (GetParam() == Friction::coulomb) design.mu_static = 2.0;
  design.resisting_torque = 0.05;  // it rolls uphill, and down again
  const Outcome o = solve(design, scene);
  EXPECT_EQ(o.status, Status::failed);
  EXPECT_NE(std::string(o.failure).find("reverses"), std::string::npos) << o.failure;
  EXPECT_TRUE(std::isnan(o.jump_height));
  design.resisting_torque = 0.6;  // it stays where it comes to rest
  EXPECT_EQ(solve(design, scene).status, Status::stalled);
}

TEST_P(Resistance, IsTheSameInLanesByOneByIntegrationAndInTraces) {
  std::mt19937_64 random(73);
  const Scene scene = testing::unit_scene(GetParam());
  std::vector<Design> designs;
  for (int i = 0; i < 64; ++i) designs.push_back(resisted_design(random, GetParam()));
  const std::vector<Outcome> lanes = solve(designs, scene, {.threads = 1});
  int jumps = 0;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Outcome one = solve(designs[i], scene);
    ASSERT_EQ(one.status, lanes[i].status) << i;
    if (one.status != Status::jumped) continue;
    ++jumps;
    EXPECT_NEAR(one.jump_height, lanes[i].jump_height, 1e-9 * (1.0 + one.jump_height)) << i;
    EXPECT_NEAR(one.jump_time, lanes[i].jump_time, 1e-9 * one.jump_time) << i;
    EXPECT_NEAR(trace(designs[i], scene, {.interval = 0.0}).outcome.jump_height, one.jump_height,
                1e-9 * (1.0 + one.jump_height));
    const Outcome stepped = solve(designs[i], scene, {.method = "gsl-rk8pd", .tolerance = 1e-11});
    if (!same_flags(stepped, one)) continue;
    EXPECT_NEAR(stepped.jump_height, one.jump_height, 1e-7 * (1.0 + one.jump_height)) << i;
    EXPECT_NEAR(stepped.jump_time, one.jump_time, 1e-7 * one.jump_time) << i;
  }
  EXPECT_GT(jumps, 10);
}

TEST_P(Resistance, HasTheDerivativesThatDifferencesShow) {
  std::mt19937_64 random(74);
  const Scene scene = testing::unit_scene(GetParam());
  int compared = 0;
  for (int i = 0; i < 40; ++i) {
    const Design design = resisted_design(random, GetParam());
    const double step = 1e-6;
    Design more = design, less = design;
    more.resisting_torque += step, less.resisting_torque -= step;
    if (less.resisting_torque <= 0.0) continue;
    const Outcome o = solve(design, scene), up = solve(more, scene), down = solve(less, scene);
    if (o.status != Status::jumped || !same_flags(o, up) || !same_flags(o, down)) continue;
    for (double Outcome::*const of : {&Outcome::jump_height, &Outcome::jump_time, &Outcome::flight_time}) {
      const double by = gradient(design, of, scene).resisting_torque,
                   difference = (up.*of - down.*of) / (2.0 * step);
      if (std::isnan(by)) continue;
      ++compared;
      // Rounding of 1e-13 over the step, and a third derivative times its square.
      EXPECT_NEAR(by, difference, 1e-4 * (1.0 + std::abs(difference))) << i;
    }
  }
  EXPECT_GT(compared, 20);
}

TEST_P(Resistance, HasADerivativeAtNoneWhereTheHoopDoesNotReverse) {
  const Scene scene = testing::unit_scene(GetParam());
  Design forwards{.slope = 0.4, .release_angle = 3.4};
  if (GetParam() == Friction::coulomb) forwards.mu_static = 0.6;
  Design little = forwards, more = forwards;
  little.resisting_torque = 1e-6, more.resisting_torque = 2e-6;
  const double h0 = solve(forwards, scene).jump_height, h1 = solve(little, scene).jump_height,
               h2 = solve(more, scene).jump_height;
  // One-sided differences of the second order lose six of fifteen digits.
  EXPECT_NEAR(gradient(forwards, &Outcome::jump_height, scene).resisting_torque,
              (4.0 * h1 - h2 - 3.0 * h0) / 2e-6, 1e-5);
  Design uphill = forwards;
  uphill.release_angle = 3.0, uphill.release_spin = -0.6;
  ASSERT_EQ(solve(uphill, scene).status, Status::jumped);
  const Design by = gradient(uphill, &Outcome::jump_height, scene);
  EXPECT_TRUE(std::isnan(by.resisting_torque));
  EXPECT_FALSE(std::isnan(by.slope));
}

TEST_P(Resistance, CountsAmongTheEnergyThatIsLost) {
  if (GetParam() == Friction::sticking) return;  // the field is of friction
  const Scene scene = testing::unit_scene(GetParam());
  Design design{.slope = 0.4, .release_angle = 3.4, .mu_static = 10.0};
  design.resisting_torque = 0.1;
  const Outcome o = solve(design, scene);
  ASSERT_EQ(o.status, Status::jumped);
  if (o.candidates == 1 && o.slip_distance == 0.0) {
    EXPECT_NEAR(o.energy_lost, 0.1 * (o.jump_angle - design.release_angle), 1e-12);
  } else {
    EXPECT_GT(o.energy_lost, 0.1 * 0.5 * (o.jump_angle - design.release_angle));
  }
}

}  // namespace
}  // namespace leapmap
