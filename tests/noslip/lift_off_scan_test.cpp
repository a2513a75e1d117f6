// SPDX-License-Identifier: GPL-3.0-or-later
/// The bounds that make the search complete, and the search against dense sampling.
#include "noslip/lift_off_scan.hpp"

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
  return begin_roll(reduce<double>(design), testing::uniform(random, -10.0, 10.0),
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

TEST(LiftHarmonics, AddUpToLift) {
  std::mt19937_64 random(16);
  for (int i = 0; i < 1000; ++i) {
    const Roll<double> roll = random_roll(random);
    const LiftHarmonics<double> of = lift_harmonics(roll.hoop);
    const double angle = testing::uniform(random, -20.0, 20.0);
    double G = 0.0, rho_K = 0.0;
    for (std::size_t m = 0; m < 4; ++m)
      G += of.cosine[m] * std::cos(double(m) * angle) + of.sine[m] * std::sin(double(m) * angle);
    for (std::size_t m = 0; m < 3; ++m) rho_K += of.swing[m] * std::cos(double(m) * angle);
    const double E = std::abs(roll.level) + 2.0 * std::abs(angle * roll.hoop.thrust);
    // A few roundings of the largest terms, and of angles up to 60.
    EXPECT_NEAR(G + rho_K * (roll.level + 2.0 * angle * roll.hoop.thrust), lift(roll, angle).value,
                1e-13 * (1.0 + E));
  }
}

TEST(LiftBounds, HoldAtEveryAngleOfTheirRevolution) {
  std::mt19937_64 random(12);
  double closest = 0.0, closest_fourth = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Roll<double> roll = random_roll(random);
    const double turn = std::floor(testing::uniform(random, -2.0, 6.0));
    const LiftBounds<double> bounds = lift_bounds(roll, lift_harmonics(roll.hoop), turn);
    for (int k = 0; k <= 400; ++k) {
      const CurvedSample<double> G = lift(roll, 2.0 * std::numbers::pi * (turn + k / 400.0));
      EXPECT_LE(std::abs(G.curvature), bounds.second * (1 + 1e-12));
      EXPECT_LE(std::abs(G.jerk), bounds.third * (1 + 1e-12));
      closest = std::max(closest, std::abs(G.curvature) / bounds.second);
    }
    for (int k = -33; k < 433;
         ++k) {  // a difference of G''' is a mean of G'''', and a twelfth of a turn more
      const double a = 2.0 * std::numbers::pi * (turn + k / 400.0), b = a + 2.0 * std::numbers::pi / 400.0;
      const double fourth = std::abs(lift(roll, b).jerk - lift(roll, a).jerk) / (b - a);
      EXPECT_LE(fourth, bounds.fourth * (1 + 1e-10));
      closest_fourth = std::max(closest_fourth, fourth / bounds.fourth);
    }
  }
  EXPECT_GT(closest, 0.9) << "a bound that is never near costs time";
  EXPECT_GT(closest_fourth, 0.8) << "a bound that is never near costs time";
}

TEST(Scan, FlagsEveryFallThatDenseSamplingSeesAndCallsNoOtherOneSure) {
  std::mt19937_64 random(13);
  const auto nodes = scan_nodes<double>();
  int falls_seen = 0, sure = 0, unsure = 0;
  for (int i = 0; i < 2000; ++i) {
    const Roll<double> roll = random_roll(random);
    const double first_turn = std::floor(testing::uniform(random, -1.0, 4.0));
    ScanFlags flags;
    scan_turns(nodes, roll, first_turn, turns_a_scan, 0, &flags);
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
        if (looks && !falls_surely) ++unsure;
        if (falls_surely) {
          ++sure;
          EXPECT_TRUE(falls == 1 && rises == 0);
        }
      }
  }
  EXPECT_GT(falls_seen, 2000);
  EXPECT_GT(sure, falls_seen / 2) << "most falls should need no second look";
  EXPECT_LT(unsure, falls_seen / 2) << "few intervals should need one";
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
    std::array<ScanFlags, width> together;
    const std::size_t from = static_cast<std::size_t>(i) % nodes_a_turn;
    scan_turns(scan_nodes<double>(), batch, Batch(1.0), turns_a_scan, from, together.data());
    for (std::size_t k = 0; k < width; ++k) {
      ScanFlags alone;
      scan_turns(scan_nodes<double>(), rolls[k], 1.0, turns_a_scan, from, &alone);
      EXPECT_EQ(together[k].looks, alone.looks);
      EXPECT_EQ(together[k].falls, alone.falls);
      EXPECT_EQ(together[k].above, alone.above);
    }
  }
}

TEST(Scan, TellsTheSameFromANodeOnAsOfTheWholeTurn) {
  std::mt19937_64 random(17);
  for (int i = 0; i < 500; ++i) {
    const Roll<double> roll = random_roll(random);
    const std::size_t from = random() % nodes_a_turn;
    ScanFlags whole, late;
    scan_turns(scan_nodes<double>(), roll, 0.0, turns_a_scan, 0, &whole);
    scan_turns(scan_nodes<double>(), roll, 0.0, turns_a_scan, from, &late);
    for (std::size_t t = 0; t < turns_a_scan; ++t) {
      const std::size_t begin = t == 0 ? from : 0;
      EXPECT_EQ(whole.looks[t] >> begin, late.looks[t] >> begin);
      EXPECT_EQ(whole.falls[t] >> begin, late.falls[t] >> begin);
      EXPECT_EQ(whole.above[t] >> begin, late.above[t] >> begin);
    }
  }
}

TEST(Scan, SignsAtNodesJoinRevolutionsAndTellFalls) {
  std::mt19937_64 random(15);
  for (int i = 0; i < 500; ++i) {
    const Roll<double> roll = random_roll(random);
    ScanFlags flags;
    scan_turns(scan_nodes<double>(), roll, 0.0, turns_a_scan, 0, &flags);
    const auto is_above = [&](std::size_t t, std::size_t k) { return flags.above[t] >> k & 1u; };
    for (std::size_t t = 0; t + 1 < turns_a_scan; ++t)
      EXPECT_EQ(is_above(t, nodes_a_turn), is_above(t + 1, 0));
    for (std::size_t t = 0; t < turns_a_scan; ++t)
      for (std::size_t k = 0; k < nodes_a_turn; ++k) {
        const bool sinks = is_above(t, k) && !is_above(t, k + 1);
        EXPECT_TRUE(sinks || !(flags.falls[t] >> k & 1u));
        EXPECT_TRUE(!sinks || flags.looks[t] >> k & 1u);
      }
  }
}

TEST(Scan, SeesThatAMassOnTheRimOfAMasslessHoopIsHeldAtTheBottom) {
  for (const double mass_ratio : {1e6, 1e12, 1e16}) {
    const Roll<double> roll = begin_roll(reduce<double>({.mass_ratio = mass_ratio}), std::numbers::pi, 0.0);
    ScanFlags flags;
    scan_turns(scan_nodes<double>(), roll, 0.0, turns_a_scan, 0, &flags);
    for (std::size_t t = 0; t < turns_a_scan; ++t) EXPECT_TRUE(flags.above[t] & 1u) << mass_ratio;
  }
}

TEST(Classify, TellsOneFallNothingAndUnclear) {
  const LiftBounds<double> bounds{1.0, 1.0, 1.0};
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
