// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/trace.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/rolling.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

const Story& paper_story() {
  static const Story story = tell(testing::paper_hoop(), {}, testing::adaptive("gsl-rk8pd", 1e-12), 0.01);
  return story;
}

TEST(Trace, SamplesEveryIntervalFromReleaseToLanding) {
  const Story& story = paper_story();
  const auto& points = story.points;
  EXPECT_EQ(points.front().t, 0.0);
  EXPECT_EQ(points.front().phi, std::numbers::pi);
  const double landing = story.outcome.jump_time + story.outcome.flight_time;
  EXPECT_NEAR(points.back().t, landing, 1e-12);
  // Every multiple of the interval up to the landing, the lift-off and the landing.
  EXPECT_EQ(points.size(), static_cast<std::size_t>(std::floor(landing / 0.01)) + 1 + 2);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GT(points[i].t, points[i - 1].t);
    EXPECT_LE(points[i].t - points[i - 1].t, 0.01 * (1 + 1e-9));
  }
}

TEST(Trace, RollingPointsObeyTheConstraintsAndConserveEnergy) {
  const Hoop<double> hoop = derive<double>(testing::paper_hoop());
  for (const TracePoint& point : paper_story().points) {
    if (point.phase != Phase::rolling) continue;
    EXPECT_EQ(point.y, 0.0);
    EXPECT_NEAR(point.x, point.phi - std::numbers::pi, 1e-14);
    EXPECT_NEAR(rolling_energy(hoop, point.phi, point.spin), rolling_energy(hoop, std::numbers::pi, 0.0),
                1e-11);
  }
}

TEST(Trace, TheNormalForceFallsThroughZeroAtEachCandidateAndTheJumpEndsTheRolling) {
  const Story& story = paper_story();
  ASSERT_EQ(story.candidates.size(), 2u);
  for (const Candidate& candidate : story.candidates) {
    const TracePoint* before = nullptr;
    for (const TracePoint& point : story.points)
      if (point.t < candidate.lift_off.time) before = &point;
    ASSERT_NE(before, nullptr);
    EXPECT_GT(before->normal_force, 0.0);
    EXPECT_LT(before->normal_force, 0.05);
  }
  for (const TracePoint& point : story.points)
    EXPECT_EQ(point.phase, point.t <= story.outcome.jump_time ? Phase::rolling : Phase::flight);
}

TEST(Trace, FlightIsContinuousWithRollingAndReachesTheApex) {
  const Story& story = paper_story();
  double highest = 0.0, lowest = 0.0;
  for (std::size_t i = 1; i < story.points.size(); ++i) {
    const TracePoint &a = story.points[i - 1], &b = story.points[i];
    EXPECT_LT(std::abs(b.x - a.x), 0.06);  // at most 4 radii per unit of time, for 0.01
    EXPECT_LT(std::abs(b.y - a.y), 0.06);
    highest = std::max(highest, b.y / 2);
    lowest = std::min(lowest, b.y / 2);
  }
  EXPECT_NEAR(highest, story.outcome.jump_height, 1e-4);  // sampled every 0.01, curvature of order one
  EXPECT_NEAR(lowest, story.outcome.dip, 1e-4);
  EXPECT_NEAR(story.points.back().y, 0.0, 1e-12);
}

TEST(Trace, WithoutAJumpItEndsWithTheRollingAndWithoutAnIntervalItIsEmpty) {
  Design design = testing::paper_hoop();
  design.slope = 0.02;
  design.mass_ratio = 0.1;
  const Story story = tell(design, {}, testing::adaptive("gsl-rk8pd", 1e-10), 0.05);
  EXPECT_EQ(story.outcome.status, Status::no_jump);
  ASSERT_FALSE(story.points.empty());
  EXPECT_EQ(story.points.back().phase, Phase::rolling);
  EXPECT_TRUE(tell(design, {}, testing::adaptive("gsl-rk8pd", 1e-10)).points.empty());
}

}  // namespace
}  // namespace leapmap
