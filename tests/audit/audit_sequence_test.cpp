// SPDX-License-Identifier: GPL-3.0-or-later
/// The audit of later jumps and of gaits.
#include "audit/audit_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "engine/engine.hpp"
#include "gaits/error_growth.hpp"
#include "leapmap/gait.hpp"
#include "leapmap/solve.hpp"
#include "spec/designs.hpp"

namespace leapmap {
namespace {

Spec lively_grid(const std::string& friction, std::vector<std::string> more) {
  std::vector<std::string> given{"slope={from=0.1,to=0.5,count=8}",
                                 "mass_ratio={from=1,to=8,count=8}",
                                 "offset_ratio=0.7",
                                 "friction=" + friction,
                                 "runway=20",
                                 "audit=1"};
  if (friction == "coulomb") given.emplace_back("mu_static=0.6");
  given.insert(given.end(), more.begin(), more.end());
  return read_spec("", given);
}

/// A hoop whose jumps are chaotic: no gait of it is stable.
const std::vector<std::string> chaotic{"slope=0.35", "mass_ratio=3.0", "offset_ratio=0.8"};

std::vector<AuditSample> solved_all(const Spec& spec) {
  const Tiling tiling(shape_of(spec));
  std::vector<AuditSample> samples;
  run_sweep(spec, request_of(spec), tiling, {},
            in_order([&](const Tile& tile, std::span<const Outcome> outcomes) {
              std::ranges::copy(audit_samples(spec, tiling, tile, 0, outcomes), std::back_inserter(samples));
            }));
  return samples;
}

TEST(AuditOfSequences, FindsBothMethodsInAgreement) {
  for (const std::string friction : {"sticking", "coulomb"}) {
    const Spec spec = lively_grid(friction, {"jumps=5"});
    const auto samples = solved_all(spec);
    std::size_t later = 0;
    for (const AuditSample& sample : samples) later += sample.outcome.later_jumps.size();
    ASSERT_GE(later, 60u);
    const AuditReport report = audit(spec, samples, 0);
    EXPECT_EQ(report.sequences_wrong, 0u) << *report.first_wrong_sequence;
    EXPECT_GE(report.jumps_compared + report.jumps_beyond, later - later / 20);
    EXPECT_LE(report.jumps_beyond, later / 10);
    EXPECT_GT(report.jump_max_error, 0.0);
    EXPECT_LE(report.jump_max_error, report.allowed_error);
  }
}

TEST(AuditOfSequences, SeesAWrongJump) {
  const Spec spec = lively_grid("sticking", {"jumps=5"});
  const auto right = solved_all(spec);
  const auto chosen = std::ranges::find_if(
      right, [](const AuditSample& sample) { return sample.outcome.later_jumps.size() == 4; });
  ASSERT_NE(chosen, right.end());
  const auto index = static_cast<std::size_t>(chosen - right.begin());
  const auto convicted = [&](const auto& spoil) {
    auto samples = right;
    spoil(samples[index].outcome);
    const AuditReport report = audit(spec, samples, 0);
    EXPECT_EQ(disagree(report), report.sequences_wrong > 0);
    return report.sequences_wrong == 1 && report.first_wrong_sequence == chosen->number;
  };
  EXPECT_FALSE(convicted([](Outcome&) {}));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.later_jumps[1].height += 1e-6; }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.later_jumps[2].time *= 1.0 + 1e-6; }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.later_jumps[0].time = Outcome::none; }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.later_jumps.pop_back(); }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.sequence_end = Status::stalled; }));
}

TEST(AuditOfSequences, SeesAJumpThatNobodyMakes) {
  const Spec spec = lively_grid("sticking", {"jumps=5"});
  auto samples = solved_all(spec);
  const std::size_t all = samples.size();
  std::erase_if(samples, [](const AuditSample& sample) {
    const Outcome& outcome = sample.outcome;
    return outcome.later_jumps.empty() || outcome.later_jumps.size() > 3;
  });
  ASSERT_GE(samples.size(), 1u) << "of " << all;
  for (AuditSample& sample : samples) sample.outcome.later_jumps.push_back(sample.outcome.later_jumps.back());
  const AuditReport report = audit(spec, samples, 0);
  EXPECT_GE(report.sequences_wrong, 1u)
      << "of " << samples.size() << ", not all of which integration is sure of";
}

TEST(AuditOfSequences, ConvictsNobodyWhereTheSecondMethodGivesUp) {
  // A heavy mass near Painleve's edge, where integration fails after the first jump and exact makes six.
  const Spec spec =
      read_spec("", {"friction=coulomb", "jumps=6", "runway=60", "slope={values=[0.4725855418965418]}",
                     "mass_ratio=103.97292484129952", "offset_ratio=0.7575709330529341",
                     "mu_static=0.5397937326782717", "inertia_factor=0.5", "audit=1"});
  const auto samples = solved_all(spec);
  ASSERT_EQ(samples.size(), 1u);
  ASSERT_GE(samples[0].outcome.jumps(), 3u);
  const AuditReport report = audit(spec, samples, 1);
  EXPECT_EQ(report.sequences_wrong, 0u);
  EXPECT_EQ(report.jumps_compared + report.jumps_beyond, samples[0].outcome.later_jumps.size());
  EXPECT_GE(report.jumps_beyond, 1u);
}

TEST(AuditOfSequences, LooksAtNoJumpThatNobodyAskedFor) {
  const Spec spec = lively_grid("sticking", {"jumps=3", "fields=[\"jump_height\"]"});
  const auto samples = solved_all(spec);
  for (const AuditSample& sample : samples) EXPECT_TRUE(sample.outcome.later_jumps.empty());
  const AuditReport report = audit(spec, samples, 0);
  EXPECT_EQ(report.jumps_compared + report.jumps_beyond + report.sequences_wrong, 0u);
  EXPECT_FALSE(disagree(report));
}

TEST(AuditOfSequences, ComparesAsManyJumpsAsTheConditionAllows) {
  std::vector<std::string> given = chaotic;
  given.insert(given.end(),
               {"jumps=100", "runway=1000", "release_angle={from=2.9,to=3.1,count=10}", "audit=1"});
  const Spec spec = read_spec("", given);
  const auto samples = solved_all(spec);
  ASSERT_EQ(samples.size(), 10u);
  std::size_t later = 0;
  for (const AuditSample& sample : samples) later += sample.outcome.later_jumps.size();
  ASSERT_GE(later, 500u);
  const AuditReport report = audit(spec, samples, 0);
  EXPECT_EQ(report.sequences_wrong, 0u);
  // As many as derivatives say, but for those that integration is itself unsure of.
  std::size_t within = 0;
  const DesignSpace space(spec);
  for (const AuditSample& sample : samples) {
    const auto growth = ErrorGrowth(spec.scene, 1e-10).along(space.at(sample.number), 100);
    within += static_cast<std::size_t>(std::ranges::find_if(growth, [](double g) { return !(g <= 1e5); }) -
                                       growth.begin()) -
              1;
  }
  EXPECT_LE(report.jumps_compared, within);
  EXPECT_GE(report.jumps_compared, within - within / 10);
  EXPECT_EQ(report.jumps_compared + report.jumps_beyond, later);
  EXPECT_LT(within, later / 2);
}

TEST(ErrorGrowth, IsExponentialInChaosAndBoundedOnTheWayToAStableGait) {
  Scene scene{.runway = 1000.0};
  scene.jumps = 60;
  const Design wild{.slope = 0.35, .mass_ratio = 3.0, .offset_ratio = 0.8},
      tame{.slope = 0.2094395102393195, .mass_ratio = 3.0, .offset_ratio = 0.5};
  const std::vector<double> growing = ErrorGrowth(scene, 1e-12).along(wild, 60),
                            bounded = ErrorGrowth(scene, 1e-12).along(tame, 60);
  ASSERT_EQ(growing.size(), 60u);
  EXPECT_GE(growing.back(), 1e5);
  ASSERT_EQ(bounded.size(), 60u);
  EXPECT_LE(*std::ranges::max_element(bounded), 1e3);
  scene.runway = 5.0;
  const auto gaits = find_gaits(tame, scene).gaits;
  ASSERT_TRUE(std::ranges::any_of(gaits, &Gait::is_stable));
}

TEST(ErrorGrowth, IsHowFarSequencesPartThatBeginBesideEachOther) {
  Scene scene{.runway = 1000.0, .radius = 1.0, .gravity = 1.0};
  scene.jumps = 12;
  constexpr double apart = 1e-9;
  std::size_t compared = 0;
  double largest = 0.0;
  for (double angle = 2.9; angle < 3.1; angle += 0.01) {
    Design design{.slope = 0.35, .mass_ratio = 3.0, .offset_ratio = 0.8, .release_angle = angle};
    const Outcome here = solve(design, scene, {.tolerance = 1e-12});
    design.release_angle += apart;
    const Outcome there = solve(design, scene, {.tolerance = 1e-12});
    design.release_angle -= apart;
    const std::vector<double> growth = ErrorGrowth(scene, 1e-12).along(design, here.jumps());
    for (std::size_t k = 0; k < std::min(here.later_jumps.size(), there.later_jumps.size()); ++k) {
      if (!(growth[k + 1] < 1e5)) break;
      // What began alone is no more than what began there and at every landing.
      EXPECT_LE(std::abs(there.later_jumps[k].landing_spin - here.later_jumps[k].landing_spin),
                2.0 * apart * growth[k + 1] + 1e-12 * growth[k + 1])
          << "jump " << k + 2 << " from " << angle;
      largest =
          std::max(largest, std::abs(there.later_jumps[k].landing_spin - here.later_jumps[k].landing_spin) /
                                (apart * growth[k + 1]));
      ++compared;
    }
  }
  EXPECT_GE(compared, 60u);
  EXPECT_GE(largest, 0.1) << "nor is it far less";
}

TEST(AuditOfGaits, FindsThemByIntegration) {
  for (const std::string friction : {"sticking", "coulomb"}) {
    const Spec spec = lively_grid(friction, {"settle=200"});
    const auto samples = solved_all(spec);
    const AuditReport report = audit(spec, samples, 0);
    EXPECT_GE(report.gaits, friction == "sticking" ? 8u : 4u);
    EXPECT_EQ(report.gaits_wrong, 0u);
    EXPECT_LE(report.gaits_undecided, report.gaits / 4);
    EXPECT_LE(report.gait_max_error, 1e-8);
    EXPECT_LE(report.multiplier_max_error, 1e-6);
  }
}

TEST(AuditOfGaits, SeesAWrongOne) {
  const Spec spec = lively_grid("sticking", {"settle=200"});
  const auto right = solved_all(spec);
  const auto chosen =
      std::ranges::find_if(right, [](const AuditSample& sample) { return sample.outcome.gait_period == 1; });
  ASSERT_NE(chosen, right.end());
  const auto convicted = [&](const auto& spoil) {
    std::vector<AuditSample> one{*chosen};
    spoil(one[0].outcome);
    return audit(spec, one, 1).gaits_wrong == 1;
  };
  EXPECT_FALSE(convicted([](Outcome&) {}));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.gait_period = 2; }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.gait_height += 1e-6; }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.gait_speed *= 1.0 + 1e-5; }));
  EXPECT_TRUE(convicted([](Outcome& outcome) { outcome.gait_multiplier += 1e-5; }));
}

}  // namespace
}  // namespace leapmap
