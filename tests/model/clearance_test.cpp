// SPDX-License-Identifier: GPL-3.0-or-later
// Where a wall may stand that a hoop jumps over: against the circle's path looked at closely, and against the
// referee.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "leapmap/errors.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/spec.hpp"
#include "leapmap/trace.hpp"
#include "referee/referee.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

class Clearances : public ::testing::TestWithParam<Friction> {};
INSTANTIATE_TEST_SUITE_P(BothModels, Clearances, ::testing::Values(Friction::sticking, Friction::coulomb),
                         [](const auto& of) {
                           return of.param == Friction::coulomb ? "Coulomb" : "Sticking";
                         });

TEST_P(Clearances, AreThoseOfTheRefereeWhichLooksAlongTheFlight) {
  std::mt19937_64 random(51);
  Scene scene = testing::unit_scene(GetParam());
  int jumps = 0, cleared = 0;
  std::vector<double> errors;
  const int count = static_cast<int>(testing::how_many(150));
  for (int i = 0; i < count; ++i) {
    const Design design = testing::either_way(random, GetParam());
    scene.clear_height = testing::uniform(random, 0.005, 0.6);
    const Outcome ours = solve(design, scene, {.tolerance = 1e-12});
    EXPECT_EQ(std::isfinite(ours.clears_from), std::isfinite(ours.clears_to));
    if (ours.status != Status::jumped) {
      EXPECT_FALSE(std::isfinite(ours.clears_from));
      continue;
    }
    ++jumps, cleared += std::isfinite(ours.clears_from);
    referee::Referee referee(scene, 1e-13);
    const Outcome theirs = referee.solve(design);
    if (!same_flags(ours, theirs) || std::abs(ours.jump_height - scene.clear_height) < 1e-6) continue;
    ASSERT_EQ(std::isfinite(ours.clears_from), std::isfinite(theirs.clears_from)) << i;
    if (!std::isfinite(ours.clears_from)) continue;
    errors.push_back(
        std::max(std::abs(ours.clears_from - theirs.clears_from) / (1.0 + std::abs(ours.clears_from)),
                 std::abs(ours.clears_to - theirs.clears_to) / (1.0 + std::abs(ours.clears_to))));
  }
  EXPECT_GT(jumps, count * 4 / 15);
  EXPECT_GT(cleared, count * 2 / 15);
  EXPECT_LT(cleared, jumps);
  // A few lie so near a cliff that the methods differ by what they amplify; the bulk shows the formulas.
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() * 9 / 10], 1e-10);
}

/// Whether the circle, looked at so many times, keeps clear of a wall at X, by how much: below zero it does
/// not.
double gap(const Motion& motion, const Scene& scene, double X) {
  const double R = scene.radius, wall = 2.0 * scene.clear_height;
  double least = HUGE_VAL, x0 = std::nan("");
  for (const MotionPoint& at : motion.points) {
    if (at.phase != Phase::flight) continue;
    if (std::isnan(x0)) x0 = at.x / R;
    const double x = at.x / R - x0, centre = 1.0 + at.y / R;
    const double above = std::max(0.0, centre - wall);
    least = std::min(least, std::hypot(X - x, above) - 1.0);
  }
  return least;
}

TEST_P(Clearances, AreWhereTheCircleNeverMeetsTheWallAndBeyondItDoes) {
  std::mt19937_64 random(52);
  Scene scene = testing::unit_scene(GetParam());
  int looked_at = 0;
  for (int i = 0; i < 150; ++i) {
    const Design design = testing::either_way(random, GetParam());
    scene.clear_height = testing::uniform(random, 0.01, 0.3);
    const Outcome o = solve(design, scene);
    if (!std::isfinite(o.clears_from) || o.candidates > 1 || o.flight_time > 20.0) continue;
    ++looked_at;
    const double end = o.jump_time + o.flight_time;
    Motion motion = trace(design, scene, {.interval = o.flight_time / 5000.0});
    std::erase_if(motion.points, [&](const MotionPoint& at) { return at.t < o.jump_time || at.t > end; });
    ASSERT_GT(motion.points.size(), 4000u);
    constexpr double seen = 2e-3;  // between two of five thousand looks, and at the lift-off itself
    for (const double X : {o.clears_from, 0.5 * (o.clears_from + o.clears_to), o.clears_to})
      EXPECT_GT(gap(motion, scene, X), -seen) << i << " at " << X;
    EXPECT_LT(gap(motion, scene, o.clears_from - 0.1), 0.0) << i;
    EXPECT_LT(gap(motion, scene, o.clears_to + 0.1), 0.0) << i;
  }
  EXPECT_GT(looked_at, 8);
}

TEST(Clearances, OfAWallWithoutHeightReachFromLiftOffToLanding) {
  Scene scene{.clear_height = 1e-12};
  const Outcome o = solve(Design{}, scene);
  ASSERT_EQ(o.status, Status::jumped);
  // The circle touches the plane at one point only, but the dip after a lift-off without slip reaches on.
  EXPECT_GE(o.clears_from, 0.0);
  EXPECT_NEAR(o.clears_to, o.jump_range, 1e-5);  // the width of the circle at that height: sqrt(2 h)
}

TEST(Clearances, NeedAWall) {
  EXPECT_FALSE(std::isfinite(solve(Design{}, Scene{}).clears_from));
  Spec spec = parse_spec("[output]\nfields = [\"clears_from\"]\n");
  EXPECT_THROW(check_spec(spec), InputError);
  EXPECT_THROW(static_cast<void>(solve(Design{}, Scene{.clear_height = -0.1})), InputError);
  EXPECT_FALSE(std::isfinite(solve(Design{}, Scene{.clear_height = 0.99}).clears_to)) << "it jumps 0.983";
}

}  // namespace
}  // namespace leapmap
