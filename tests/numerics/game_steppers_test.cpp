// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/game_steppers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace leapmap {
namespace {

int oscillator(double, const double y[], double f[], void*) {
  f[0] = y[1];
  f[1] = -y[0];
  return GSL_SUCCESS;
}

/// The state of an oscillator that starts at (1, 0), after so many steps.
State<2> swing(const GslStepper& stepper, double step, int steps) {
  StepControl control;
  control.fixed_step = step;
  GslIntegrator<2> integrator(stepper, control, {&oscillator, nullptr, 2, nullptr});
  EXPECT_TRUE(integrator.start({1.0, 0.0}, step));
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(integrator.advance());
  return integrator.step().y1;
}

TEST(GameSteppers, ConvergeWithTheOrderTheyClaim) {
  for (const GslStepper& stepper : game_steppers()) {
    const auto error = [&](int steps) {
      const State<2> y = swing(stepper, 1.0 / steps, steps);
      return std::hypot(y[0] - std::cos(1.0), y[1] + std::sin(1.0));
    };
    const double order = std::log2(error(200) / error(400));
    EXPECT_NEAR(order, stepper.order, 0.05) << stepper.name;  // the next order's share at these steps
  }
}

TEST(GameSteppers, EulerGainsEnergyAndTheOthersKeepItOverAThousandPeriods) {
  for (const GslStepper& stepper : game_steppers()) {
    const State<2> y = swing(stepper, 0.05, 126'000);
    const double energy = 0.5 * (y[0] * y[0] + y[1] * y[1]);
    if (stepper.name == "euler") {
      EXPECT_GT(energy, 1e10);
    } else {
      EXPECT_NEAR(energy, 0.5, 0.02) << stepper.name;  // it swings by about a twentieth of the step
    }
  }
}

TEST(GameSteppers, RetakeAPartOfAStepByTheirOwnRule) {
  for (const GslStepper& stepper : game_steppers()) {
    StepControl control;
    control.fixed_step = 0.1;
    GslIntegrator<2> integrator(stepper, control, {&oscillator, nullptr, 2, nullptr});
    ASSERT_TRUE(integrator.start({1.0, 0.0}, 0.1) && integrator.advance());
    State<2> y;
    ASSERT_TRUE(integrator.retake(0.1, y));
    EXPECT_EQ(y, integrator.step().y1) << stepper.name;
  }
}

}  // namespace
}  // namespace leapmap
