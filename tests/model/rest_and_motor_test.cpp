// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops that rest in an equilibrium, and hoops that their motor lifts off: what every method says of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "integrate/integration_options.hpp"
#include "model/model.hpp"
#include "referee/referee.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

using testing::uniform, testing::unit_scene;

/// A design by every method of its scene's model: exact in lanes, in long double, integrated, refereed, told.
std::vector<Outcome> by_every_method(const Design& design, const Scene& scene) {
  const Model& model = model_of(scene);
  const IntegrationOptions options = testing::adaptive("gsl-rk8pd", 1e-12);
  std::vector<Outcome> outcomes(2);
  model.exact(scene, 1e-10, {})({&design, 1}, {&outcomes[0], 1});
  model.integration(scene, options)({&design, 1}, {&outcomes[1], 1});
  outcomes.push_back(model.refined(design, scene));
  outcomes.push_back(referee::Referee(scene, 1e-12).solve(design));
  outcomes.push_back(model.tell_exactly(design, scene, 1e-10, 0.0).outcome);
  outcomes.push_back(model.tell_by_integration(design, scene, options, 0.0).outcome);
  return outcomes;
}

/// Equilibria on the level, on slopes and held by a motor, at many turns and with spins that are no motion.
TEST(Rest, InAnEquilibriumToWithinRoundingIsStalledByEveryMethod) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 40; ++i) {
    Design design{.mass_ratio = std::exp(uniform(random, -2.0, 4.0)),
                  .offset_ratio = uniform(random, 0.1, 1.0),
                  .mu_static = 3.0};  // more than any slope here needs to stick
    const double rho = design.mass_ratio / (1.0 + design.mass_ratio) * design.offset_ratio;
    const int turns = static_cast<int>(random() % 7) - 3;
    design.slope = i % 3 == 0 ? 0.0 : uniform(random, -0.9, 0.9) * std::asin(rho);
    if (i % 3 == 2) design.drive_torque = -0.8 * std::sin(design.slope);
    // sin(theta) + tau = rho sin(theta + phi), on the unstable branch
    const double balanced = std::asin((std::sin(design.slope) + design.drive_torque) / rho);
    design.release_angle = std::numbers::pi - balanced - design.slope + 2.0 * std::numbers::pi * turns;
    design.release_spin = i % 5 == 0 ? 1e-17 : 0.0;
    for (const Friction friction : {Friction::sticking, Friction::coulomb})
      for (const double hop_height : {0.0, 0.05}) {
        Scene scene = unit_scene(friction);
        scene.hop_height = hop_height;
        int method = 0;
        for (const Outcome& outcome : by_every_method(design, scene)) {
          EXPECT_EQ(outcome.status, Status::stalled) << "design " << i << " method " << method++;
          EXPECT_EQ(outcome.candidates, 0);
        }
      }
  }
}

TEST(Rest, BesideAnEquilibriumIsNoRest) {
  Design design{.slope = 0.0, .mass_ratio = 20.0};
  for (const double beside : {1e-9, 1e-12, -1e-12}) {
    design.release_angle = std::numbers::pi + beside;
    EXPECT_EQ(model_of(Friction::sticking).refined(design, unit_scene()).status, Status::jumped) << beside;
  }
}

/// A motor that idles in flight: what it alone lifted off would fly through the plane.
TEST(Motor, NoFlightWithFrictionBeginsBySinking) {
  std::mt19937_64 random(30);
  const Scene scene = testing::idle_scene(Friction::coulomb);
  const Model& model = model_of(scene);
  referee::Referee referee(scene, 1e-11);
  const std::size_t count = testing::how_many(150);
  std::size_t jumped = 0, indeterminate = 0, differ = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Design design = testing::either_way(random);
    design.drive_torque = uniform(random, -1.0, 1.0);
    design.mu_static = uniform(random, 0.1, 1.2);
    design.restitution = random() % 2 != 0 ? 0.0 : uniform(random, 0.0, 0.6);
    const Motion motion = model.tell_exactly(design, scene, 1e-10, 2e-3);
    for (const MotionPoint& point : motion.points)
      ASSERT_TRUE(point.phase != Phase::flight || point.y > -1e-9) << "design " << i << " at " << point.t;
    jumped += motion.outcome.status == Status::jumped;
    indeterminate += motion.outcome.status == Status::indeterminate;
    if (i % 10 != 0) continue;
    const Outcome judged = referee.solve(design);
    if (judged.status != Status::failed) differ += !same_flags(judged, motion.outcome);
  }
  EXPECT_GT(jumped, count / 10);
  EXPECT_GT(indeterminate, count / 100);
  // A referee's error decides otherwise right beside a change of phases.
  EXPECT_LE(differ, count / 2000);
}

TEST(Motor, AJumpThatFirstSinksIsIndeterminate) {
  const Design design{
      .slope = std::numbers::pi / 6.0, .mass_ratio = 20.0, .drive_torque = -0.3, .mu_static = 1.0};
  int method = 0;
  for (const Outcome& outcome : by_every_method(design, testing::idle_scene(Friction::coulomb)))
    EXPECT_EQ(outcome.status, Status::indeterminate) << "method " << method++;
}

}  // namespace
}  // namespace leapmap
