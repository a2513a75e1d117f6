// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hoop/rolling.hpp"
#include "model/model.hpp"
#include "noslip/model.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

const Motion& paper_motion() {
  static const Motion motion = noslip::tell_by_integration(testing::paper_hoop(), testing::unit_scene(),
                                                           testing::adaptive("gsl-rk8pd", 1e-12), 0.01);
  return motion;
}

TEST(Motion, SamplesEveryIntervalFromReleaseToLanding) {
  const Motion& motion = paper_motion();
  const auto& points = motion.points;
  EXPECT_EQ(points.front().t, 0.0);
  EXPECT_EQ(points.front().phi, std::numbers::pi);
  const double landing = motion.outcome.jump_time + motion.outcome.flight_time;
  EXPECT_NEAR(points.back().t, landing, 1e-12);
  // Every multiple of the interval up to the landing, the lift-off and the landing.
  EXPECT_EQ(points.size(), static_cast<std::size_t>(std::floor(landing / 0.01)) + 1 + 2);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GT(points[i].t, points[i - 1].t);
    EXPECT_LE(points[i].t - points[i - 1].t, 0.01 * (1 + 1e-9));
  }
}

TEST(Motion, RollingPointsObeyTheConstraintsAndConserveEnergy) {
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  for (const MotionPoint& point : paper_motion().points) {
    if (point.phase != Phase::rolling) continue;
    EXPECT_EQ(point.y, 0.0);
    EXPECT_NEAR(point.x, point.phi - std::numbers::pi, 1e-14);
    EXPECT_NEAR(rolling_energy(hoop, point.phi, point.spin), rolling_energy(hoop, std::numbers::pi, 0.0),
                1e-11);
  }
}

TEST(Motion, TheNormalForceFallsThroughZeroAtEachCandidateAndTheJumpEndsTheRolling) {
  const Motion& motion = paper_motion();
  ASSERT_EQ(motion.candidates.size(), 2u);
  for (const Candidate& candidate : motion.candidates) {
    const MotionPoint* before = nullptr;
    for (const MotionPoint& point : motion.points)
      if (point.t < candidate.t) before = &point;
    ASSERT_NE(before, nullptr);
    EXPECT_GT(before->normal_force, 0.0);
    EXPECT_LT(before->normal_force, 0.05);
  }
  for (const MotionPoint& point : motion.points)
    EXPECT_EQ(point.phase, point.t <= motion.outcome.jump_time ? Phase::rolling : Phase::flight);
}

TEST(Motion, FlightIsContinuousWithRollingAndReachesTheApex) {
  const Motion& motion = paper_motion();
  double highest = 0.0, lowest = 0.0;
  for (std::size_t i = 1; i < motion.points.size(); ++i) {
    const MotionPoint &a = motion.points[i - 1], &b = motion.points[i];
    EXPECT_LT(std::abs(b.x - a.x), 0.06);  // at most 4 radii per unit of time, for 0.01
    EXPECT_LT(std::abs(b.y - a.y), 0.06);
    highest = std::max(highest, b.y / 2);
    lowest = std::min(lowest, b.y / 2);
  }
  EXPECT_NEAR(highest, motion.outcome.jump_height, 1e-4);  // sampled every 0.01, curvature of order one
  EXPECT_NEAR(lowest, motion.outcome.dip, 1e-4);
  EXPECT_NEAR(motion.points.back().y, 0.0, 1e-12);
}

TEST(Motion, WithoutAJumpItEndsWithTheRollingAndWithoutAnIntervalItIsEmpty) {
  Design design = testing::paper_hoop();
  design.slope = 0.02;
  design.mass_ratio = 0.1;
  const Motion motion =
      noslip::tell_by_integration(design, testing::unit_scene(), testing::adaptive("gsl-rk8pd", 1e-10), 0.05);
  EXPECT_EQ(motion.outcome.status, Status::no_jump);
  ASSERT_FALSE(motion.points.empty());
  EXPECT_EQ(motion.points.back().phase, Phase::rolling);
  EXPECT_TRUE(
      noslip::tell_by_integration(design, testing::unit_scene(), testing::adaptive("gsl-rk8pd", 1e-10))
          .points.empty());
}

#ifdef NDEBUG
constexpr int many = 200;
#else
constexpr int many = 20;  // under sanitizers
#endif

/// The motion without an integrator beside the integrated one, both at 1e-12.
/// False: the methods do not see the same phases, and there is nothing to compare.
bool expect_the_same_motion(const Design& design, const Scene& scene, const std::string& where,
                            double looser = 1.0) {
  const Model& model = model_of(scene);
  const Motion exact = model.tell_exactly(design, scene, 1e-12, 0.05);
  const Motion integrated =
      model.tell_by_integration(design, scene, testing::adaptive("gsl-rk8pd", 1e-12), 0.05);
  if (integrated.outcome.status == Status::failed || !same_flags(exact.outcome, integrated.outcome))
    return false;
  EXPECT_EQ(exact.points.size(), integrated.points.size()) << where;
  if (exact.points.size() != integrated.points.size()) return true;
  for (std::size_t i = 0; i < exact.points.size(); ++i) {
    const MotionPoint &a = exact.points[i], &b = integrated.points[i];
    // Errors of the integration, 1e-12 a step, grow with the motion's own sensitivity.
    const double close = looser * 1e-8 * (1.0 + std::abs(b.spin) + std::abs(b.normal_force));
    EXPECT_EQ(a.phase, b.phase) << where << " point " << i;
    EXPECT_NEAR(a.t, b.t, looser * 1e-8) << where << " point " << i;
    EXPECT_NEAR(a.phi, b.phi, close) << where << " point " << i;
    EXPECT_NEAR(a.spin, b.spin, close) << where << " point " << i;
    EXPECT_NEAR(a.x, b.x, close) << where << " point " << i;
    EXPECT_NEAR(a.y, b.y, close) << where << " point " << i;
    EXPECT_NEAR(a.normal_force, b.normal_force, 10 * close) << where << " point " << i;
    EXPECT_NEAR(a.friction, b.friction, 10 * close) << where << " point " << i;
  }
  return true;
}

TEST(Motion, TheExactMotionIsTheIntegratedOneWithoutSlip) {
  EXPECT_TRUE(expect_the_same_motion(testing::paper_hoop(), testing::unit_scene(), "the paper's hoop"));
  std::mt19937_64 random(4710);
  int compared = 0;
  for (int i = 0; i < many; ++i)
    compared += expect_the_same_motion(testing::random_design(random), testing::unit_scene(),
                                       "design " + std::to_string(i));
  EXPECT_GE(compared, many * 98 / 100);
}

TEST(Motion, TheExactMotionIsTheIntegratedOneWithFriction) {
  const Scene scene = testing::unit_scene(Friction::coulomb);
  EXPECT_TRUE(expect_the_same_motion(testing::paper_hoop(), scene, "the paper's hoop"));
  std::mt19937_64 random(4711);
  int compared = 0;
  for (int i = 0; i < many; ++i) {
    Design design = testing::random_design(random);
    design.mu_static = testing::uniform(random, 0.1, 1.5);
    design.restitution = testing::uniform(random, 0.0, 0.6);
    compared += expect_the_same_motion(design, scene, "design " + std::to_string(i));
  }
  EXPECT_GE(compared, many * 95 / 100);
}

TEST(Motion, TheExactMotionHoldsWhereRollingIsHard) {
  Design needle = testing::paper_hoop();
  needle.mass_ratio = 1e6;
  needle.release_spin = 0.5;
  EXPECT_TRUE(expect_the_same_motion(needle, testing::unit_scene(), "a needle of the spin", 100.0));
  Design balanced = testing::paper_hoop();
  balanced.slope = 0.2;
  // A little past the unstable equilibrium, where rho sin(theta + phi) = sin(theta); the start's rounding
  // grows by as much.
  const Hoop<double> hoop = reduce<double>(balanced);
  balanced.release_angle = std::numbers::pi - std::asin(hoop.sin_slope / hoop.rho) - balanced.slope + 1e-6;
  EXPECT_TRUE(expect_the_same_motion(balanced, testing::unit_scene(), "beside the equilibrium", 1e3));
}

TEST(Motion, ALongRunIsSampledToItsEndInTimeThatGrowsWithItsLength) {
  Design design = testing::paper_hoop();
  design.mass_ratio = 0.05;
  Scene scene = testing::unit_scene();
  scene.hop_height = 50.0;
  scene.runway = 200.0;  // quadratic work would take minutes
  EXPECT_TRUE(expect_the_same_motion(design, scene, "200 turns", 100.0));
  const Motion motion = noslip::tell_exactly(design, scene, 1e-10, 0.05);
  ASSERT_EQ(motion.outcome.status, Status::no_jump);
  const double end = design.release_angle + 400.0 * std::numbers::pi;
  EXPECT_NEAR(motion.points.back().phi, end, 0.05 * motion.points.back().spin);
  scene.runway = 4000.0;  // more panels than one quadrature may take
  EXPECT_GT(noslip::tell_exactly(design, scene, 1e-10, 1.0).points.back().phi,
            20.0 * (end - design.release_angle) - 200.0);
}

TEST(Motion, AHoopThatRocksIsShownUntilItRepeatsItself) {
  Design design = testing::paper_hoop();
  design.slope = 0.1;
  design.release_angle = 1.0;  // rises to a stall
  design.release_spin = 0.3;
  const Motion motion = noslip::tell_exactly(design, testing::unit_scene(), 1e-10, 0.05);
  ASSERT_EQ(motion.outcome.status, Status::stalled);
  ASSERT_GT(motion.points.size(), 5u);
  int turns = 0;
  for (std::size_t i = 1; i < motion.points.size(); ++i)
    turns += (motion.points[i].spin > 0.0) != (motion.points[i - 1].spin > 0.0);
  EXPECT_EQ(turns, 2);
  // The last sample is less than 0.05 before it is back, at a spin below 0.4.
  EXPECT_NEAR(motion.points.back().phi, 1.0, 0.05 * 0.4);
  EXPECT_NEAR(motion.points.back().spin, 0.3, 0.05);
  const Hoop<double> hoop = reduce<double>(design);
  const double energy = rolling_energy(hoop, 1.0, 0.3);
  for (const MotionPoint& point : motion.points)
    ASSERT_NEAR(rolling_energy(hoop, point.phi, point.spin), energy, 1e-12) << point.t;
  design.release_spin = 0.0;
  design.slope = 0.0;
  design.release_angle = 0.0;  // at rest, and nothing pulls
  EXPECT_TRUE(noslip::tell_exactly(design, testing::unit_scene(), 1e-10, 0.05).points.empty());
}

}  // namespace
}  // namespace leapmap
