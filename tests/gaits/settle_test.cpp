// SPDX-License-Identifier: GPL-3.0-or-later
/// When hoops have settled on a gait, on return maps that are known: r x (1 - x) in place of jumps.
#include "gaits/settle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "trajectory/sequence.hpp"

namespace leapmap {
namespace {

struct Asked {
  long settle = 500;
  long most_period = 16;
  double off = 0.0;  ///< relative: so much more r has with derivatives
  double tolerance = 1e-10;
  double gait_tolerance = 1e-3;
  bool alike = false;  ///< all jumps go through the same phases, so that they may be known from others
};

/// What a hoop does whose landings are the logistic map's.
struct Followed {
  Outcome outcome;
  long jumps = 0;    ///< that it was followed
  long closing = 0;  ///< jumps with derivatives, to close orbits
};

Followed follow(double r, double from, const Asked& asked = {}) {
  Followed followed;
  const auto jumped = [] {
    Outcome outcome;
    outcome.status = Status::jumped, outcome.jump_height = 0.5, outcome.flight_time = 1.0;
    return outcome;
  };
  const auto next = [r](const auto& x) { return r * x * (1.0 - x); };
  const auto jumps = [&](Start, std::span<const Design>, std::span<ContactState<double>> states,
                         std::span<Outcome> outcomes) {
    for (ContactState<double>& at : states) at.angle = next(at.angle), at.time += 1.0;
    for (Outcome& outcome : outcomes) {
      outcome = jumped();
      outcome.phase_sequence = asked.alike ? 5 : static_cast<std::uint64_t>(followed.jumps);
    }
  };
  const auto counted = [&](Start start, std::span<const Design> designs,
                           std::span<ContactState<double>> states, std::span<Outcome> outcomes) {
    ++followed.jumps;
    jumps(start, designs, states, outcomes);
  };
  const auto duals = [&](Start, const Design&, ContactState<StateDual>& at, const PutDual<StateDual>&) {
    ++followed.closing;
    at.angle = StateDual(r * (1.0 + asked.off)) * at.angle * (StateDual(1.0) - at.angle);
    at.spin = at.spin * 0.0;  // nothing depends on it
    return jumped();
  };
  Scene scene;
  scene.settle = asked.settle, scene.most_period = asked.most_period;
  scene.gait_tolerance = asked.gait_tolerance;
  const std::vector<Design> design{{.release_angle = from}};
  std::vector<Outcome> outcome{jumped()};
  GaitSolver(scene, {in_rounds(counted), jumps, duals, asked.tolerance}).solve(design, outcome);
  followed.outcome = outcome[0];
  return followed;
}

/// The slope along an orbit that is drawn to it, after a hundred thousand rounds.
double multiplier_of(double r, double from, int period) {
  double x = from, slope = 1.0;
  for (long k = 0; k < 100'000L * period; ++k) x = r * x * (1.0 - x);
  for (int k = 0; k < period; ++k) slope *= r * (1.0 - 2.0 * x), x = r * x * (1.0 - x);
  return slope;
}

TEST(Settling, EndsAsSoonAsAnOrbitIsPlain) {
  struct Known {
    double r;
    int period;
    long most_jumps;
  };
  // By r: the doubling of periods, the window of period 6, that of 3; r = 2.97 and 3.01 are slow.
  for (const auto& [r, period, most_jumps] :
       {Known{2.8, 1, 60}, Known{2.97, 1, 250}, Known{3.01, 2, 400}, Known{3.2, 2, 40}, Known{3.5, 4, 60},
        Known{3.555, 8, 100}, Known{3.6275, 6, 250}, Known{3.835, 3, 120}, Known{3.845, 6, 100}})
    for (const double from : {0.1, 0.37, 0.85}) {
      const auto& [outcome, jumps, closing] = follow(r, from);
      EXPECT_EQ(outcome.gait_period, period) << r;
      // Of 16 digits an orbit's slope has some ten where factors of 1/1000 are among them.
      EXPECT_NEAR(outcome.gait_multiplier, multiplier_of(r, from, period), 1e-9) << r;
      EXPECT_LE(jumps, most_jumps) << r << " from " << from;
    }
}

TEST(Settling, IsNotBelievedOfWhatOnlyPassesBy) {
  // Chaos, and just before the window of period 3: it passes where the orbit will be for a hundred jumps, and
  // more slowly from one to the next.
  for (const double r : {3.7, 3.8, 3.99, 3.8284, 3.82841, 3.828425, 3.8284265})
    for (const double from : {0.1, 0.37, 0.5, 0.85}) {
      const auto& [outcome, jumps, closing] = follow(r, from);
      EXPECT_EQ(outcome.gait_period, Outcome::no_gait) << r << " from " << from;
      EXPECT_EQ(jumps, Asked{}.settle + Asked{}.most_period);
    }
}

TEST(Settling, FindsOrbitsThatAreHardToClose) {
  struct Known {
    double r, from;
    int period;
    double multiplier;
    Asked asked;
  };
  // Just past a doubling, where Newton's method comes nearer by a third in each step; and an orbit that it
  // does not find from the first landing.
  for (const auto& [r, from, period, multiplier, asked] :
       {Known{3.0000002905438308, 0.8005362288830875, 2, 0.9999988, {}},
        Known{3.00141933138248, 0.6737915088823359, 2, 0.9943, {.settle = 30, .gait_tolerance = 1e-2}},
        Known{3.7420365885775957, 0.7118110745578807, 10, -0.26, {.settle = 30}}}) {
    const Outcome outcome = follow(r, from, asked).outcome;
    EXPECT_EQ(outcome.gait_period, period) << r;
    EXPECT_NEAR(outcome.gait_multiplier, multiplier, 0.005) << r;
  }
}

TEST(Settling, SpendsLittleOnClosingWhatIsChaos) {
  // Each hoop comes near to some landing of its last ones by chance. There is an orbit that repels, which
  // some steps of at most 16 jumps find; or none, and then so many steps see that they wander.
  long closing = 0;
  int hoops = 0;
  for (double r = 3.6; r < 4.0; r += 0.01)
    for (const double from : {0.1, 0.37, 0.5, 0.85}) {
      const Followed followed = follow(r, from);
      if (followed.outcome.gait_period != Outcome::no_gait) continue;
      EXPECT_LE(followed.closing, 300) << r << " from " << from;
      closing += followed.closing, ++hoops;
    }
  ASSERT_GT(hoops, 100);
  EXPECT_LE(closing, 12 * hoops);
}

TEST(Settling, OfHoopsThatNeverSettleKnowsMostJumpsFromOthers) {
  for (const double r : {3.7, 3.8, 3.9, 3.99, 3.8284, 3.828425})
    for (const double from : {0.1, 0.37, 0.5, 0.85}) {
      const auto& [outcome, jumps, closing] = follow(r, from, {.alike = true});
      EXPECT_EQ(outcome.gait_period, Outcome::no_gait) << r << " from " << from;
      EXPECT_LE(jumps, 180) << r << " from " << from;
    }
}

TEST(Settling, FindsTheSameOrbitsWhereJumpsAreKnownFromOthers) {
  // Slow ones, and in windows after chaos, which takes hundreds of jumps and another course with each
  // rounding: what is known must neither end it early nor keep it away.
  for (const double r : {2.97, 3.01, 3.5, 3.555, 3.6275, 3.74, 3.835, 3.845, 3.9057, 3.9602})
    for (const double from : {0.1, 0.37, 0.85}) {
      const Outcome known = follow(r, from, {.settle = 20'000, .alike = true}).outcome,
                    solved = follow(r, from, {.settle = 20'000}).outcome;
      EXPECT_LT(known.gait_period, Outcome::no_gait) << r << " from " << from;
      EXPECT_EQ(known.gait_period, solved.gait_period) << r << " from " << from;
      EXPECT_NEAR(known.gait_multiplier, solved.gait_multiplier, 1e-9) << r << " from " << from;
    }
}

TEST(Settling, OfAnOrbitThatDoublesItsPeriodIsFoundOnEitherSide) {
  // At r = 3 the orbit's multiplier is -1. Close by it takes thousands of jumps.
  EXPECT_EQ(follow(2.99, 0.3).outcome.gait_period, 1);
  EXPECT_EQ(follow(3.01, 0.3).outcome.gait_period, 2);
  for (const double r : {2.999, 3.001}) {
    const auto& [outcome, jumps, closing] = follow(r, 0.3);
    EXPECT_TRUE(outcome.gait_period == (r < 3.0 ? 1 : 2) || outcome.gait_period == Outcome::no_gait) << r;
    EXPECT_EQ(jumps, Asked{}.settle + Asked{}.most_period) << r;
  }
}

TEST(Settling, SeesNoLongerPeriodThanIsAskedFor) {
  EXPECT_EQ(follow(3.555, 0.3, {.most_period = 7}).outcome.gait_period, Outcome::no_gait);
  EXPECT_EQ(follow(3.555, 0.3, {.most_period = 8}).outcome.gait_period, 8);
  EXPECT_EQ(follow(2.5, 0.3, {.most_period = 1}).outcome.gait_period, 1);
}

TEST(Settling, GoesNoFurtherThanIsAskedFor) {
  for (const long settle : {1L, 5L, 11L, 12L, 13L, 16L, 23L, 24L, 25L, 32L, 33L}) {
    const auto& [outcome, jumps, closing] = follow(2.2, 0.3, {.settle = settle});
    EXPECT_EQ(outcome.gait_period, settle > 1 ? 1 : Outcome::no_gait) << settle;
    EXPECT_LE(jumps, settle < 12 ? settle + 16 : 12) << settle;
    EXPECT_LE(follow(3.99, 0.3, {.settle = settle}).jumps, settle + 16) << settle;
  }
}

TEST(Settling, HoldsAtCoarseTolerancesWhereSolversDiffer) {
  for (const double off : {1e-7, -1e-6, 1e-5})
    for (const auto& [r, period] : {std::pair{2.5, 1}, {2.9, 1}, {3.2, 2}, {3.5, 4}}) {
      const Outcome outcome = follow(r, 0.3, {.off = off, .tolerance = 10.0 * std::abs(off)}).outcome;
      EXPECT_EQ(outcome.gait_period, period) << r << " " << off;
    }
}

}  // namespace
}  // namespace leapmap
