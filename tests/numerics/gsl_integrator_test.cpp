// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/gsl_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/print.hpp"

namespace leapmap {
namespace {

/// A pendulum, y'' = -sin y, with its exact energy.
int pendulum(double, const double y[], double f[], void*) {
  f[0] = y[1], f[1] = -std::sin(y[0]);
  return GSL_SUCCESS;
}
int pendulum_jacobian(double, const double y[], double* dfdy, double dfdt[], void*) {
  dfdy[0] = 0, dfdy[1] = 1, dfdy[2] = -std::cos(y[0]), dfdy[3] = 0;
  dfdt[0] = dfdt[1] = 0;
  return GSL_SUCCESS;
}
const gsl_odeiv2_system pendulum_system{&pendulum, &pendulum_jacobian, 2, nullptr};
double energy(const State<2>& y) { return 0.5 * y[1] * y[1] - std::cos(y[0]); }

/// The energy's error after rolling to time `end`.
double energy_error(const GslStepper& stepper, const StepControl& control, double end) {
  GslIntegrator<2> integrator(stepper, control, pendulum_system);
  const State<2> start{1.0, 0.5};
  if (!integrator.start(start, 1e-3)) return NAN;
  for (int i = 0; i < 2'000'000; ++i) {
    if (!integrator.advance()) return NAN;
    if (integrator.step().t0 + integrator.step().h >= end)
      return std::abs(energy(integrator.step().y1) - energy(start));
  }
  return NAN;
}

class EveryStepper : public ::testing::TestWithParam<GslStepper> {};
INSTANTIATE_TEST_SUITE_P(Gsl, EveryStepper, ::testing::ValuesIn(gsl_steppers().begin(), gsl_steppers().end()),
                         [](const auto& tested) { return std::string(tested.param.name.substr(4)); });

TEST_P(EveryStepper, IsFoundByItsName) {
  ASSERT_NE(find_gsl_stepper(GetParam().name), nullptr);
  EXPECT_EQ(find_gsl_stepper(GetParam().name)->type, GetParam().type);
}

TEST_P(EveryStepper, AdaptiveStepsKeepTheErrorNearTheTolerance) {
  // Local errors add up: over 10^4 steps to 3300 tolerances for the first-order method, to 300 for msbdf, the
  // next.
  EXPECT_LT(energy_error(GetParam(), {1e-6, 1e-6, 0.0}, 10.0), GetParam().name == "gsl-rk1imp" ? 5e-3 : 5e-4);
}

TEST_P(EveryStepper, ARestartGivesTheSameBits) {
  GslIntegrator<2> integrator(GetParam(), {1e-6, 1e-6, 0.0}, pendulum_system);
  State<2> once{}, again{};
  for (State<2>* result : {&once, &again}) {
    ASSERT_TRUE(integrator.start({1.0, 0.5}, 1e-3));
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(integrator.advance());
    *result = integrator.step().y1;
    ASSERT_TRUE(integrator.start({2.0, -0.5}, 1e-2));  // something else in between
    for (int i = 0; i < 7; ++i) ASSERT_TRUE(integrator.advance());
  }
  EXPECT_EQ(once, again);
}

TEST_P(EveryStepper, RetakingAWholeStepComesWhereTheStepCame) {
  GslIntegrator<2> integrator(GetParam(), {1e-8, 1e-8, 0.0}, pendulum_system);
  ASSERT_TRUE(integrator.start({1.0, 0.5}, 1e-3));
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(integrator.advance());
    const Step<2>& step = integrator.step();
    State<2> y;
    ASSERT_TRUE(integrator.retake(step.h, y));
    // One-step methods repeat themselves; a multistep step differs by its own error, of the tolerance's
    // order.
    EXPECT_NEAR(y[0], step.y1[0], GetParam().multistep ? 1e-6 : 1e-13);
    ASSERT_TRUE(integrator.retake(0.0, y));
    EXPECT_EQ(y, step.y0);
  }
}

TEST(GslIntegrator, FixedStepsConvergeWithTheOrderOfTheMethod) {
  const struct {
    const char* name;
    double order, step;
  } cases[] = {{"gsl-rk2", 2, 0.05},    {"gsl-rk4", 4, 0.2},   {"gsl-rkf45", 5, 0.2},
               {"gsl-rkck", 5, 0.2},    {"gsl-rk8pd", 8, 0.5}, {"gsl-rk1imp", 1, 0.01},
               {"gsl-rk2imp", 2, 0.05}, {"gsl-rk4imp", 4, 0.2}};
  for (const auto& [name, order, step] : cases) {
    // Against the same method with a 16 times smaller step, at a time every step size reaches exactly.
    const auto state_at = [&](double h) {
      GslIntegrator<2> integrator(*find_gsl_stepper(name), {1e-12, 1e-12, h}, pendulum_system);
      EXPECT_TRUE(integrator.start({1.0, 0.5}, h));
      const int steps = static_cast<int>(std::lround(4.0 / h));
      for (int i = 0; i < steps; ++i) EXPECT_TRUE(integrator.advance()) << name;
      return integrator.step().y1;
    };
    const State<2> truth = state_at(step / 16);
    const auto error_at = [&](double h) {
      const State<2> y = state_at(h);
      return std::hypot(y[0] - truth[0], y[1] - truth[1]);
    };
    const double coarse = error_at(step), fine = error_at(step / 2);
    // Half an order below: the asymptotic regime is only near, and higher observed orders are no fault.
    // rk8pd's order-8 solution is propagated, rkf45 and rkck propagate their fifth-order one.
    EXPECT_GT(std::log2(coarse / fine), order - 0.5) << name << " " << coarse << " " << fine;
  }
}

TEST(GslIntegrator, ARightHandSideThatFailsEndsTheStepWithoutAbort) {
  const gsl_odeiv2_system failing{[](double, const double y[], double f[], void*) {
                                    f[0] = 1.0;
                                    return y[0] > 0.5 ? static_cast<int>(GSL_EBADFUNC)
                                                      : static_cast<int>(GSL_SUCCESS);
                                  },
                                  nullptr, 1, nullptr};
  GslIntegrator<1> integrator(*find_gsl_stepper("gsl-rk4"), {1e-8, 1e-8, 0.1}, failing);
  ASSERT_TRUE(integrator.start({0.0}, 0.1));
  int steps = 0;
  while (steps < 100 && integrator.advance()) ++steps;
  EXPECT_LT(steps, 7);
}

TEST(GslIntegrator, AStateThatIsNoLongerFiniteEndsTheStep) {
  const gsl_odeiv2_system exploding{[](double, const double y[], double f[], void*) {
                                      f[0] = y[0] * y[0] * y[0];
                                      return static_cast<int>(GSL_SUCCESS);
                                    },
                                    nullptr, 1, nullptr};
  GslIntegrator<1> integrator(*find_gsl_stepper("gsl-rk4"), {1e-8, 1e-8, 0.5}, exploding);
  ASSERT_TRUE(integrator.start({1.0}, 0.5));
  int steps = 0;
  while (steps < 1000 && integrator.advance()) ++steps;
  EXPECT_LT(steps, 1000);
}

}  // namespace
}  // namespace leapmap
