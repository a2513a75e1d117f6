// SPDX-License-Identifier: GPL-3.0-or-later
/// Jumps that are known from others, on a return map that is known: r x (1 - x), with a spin that follows.
#include "gaits/known_jumps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace leapmap {
namespace {

Landed landed_at(double x) { return {.angle = x, .spin = std::sin(3.0 * x)}; }
Landed next_of(const Landed& at) { return landed_at(3.9 * at.angle * (1.0 - at.angle)); }

/// So many jumps from somewhere in the chaos.
KnownJumps chaos(int jumps, Landed& at) {
  KnownJumps known;
  for (int k = 0; k < jumps; ++k) {
    const Landed from = at;
    at = next_of(at);
    known.add(from, at, 5);
  }
  return known;
}

TEST(KnownJumps, InterpolateNearlyAllOthersWithinTheirError) {
  Landed at = landed_at(0.3);
  KnownJumps known = chaos(150, at);
  int interpolated = 0;
  for (int k = 0; k < 1'000; ++k) {
    const Landed to = next_of(at);
    if (const auto next = known.next(at)) {
      ++interpolated;
      EXPECT_LT(between(*next, to).lpNorm<Eigen::Infinity>(), 5.0 * KnownJumps::error);
    }
    at = to;
  }
  EXPECT_GT(interpolated, 950);
}

TEST(KnownJumps, TellNothingWithoutNeighbours) {
  Landed at = landed_at(0.3);
  EXPECT_FALSE(KnownJumps().next(at));
  EXPECT_FALSE(chaos(3, at).next(landed_at(0.5)));
  KnownJumps known = chaos(150, at);
  EXPECT_FALSE(known.next(landed_at(0.999)));  // chaos goes from 0.095 to 0.975
  EXPECT_FALSE(known.next(landed_at(0.05)));
}

TEST(KnownJumps, AreNotAskedForEverWhereTooFewAreKnown) {
  Landed at = landed_at(0.3);
  KnownJumps known = chaos(60, at), given_up = known;
  for (int k = 0; k < 128; ++k) EXPECT_FALSE(given_up.next(landed_at(0.999)));
  EXPECT_TRUE(known.next(landed_at(0.6)));
  EXPECT_FALSE(given_up.next(landed_at(0.6)));
}

TEST(KnownJumps, TellNothingOfLandingsBesideTheirCurve) {
  Landed at = landed_at(0.3);
  KnownJumps known = chaos(150, at);
  Landed beside = landed_at(0.6);
  ASSERT_TRUE(known.next(beside));
  beside.spin += 1e-6;
  EXPECT_FALSE(known.next(beside));
  beside = landed_at(0.6);
  beside.slip = 1e-6;
  EXPECT_FALSE(known.next(beside));
}

TEST(KnownJumps, TellNothingBetweenJumpsOfOtherPhases) {
  KnownJumps known;
  for (int k = 0; k < 100; ++k) {
    const Landed from = landed_at(0.01 * k);
    known.add(from, next_of(from), k < 50 ? 5 : 6);
  }
  EXPECT_TRUE(known.next(landed_at(0.485)));
  EXPECT_FALSE(known.next(landed_at(0.495)));
  EXPECT_TRUE(known.next(landed_at(0.505)));
}

TEST(KnownJumps, TellNothingOfJumpsWhosePhasesAreNotAllTold) {
  for (const std::uint64_t phases : {std::uint64_t{0}, std::uint64_t{3} << 62, std::uint64_t{1} << 62}) {
    KnownJumps known;
    for (int k = 0; k < 100; ++k) {
      const Landed from = landed_at(0.01 * k);
      known.add(from, next_of(from), phases);
    }
    EXPECT_FALSE(known.next(landed_at(0.485)));
  }
}

TEST(KnownJumps, GiveUpWhereLandingsLieOnNoCurve) {
  // Henon's map, by angle and spin: what comes next depends on both.
  KnownJumps known;
  Landed at{.angle = 0.1, .spin = 0.1};
  int interpolated = 0;
  for (int k = 0; k < 100'000; ++k) {
    const Landed to{.angle = 1.0 - 1.4 * at.angle * at.angle + at.spin, .spin = 0.3 * at.angle};
    interpolated += known.next(at).has_value();
    known.add(at, to, 5);
    at = to;
  }
  EXPECT_LT(interpolated, 100);
}

TEST(KnownJumps, TellOfLandingsThatSlipOrReboundAsTheirNeighboursDo) {
  const auto to = [](double x) {
    return Landed{.angle = 0.5 * x, .spin = x, .slip = x - 0.5, .normal = 0.1 * x};
  };
  KnownJumps known;
  for (int k = 1; k < 100; ++k) known.add(landed_at(0.01 * k), to(0.01 * k), 5);
  const auto next = known.next(landed_at(0.255));
  ASSERT_TRUE(next);
  EXPECT_LT(between(*next, to(0.255)).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_FALSE(known.next(landed_at(0.497)));  // the one neighbour slips backwards, the other does not
  EXPECT_FALSE(known.next(landed_at(0.504)));
}

TEST(KnownJumps, LeaveOutWhatIsNoNumber) {
  Landed at = landed_at(0.3);
  KnownJumps known = chaos(120, at);
  known.add({.angle = std::nan("")}, landed_at(0.5), 5);
  known.add(landed_at(0.5), {.angle = std::nan("")}, 5);
  EXPECT_TRUE(known.next(landed_at(0.6)));
  EXPECT_FALSE(known.next({.angle = std::nan("")}));
  EXPECT_FALSE(known.next(landed_at(0.5001)));
}

TEST(KnownJumps, TellNothingAcrossAStepOrAKink) {
  KnownJumps step, kink;
  for (int k = 0; k < 100; ++k) {
    const Landed from = landed_at(0.01 * k);
    step.add(from, landed_at(from.angle < 0.5 ? 0.3 : 0.3001), 5);
    kink.add(from, landed_at(std::abs(from.angle - 0.5)), 5);
  }
  for (const double x : {0.485, 0.495, 0.505}) {
    EXPECT_FALSE(step.next(landed_at(x))) << x;
    EXPECT_FALSE(kink.next(landed_at(x))) << x;
  }
  EXPECT_TRUE(step.next(landed_at(0.405)));
  EXPECT_TRUE(kink.next(landed_at(0.405)));
}

}  // namespace
}  // namespace leapmap
