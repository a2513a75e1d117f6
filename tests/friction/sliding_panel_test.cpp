// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/sliding_panel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

/// Slip and travel of the closed form are those of accelerations integrated step by step.
TEST(SlidingMomentum, GivesSlipAndTravelOfTheMotion) {
  std::mt19937_64 random(33);
  constexpr int steps = 400;
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    Hoop<double> hoop = random_hoop(random);
    hoop.drive = uniform(random, -0.3, 0.3);
    const double friction = uniform(random, -1.0, 1.0), h = uniform(random, 0.5, 2.0) / steps;
    if (!keeps_off_painleve(hoop, friction)) continue;
    const std::array<double, 4> from{uniform(random, -3.0, 3.0), uniform(random, -2.0, 2.0),
                                     uniform(random, -1.0, 1.0), uniform(random, -5.0, 5.0)};
    std::array<double, 4> y = from;  // angle, spin, slip, travel
    const auto rates = [&](const std::array<double, 4>& at) {
      const SlidingMotion<double> motion = sliding_motion(hoop, trig(at[0]), at[1] * at[1], friction);
      return std::array{at[1], motion.angular, motion.slip, at[2] + at[1]};
    };
    const auto moved = [](std::array<double, 4> at, const std::array<double, 4>& by, double times) {
      for (std::size_t k = 0; k < at.size(); ++k) at[k] += times * by[k];
      return at;
    };
    double fastest = 0.0;
    for (int step = 0; step < steps; ++step) {
      const auto a = rates(y), b = rates(moved(y, a, h / 2)), c = rates(moved(y, b, h / 2)),
                 d = rates(moved(y, c, h));
      for (std::size_t k = 0; k < y.size(); ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
      fastest = std::max({fastest, std::abs(y[1]), std::abs(a[1])});
    }
    if (fastest > 10.0) continue;  // beside a needle of the spin such steps are too long
    ++compared;
    const SlidingMomentum<double> momentum(hoop, friction, trig(from[0]), from[1]);
    const Trig<double> phi = trig(y[0]);
    const double time = steps * h;
    // Of the fourth order with 400 steps: some (10 h)^4 / 100 a time unit.
    EXPECT_NEAR(from[2] + momentum.slip_gained(phi, y[1], time), y[2], 1e-7);
    EXPECT_NEAR(from[3] + momentum.travelled(phi, time, from[2]), y[3], 1e-7);
  }
  EXPECT_GT(compared, 100);
}

/// Where the runway's bounds say that it is not reached, no place on the panel lies beyond it.
TEST(SlidingPanels, KeepWithinARunwayAsTheirBoundsSay) {
  const SlidingPanels<double> panels(1e-9);
  std::mt19937_64 random(34);
  int kept = 0, left = 0;
  for (int i = 0; i < 1'000; ++i) {
    const Hoop<double> hoop = random_hoop(random);
    const double friction = uniform(random, -1.0, 1.0);
    if (!keeps_off_painleve(hoop, friction)) continue;
    ContactState<double> from;
    from.angle = uniform(random, -3.0, 3.0), from.spin = uniform(random, -2.0, 2.0);
    from.travel = uniform(random, -10.0, 10.0);
    from.slip = uniform(random, 0.1, 1.0) * (friction > 0.0 ? 1.0 : -1.0);
    if (i % 2 == 1) from.spin *= 0.1;  // which may go through zero on a panel by time: the hoop turns back
    const double u = from.spin * from.spin;
    const SlidingPanels<double>::Slide slide{
        hoop, friction, {}, 0.0, free_normal_force(hoop, trig(from.angle), u)};
    const auto stretch = SlidingPanels<double>::stretch_of(from.spin, -1.0, uniform(random, 0.1, 1.2));
    SlidingPanels<double>::Panel panel;
    if (i % 2 == 0)
      panels.solve_by_angle(slide, from, stretch, panel);
    else
      panels.solve_by_time(slide, from, uniform(random, 0.05, 1.0), panel);
    if (!(panel.excess <= 1.0)) continue;
    const auto travel = panels.travel_on(panel);
    double farthest = std::max(std::abs(from.travel), std::abs(panel.end.travel));
    for (const double place : travel.value) farthest = std::max(farthest, std::abs(place));
    const PanelExtent<double> slip = extent_of<double, SlidingPanels<double>::nodes>(
        panel.slip.value, panel.slip.rate, panel.slip.start, panel.slip.end);
    // From a runway that is far longer to one that ends on the panel.
    for (const double runway : {2.0 * farthest + 10.0, farthest + 0.1, farthest, 0.5 * farthest}) {
      const bool keeps = panels.keeps_within(runway, from, panel, slip);
      EXPECT_FALSE(keeps && farthest > runway);
      keeps ? ++kept : ++left;
    }
    // By its rates, integrated, as by the closed form at its end: within ten times the tolerance.
    EXPECT_NEAR(panels.grid().integral(travel.rate), panel.end.travel - from.travel,
                1e-8 * (1.0 + panel.end.time));
  }
  EXPECT_GT(kept, 200);
  EXPECT_GT(left, 200);
}

}  // namespace
}  // namespace leapmap
