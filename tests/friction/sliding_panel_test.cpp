// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/sliding_panel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/designs.hpp"

namespace leapmap {
namespace {

using testing::uniform;

/// A hoop whose mass may be anything, on a slope.
Hoop<double> random_hoop(std::mt19937_64& random) {
  Design design;
  design.slope = uniform(random, 0.0, 1.0);
  design.mass_ratio = std::pow(10.0, uniform(random, -1.0, 2.0));
  design.offset_ratio = uniform(random, 0.1, 1.0);
  design.inertia_factor = uniform(random, 0.5, 1.0);
  return reduce<double>(design);
}

TEST(Painleve, WhatIsSaidToKeepOffItsEdgeHasAPivotAboveZeroAtEveryAngle) {
  std::mt19937_64 random(31);
  int said = 0, true_of = 0;
  for (int i = 0; i < 3'000; ++i) {
    const Hoop<double> hoop = random_hoop(random);
    const double friction = uniform(random, -2.0, 2.0);
    double least = HUGE_VAL;
    for (int k = 0; k < 400; ++k)
      least = std::min(least, sliding_coefficients(hoop, trig(std::numbers::pi * k / 200), friction).pivot);
    true_of += least > 0.0;
    if (!keeps_off_painleve(hoop, friction)) continue;
    ++said;
    EXPECT_GT(least, 0.0) << "mu " << friction << " rho " << hoop.rho << " Ic " << hoop.Ic;
  }
  EXPECT_GT(said, true_of * 2 / 3) << "the bounds are no use if they miss most";
}

/// A state inside a panel is the end of the panel that ends there, within the tolerance that both are solved
/// to.
TEST(SlidingPanels, AStateInsideIsTheEndOfAPanelThatEndsThere) {
  constexpr double tolerance = 1e-9;
  const SlidingPanels<double> panels(tolerance);
  std::mt19937_64 random(32);
  int compared = 0, declined = 0, near_the_start = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Hoop<double> hoop = random_hoop(random);
    const double friction = uniform(random, -1.0, 1.0);
    if (!keeps_off_painleve(hoop, friction)) continue;
    ContactState<double> from;
    from.angle = uniform(random, -3.0, 3.0),
    from.spin = uniform(random, 0.0, 2.0) * (i % 2 == 0 ? 1.0 : -1.0);
    from.slip = uniform(random, 0.1, 1.0) * (friction > 0.0 ? 1.0 : -1.0);
    if (i % 3 != 0) from.time = 2.0;  // enough for a state near the panel's start to have its digits
    const double u = from.spin * from.spin;
    const SlidingPanels<double>::Slide slide{
        hoop, friction, {}, 0.0, free_normal_force(hoop, trig(from.angle), u)};
    const double rise =
        (from.spin < 0.0 ? -1.0 : 1.0) * sliding_motion(hoop, trig(from.angle), u, friction).angular;
    auto stretch = SlidingPanels<double>::stretch_of(from.spin, rise, uniform(random, 0.1, 1.2));
    SlidingPanels<double>::Panel panel;
    panels.solve_by_angle(slide, from, stretch, panel);
    if (!(panel.excess <= 1.0)) continue;
    const double place = uniform(random, 0.0, 1.0);
    const auto inside = panels.state_at(slide, from, stretch, panel, place);
    if (!inside.is_sharp) {
      ++declined;
      continue;
    }
    ++compared;
    near_the_start += place < 0.1;
    stretch.span *= place;
    panels.solve_by_angle(slide, from, stretch, panel);
    // Ten times the tolerance: tails bound errors but for a factor of some size.
    const double slack = 10 * tolerance;
    EXPECT_NEAR(inside.state.angle, panel.end.angle, 1e-14);  // a few roundings
    EXPECT_NEAR(inside.state.spin, panel.end.spin, slack);
    EXPECT_NEAR(inside.state.time, panel.end.time, slack * (1.0 + panel.end.time));
    EXPECT_NEAR(inside.state.slip, panel.end.slip, slack);
    EXPECT_NEAR(inside.state.travel, panel.end.travel, slack * (1.0 + panel.end.time));
  }
  EXPECT_GT(compared, 600);
  EXPECT_GT(near_the_start, 20);
  EXPECT_LT(declined, compared / 2);
}

}  // namespace
}  // namespace leapmap
