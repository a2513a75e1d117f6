// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace leapmap {
namespace {

std::vector<Finding> findings_of(const std::vector<StabilityRow>& rows, const std::string& method) {
  std::vector<Finding> findings;
  for (const StabilityRow& row : rows)
    if (row.method == method) findings.push_back(row.finding);
  return findings;
}

/// A case with one contestant only; all its settings, if it walks along them.
StabilityCase only(StabilityCase stability_case, const std::string& method, bool fixed_step = false) {
  std::erase_if(stability_case.contestants,
                [&](const Contestant& c) { return c.method != method || c.fixed_step != fixed_step; });
  return stability_case;
}

StabilityCase find_case(const std::string& name, bool quick) {
  for (const NamedCase& named : stability_cases())
    if (named.name == name) return stability_case(named, {quick});
  ADD_FAILURE() << name;
  return {};
}

TEST(Stability, AVerdictIsTheWorstThatIsNotSaid) {
  using enum Finding;
  const auto verdict = [](std::vector<Finding> findings) { return verdict_of(findings); };
  EXPECT_EQ(verdict({fine, undecided, fine}), "fine");
  EXPECT_EQ(verdict({fine, lossy, fine}), "loses digits");
  EXPECT_EQ(verdict({fine, lossy, failed}), "reports failure");
  EXPECT_EQ(verdict({failed, failed, undecided}), "breaks down");
  EXPECT_EQ(verdict({fine, lossy, failed, wrong}), "silently wrong");
  EXPECT_EQ(verdict({undecided}), "undecided");
}

class StabilityOfTheDefault : public ::testing::TestWithParam<const char*> {};

// exact is the default of sweep and of hop. Every place of the walk but those that an ulp decides: right
// status, flag and candidates, heights and times as promised.
TEST_P(StabilityOfTheDefault, IsFineOnTheWholeWalk) {
  const std::string name = GetParam();
  // A slide near Painleve's edge takes an integration a hundred thousand steps.
  StabilityCase walk = only(find_case(name, name == "painleve"), "exact");
  // The longest run's 13 truths in long double would take a minute; leapmap stability has it.
  std::erase_if(walk.subjects, [&](const StabilitySubject& s) { return walk.name == "long" && s.x > 500.0; });
  ASSERT_FALSE(walk.contestants.empty());
  const auto rows = run_case(walk);
  ASSERT_EQ(rows.size(), walk.contestants.size() * walk.subjects.size());
  for (const StabilityRow& row : rows) {
    if (row.finding == Finding::undecided) continue;
    // Its promise: ten times the tolerance, no finer than its roundings, and what those of the inputs may do
    // (20 of them).
    EXPECT_LE(row.error, 10.0 * std::max(row.setting, 1e-12) + 20.0 * 2.2e-16 * (1.0 + row.condition))
        << row.study << " at " << row.x;
  }
  for (const StabilityRow& row : rows)
    EXPECT_TRUE(row.finding == Finding::fine || row.finding == Finding::undecided)
        << row.study << " at " << row.x << ": " << name_of(row.finding) << ", error " << row.error;
  // 1e-15 beyond the fold, some ulps of the mass ratio; jumps after which no digit is left; with friction
  // 1e-13 and 1e-14 either side of a boundary
  const bool slips = walk.subjects[0].scene.friction == Friction::coulomb;
  const long most = slips ? 4 : name == "chaos" ? 5 : 1;
  EXPECT_LE(std::ranges::count(rows, Finding::undecided, &StabilityRow::finding), most);
}
INSTANTIATE_TEST_SUITE_P(Walks, StabilityOfTheDefault,
                         ::testing::Values("needle", "release", "graze", "long", "tolerance", "chaos",
                                           "painleve", "slow", "dip", "stick", "bounces"),
                         [](const auto& walk) { return std::string(walk.param); });

TEST(Stability, TheDefaultFlightIsFineWhereLandingEventsArmedTooEarlyLoseTheJump) {
  const auto rows = run_landing_case({});
  EXPECT_EQ(verdict_of(findings_of(rows, "closed form (leapmap)")), "fine");
  EXPECT_EQ(verdict_of(findings_of(rows, "armed at once")), "silently wrong");
  EXPECT_EQ(verdict_of(findings_of(rows, "armed after 0.05 sqrt(R/g)")), "silently wrong");
  // "armed once above the plane" is not asserted: whether y rounds to above zero at the lift-off depends on
  // the machine.
  EXPECT_EQ(verdict_of(findings_of(rows, "armed once 1e-9 above it")), "fine");
  const auto dipping = std::ranges::count_if(rows, [](const StabilityRow& row) { return row.x > 1e-6; });
  EXPECT_GT(dipping, 0);
  EXPECT_LT(dipping, std::ssize(rows)) << "triple roots, which do not dip";
}

TEST(Stability, TheConditionOfAReleaseGrowsAsItsDistanceFromTheEquilibriumShrinks) {
  StabilityCase walk = only(find_case("release", false), "exact");
  const auto rows = run_case(walk);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double growth = rows[i].condition / rows[i - 1].condition;
    // t is about ln(1 / x): dt / dx goes as 1 / x, over a t that grows slowly.
    EXPECT_GT(growth, 5.0) << rows[i].x;
    EXPECT_LT(growth, 10.5) << rows[i].x;
  }
}

TEST(Stability, WhatAnUlpDecidesIsAskedOfNoMethod) {
  StabilityCase walk = only(find_case("graze", false), "gsl-rk4");
  walk.subjects = {walk.subjects.back()};  // mass ratio 1e-15 beyond the fold
  for (const StabilityRow& row : run_case(walk)) EXPECT_EQ(row.finding, Finding::undecided);
}

TEST(Stability, NoMethodIsSilentlyWrongAtTolerancesNoDoubleCanReach) {
  const auto rows = run_case(find_case("tolerance", true));  // that it ends is half of the test
  for (const StabilityRow& row : rows) {
    EXPECT_NE(row.finding, Finding::wrong) << row.method << " at " << row.x;
    if (row.x <= 1e-18 && row.method != "exact" && row.finding != Finding::failed) {
      EXPECT_LT(row.error, 1e-8) << row.method << " at " << row.x;
    }
  }
}

TEST(Stability, TheTruthHasTwoWitnessesButWhereSomeUlpsDecide) {
  const Design paper;
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Truth truth = truths_of({&paper, 1}, {.friction = friction})[0];
    EXPECT_EQ(truth.witness, Witness::both);
    EXPECT_EQ(truth.outcome.jump_height, refined_outcome(paper, {.friction = friction}).jump_height);
  }
  // Where some ulps decide, the integration is in doubt about itself; so it is at some places beside the
  // fold.
  std::size_t alone = 0;
  for (const StabilitySubject& subject : find_case("graze", false).subjects)
    alone += truths_of({&subject.design, 1}, subject.scene)[0].witness == Witness::long_double;
  EXPECT_GE(alone, 1u);
  EXPECT_LE(alone, 6u);
}

TEST(Stability, TheWalksAcrossABoundaryCrossOne) {
  for (const char* name : {"painleve", "dip", "stick"}) {
    std::size_t crossed = 0;
    const StabilityCase walk = find_case(name, false);
    for (std::size_t i = 0; i + 1 < walk.subjects.size(); i += 2) {
      const StabilitySubject &below = walk.subjects[i], &beyond = walk.subjects[i + 1];
      ASSERT_EQ(below.x, -beyond.x);
      crossed += !same_flags(refined_outcome(below.design, below.scene),
                             refined_outcome(beyond.design, beyond.scene));
    }
    EXPECT_EQ(2 * crossed, walk.subjects.size()) << name;
  }
}

TEST(Stability, StepsTooLongAreFoundOutByTheirEnergy) {
  StabilityCase walk = only(find_case("step", true), "euler", true);
  const auto rows = run_case(walk);
  ASSERT_FALSE(rows.empty());
  const auto failed = std::ranges::count(rows, Finding::failed, &StabilityRow::finding);
  EXPECT_GT(failed, std::ssize(rows) / 2);
}

}  // namespace
}  // namespace leapmap
