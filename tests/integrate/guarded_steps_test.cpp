// SPDX-License-Identifier: GPL-3.0-or-later
/// The event loop on a uniform rotation, whose events are known.
#include "integrate/guarded_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "numerics/gsl_integrator.hpp"

namespace leapmap {
namespace {

/// (phi, its rate): turns at a constant rate.
int rotation(double, const double y[], double f[], void*) {
  f[0] = y[1], f[1] = 0.0;
  return GSL_SUCCESS;
}
const gsl_odeiv2_system rotating{&rotation, nullptr, 2, nullptr};
constexpr auto angle = [](const State<2>& y) { return y[0]; };

/// cos(phi - shift), which falls through zero a quarter of a turn after the shift.
Sample<double> cosine(const State<2>& y, double shift) {
  return {std::cos(y[0] - shift), -y[1] * std::sin(y[0] - shift)};
}

TEST(GuardedSteps, TellTheFallsOfAllGuardsInOrderOfTime) {
  GslIntegrator<2> integrator(*find_gsl_stepper("gsl-rk8pd"), {1e-10, 1e-10, 0.0}, rotating);
  GuardedSteps<2> steps;
  const State<2> start{0.0, 2.0};
  const auto sample = [](std::size_t guard, const State<2>& y) { return cosine(y, guard == 0 ? 1.0 : 0.25); };
  steps.begin(start, 2, sample);
  ASSERT_TRUE(integrator.start(start, 0.1));
  std::vector<std::pair<double, std::size_t>> found;
  bool both_in_one = false;
  while (found.size() < 6) {
    ASSERT_EQ(steps.take(integrator, angle, 8.0, sample), Stepped::taken);
    for (const Event<2>& event : steps.events()) {
      found.emplace_back(integrator.step().t0 + event.tau, event.guard);
      EXPECT_NEAR(event.state[0], 2.0 * found.back().first, 1e-12);
    }
    both_in_one = both_in_one || steps.events().size() > 1;
    EXPECT_EQ(steps.now(0).value, sample(0, integrator.step().y1).value);
  }
  EXPECT_TRUE(both_in_one) << "or their order was not put to the test";
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double turns = static_cast<double>(k / 2), shift = k % 2 == 0 ? 0.25 : 1.0;
    EXPECT_EQ(found[k].second, k % 2 == 0 ? 1u : 0u);
    EXPECT_NEAR(found[k].first, 0.5 * (shift + std::numbers::pi * (0.5 + 2.0 * turns)), 1e-12);
  }
}

TEST(GuardedSteps, OfTwoFallsAtOneMomentTheFirstGuardsComesFirst) {
  GslIntegrator<2> integrator(*find_gsl_stepper("gsl-rkf45"), {1e-10, 1e-10, 0.0}, rotating);
  GuardedSteps<2> steps;
  const State<2> start{0.0, 1.0};
  const auto sample = [](std::size_t, const State<2>& y) { return cosine(y, 0.0); };
  steps.begin(start, 3, sample);
  ASSERT_TRUE(integrator.start(start, 0.1));
  do ASSERT_EQ(steps.take(integrator, angle, 8.0, sample), Stepped::taken);
  while (steps.events().empty());
  ASSERT_EQ(steps.events().size(), 3u);
  for (std::size_t guard = 0; guard < 3; ++guard) EXPECT_EQ(steps.events()[guard].guard, guard);
}

TEST(GuardedSteps, SayWhyAStepIsOfNoUse) {
  struct Method {
    bool steps, retakes;
    Step<2> taken{0.0, 1.0, {0.0, 2.0}, {2.0, 0.0}, {2.0, 2.0}, {2.0, 0.0}};
    bool advance() const { return steps; }
    const Step<2>& step() const { return taken; }
    bool retake(double tau, State<2>& y) const {
      y = {2.0 * tau, 2.0};
      return retakes;
    }
  };
  const auto sample = [](std::size_t, const State<2>& y) { return cosine(y, 0.0); };
  const auto stepped = [&](Method method) {
    GuardedSteps<2> steps;
    steps.begin(method.taken.y0, 1, sample);
    return steps.take(method, angle, 8.0, sample);
  };
  EXPECT_EQ(stepped({true, true}), Stepped::taken);
  EXPECT_EQ(stepped({false, true}), Stepped::no_step);
  EXPECT_EQ(stepped({true, false}), Stepped::no_event);
}

}  // namespace
}  // namespace leapmap
