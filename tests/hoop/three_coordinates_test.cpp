// SPDX-License-Identifier: GPL-3.0-or-later
#include "hoop/three_coordinates.hpp"

#include <gtest/gtest.h>

#include "hoop/rolling.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

TEST(ThreeCoordinates, AtEitherReferencePointTheySayWhatOneCoordinateSays) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 2000; ++i) {
    const Hoop<double> hoop = reduce<double>(testing::random_design(random));
    const double angle = testing::uniform(random, -10.0, 30.0), spin = testing::uniform(random, -3.0, 3.0);
    const Trig<double> phi = trig(angle);
    const double acceleration = angular_acceleration(hoop, phi, spin);
    for (const double reference : {0.0, hoop.rho}) {
      const ThreeCoordinates model{hoop, reference};
      const ThreeState y = model.rolling(angle, spin);
      const ConstrainedMotion motion = model.motion(y);
      // The saddle-point system's condition is below 1e4 here; forces reach some tens of weights, their rate
      // hundreds.
      EXPECT_NEAR(motion.acceleration[2], acceleration, 1e-10);
      EXPECT_EQ(motion.acceleration, model.acceleration(y));
      EXPECT_NEAR(motion.normal_force, normal_force(hoop, phi, spin, acceleration), 1e-10);
      EXPECT_NEAR(motion.friction_force, friction_force(hoop, phi, spin, acceleration), 1e-10);
      EXPECT_NEAR(motion.normal_force_rate, normal_force_rate(hoop, phi, spin, acceleration), 1e-9);
      EXPECT_LE(model.drift(y), 1e-14) << "some ulps of a distance of 30";
    }
  }
}

TEST(ThreeCoordinates, ProjectionTakesADriftAwayAndLeavesWhatDidNotDrift) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 500; ++i) {
    const Hoop<double> hoop = reduce<double>(testing::random_design(random));
    const ThreeCoordinates model{hoop, hoop.rho};
    const ThreeState rolling =
        model.rolling(testing::uniform(random, 0.0, 12.0), testing::uniform(random, 0.0, 3.0));
    ThreeState y = rolling;
    model.project(y);
    for (std::size_t k = 0; k < y.size(); ++k) EXPECT_NEAR(y[k], rolling[k], 1e-13);
    for (double& coordinate : y) coordinate += testing::uniform(random, -1e-4, 1e-4);
    const double before = model.drift(y);
    model.project(y);
    // One Newton step: what is left is of the drift's square times the constraints' curvature.
    EXPECT_LE(model.drift(y), 1e-2 * before);
    for (std::size_t k = 0; k < y.size(); ++k) EXPECT_NEAR(y[k], rolling[k], 1e-2);
  }
}

}  // namespace
}  // namespace leapmap
