// SPDX-License-Identifier: GPL-3.0-or-later
/// The bounds that make the search complete, and the search against dense sampling.
#include "rolling/lift_off_scan.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/designs.hpp"

namespace leapmap {
namespace {

/// Designs of all kinds, up to a mass on the rim of a nearly massless hoop.
Roll<double> random_roll(std::mt19937_64& random) {
  Design design;
  design.slope = testing::uniform(random, 0.0, 1.5);
  design.mass_ratio = std::exp(testing::uniform(random, -3.0, 9.0));
  design.offset_ratio = testing::uniform(random, 0.0, 1.0) < 0.3 ? 1.0 : testing::uniform(random, 0.0, 1.0);
  design.inertia_factor = testing::uniform(random, 0.0, 1.5);
  return begin_roll(derive<double>(design), testing::uniform(random, -10.0, 10.0),
                    testing::uniform(random, 0.0, 3.0));
}

TEST(Lift, HasTheSignOfTheNormalForceAndItsOwnDerivatives) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 1000; ++i) {
    const Roll<double> roll = random_roll(random);
    const double angle = roll.release + testing::uniform(random, 0.0, 20.0);
    const Trig<double> phi = trig(angle);
    const double E = vis_viva(roll, angle, phi), J = contact_inertia(roll.hoop, phi);
    if (E <= 0.0) continue;
    const double spin = std::sqrt(E / J);
    const double N = normal_force(roll.hoop, phi, spin, angular_acceleration(roll.hoop, phi, spin));
    const CurvedSample<double> G = lift(roll, angle);
    // N divides by J once more than G: its rounding grows with 1 / J
    EXPECT_NEAR(G.value, N * J * J, 1e-13 * (1.0 + E) * (1.0 + J));

    const double h = 1e-3;
    const CurvedSample<double> before = lift(roll, angle - h), after = lift(roll, angle + h);
    // Central differences: an error of h^2 / 6 of two derivatives higher, at most some 500 (1 + E) here
    const double slack = 2e-4 * (1.0 + E);
    EXPECT_NEAR(G.rate, (after.value - before.value) / (2 * h), slack);
    EXPECT_NEAR(G.curvature, (after.rate - before.rate) / (2 * h), slack);
    EXPECT_NEAR(G.jerk, (after.curvature - before.curvature) / (2 * h), slack);
  }
}

TEST(LiftBounds, HoldAtEveryAngleOfTheirRevolution) {
  std::mt19937_64 random(12);
  double closest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Roll<double> roll = random_roll(random);
    const double turn = std::floor(testing::uniform(random, -2.0, 6.0));
    const LiftBounds<double> bounds = lift_bounds(roll, turn);
    for (int k = 0; k <= 400; ++k) {
      const CurvedSample<double> G = lift(roll, 2.0 * std::numbers::pi * (turn + k / 400.0));
      EXPECT_LE(std::abs(G.curvature), bounds.second * (1 + 1e-12));
      EXPECT_LE(std::abs(G.jerk), bounds.third * (1 + 1e-12));
      closest = std::max(closest, std::abs(G.curvature) / bounds.second);
    }
  }
  EXPECT_GT(closest, 0.9) << "a bound that is never near costs time";
}

TEST(Scan, FlagsEveryFallThatDenseSamplingSeesAndCallsNoOtherOneSure) {
  std::mt19937_64 random(13);
  const auto nodes = scan_nodes<double>();
  int falls_seen = 0, sure = 0;
  for (int i = 0; i < 2000; ++i) {
    const Roll<double> roll = random_roll(random);
    const double first_turn = std::floor(testing::uniform(random, -1.0, 4.0));
    ScanFlags flags;
    NodeSigns signs;
    scan_turns(nodes, roll, first_turn, turns_a_scan, &flags, signs);
    for (int t = 0; t < turns_a_scan; ++t)
      for (int k = 0; k < nodes_a_turn; ++k) {
        const auto u = static_cast<std::size_t>(t);
        constexpr int samples = 16;
        int falls = 0, rises = 0;
        double before = 0.0;
        for (int s = 0; s <= samples; ++s) {
          const double node = (first_turn + t) * nodes_a_turn + k + static_cast<double>(s) / samples;
          const double G = lift(roll, node * (2.0 * std::numbers::pi / nodes_a_turn)).value;
          if (s > 0 && before > 0.0 && G <= 0.0) ++falls;
          if (s > 0 && before <= 0.0 && G > 0.0) ++rises;
          before = G;
        }
        falls_seen += falls;
        const bool looks = flags.looks[u] >> k & 1u, falls_surely = flags.falls[u] >> k & 1u;
        if (falls > 0) {
          EXPECT_TRUE(looks) << "a fall is passed over";
        }
        if (falls_surely) {
          ++sure;
          EXPECT_TRUE(falls == 1 && rises == 0);
        }
      }
  }
  EXPECT_GT(falls_seen, 2000);
  EXPECT_GT(sure, falls_seen / 2) << "most falls should need no second look";
}

TEST(Scan, LanesSeeWhatOneNumberSees) {
  std::mt19937_64 random(14);
  constexpr std::size_t width = Lanes<Batch>::count;
  for (int i = 0; i < 200; ++i) {
    std::array<Roll<double>, width> rolls;
    Roll<Batch> batch;
    for (Roll<double>& roll : rolls) roll = random_roll(random);
    const auto lanes = [&](auto get) {
      LaneArray<Batch> values;
      for (std::size_t k = 0; k < width; ++k) values[k] = get(rolls[k]);
      return Lanes<Batch>::load(values.data());
    };
    batch.level = lanes([](const auto& r) { return r.level; });
    batch.hoop = {lanes([](const auto& r) { return r.hoop.sin_slope; }),
                  lanes([](const auto& r) { return r.hoop.cos_slope; }),
                  lanes([](const auto& r) { return r.hoop.rho; }),
                  lanes([](const auto& r) { return r.hoop.clearance; }),
                  lanes([](const auto& r) { return r.hoop.Ic; }),
                  lanes([](const auto& r) { return r.hoop.J_min; }),
                  lanes([](const auto& r) { return r.hoop.drive; }),
                  lanes([](const auto& r) { return r.hoop.thrust; })};
    std::array<ScanFlags, 8> together;
    NodeSigns signs;
    scan_turns(scan_nodes<double>(), batch, Batch(1.0), turns_a_scan, together.data(), signs);
    for (std::size_t k = 0; k < width; ++k) {
      ScanFlags alone;
      scan_turns(scan_nodes<double>(), rolls[k], 1.0, turns_a_scan, &alone, signs);
      EXPECT_EQ(together[k].looks, alone.looks);
      EXPECT_EQ(together[k].falls, alone.falls);
    }
  }
}

TEST(Scan, SignsAtNodesAreThoseOfEveryLaneAndJoinRevolutions) {
  std::mt19937_64 random(15);
  for (int i = 0; i < 500; ++i) {
    const Roll<double> roll = random_roll(random);
    ScanFlags flags;
    NodeSigns signs;
    scan_turns(scan_nodes<double>(), roll, 0.0, turns_a_scan, &flags, signs);
    for (std::size_t t = 0; t + 1 < turns_a_scan; ++t)
      EXPECT_EQ(is_above(signs, t, nodes_a_turn, 0), is_above(signs, t + 1, 0, 0));
    for (std::size_t t = 0; t < turns_a_scan; ++t)
      for (std::size_t k = 0; k < nodes_a_turn; ++k)
        if (flags.falls[t] >> k & 1u) {
          EXPECT_TRUE(is_above(signs, t, k, 0) && !is_above(signs, t, k + 1, 0));
        } else if (flags.looks[t] >> k & 1u) {
          EXPECT_EQ(flags.above_left[t] >> k & 1u, std::uint64_t{is_above(signs, t, k, 0)});
          EXPECT_EQ(flags.above_right[t] >> k & 1u, std::uint64_t{is_above(signs, t, k + 1, 0)});
        }
  }
}

TEST(Classify, TellsOneFallNothingAndUnclear) {
  const LiftBounds<double> bounds{1.0, 1.0};
  const auto kind = [&](double a, double a_rate, double b, double b_rate) {
    return classify<double>({a, a_rate, 0, 0}, {b, b_rate, 0, 0}, a > 0.0, b > 0.0, bounds, 0.1);
  };
  EXPECT_TRUE(kind(0.05, -1.0, -0.05, -1.0).fall);
  EXPECT_FALSE(kind(-0.05, 1.0, 0.05, 1.0).fall);
  EXPECT_FALSE(kind(-0.05, 1.0, 0.05, 1.0).unclear);
  EXPECT_FALSE(kind(0.5, -0.05, 0.5, 0.05).unclear) << "far from zero";
  EXPECT_TRUE(kind(0.001, -0.05, 0.001, 0.05).unclear) << "a minimum within its reach of zero";
  EXPECT_TRUE(kind(0.001, -1e-4, -0.001, 1e-4).unclear) << "one fall, or three roots";
}

}  // namespace
}  // namespace leapmap
