// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "sweep/designs.hpp"
#include "sweep/engine.hpp"

namespace leapmap {
namespace {

Spec grid(const std::string& method, const std::string& tolerance, const std::string& share) {
  return read_spec("", {"slope={from=0.1,to=0.8,count=40}", "mass_ratio={from=0.5,to=10,count=40}",
                        "method=" + method, "tolerance=" + tolerance, "audit=" + share});
}

std::vector<AuditSample> drawn_from(const Spec& spec, int threads = 0) {
  const Tiling tiling(shape_of(spec));
  std::vector<AuditSample> samples;
  EngineOptions options;
  options.threads = threads;
  run_sweep(spec, tiling, options, in_order([&](const Tile& tile, std::span<const Outcome> outcomes) {
              std::ranges::copy(audit_samples(spec, tiling, tile, outcomes), std::back_inserter(samples));
            }));
  return samples;
}

TEST(Audit, DrawsTheShareAskedForEachDesignOnceAndKnowsItsNumber) {
  for (const auto& [share, count] : {std::pair{"0.001", 2u}, {"0.1", 160u}, {"1", 1600u}}) {
    const Spec spec = grid("exact", "1e-12", share);
    const auto samples = drawn_from(spec);
    EXPECT_EQ(samples.size(), count);
    std::set<std::size_t> numbers;
    const DesignSpace space(spec);
    for (const AuditSample& sample : samples) {
      numbers.insert(sample.number);
      if (sample.outcome.status == Status::jumped) {
        // jump_distance is rolled from the release; only the right design's spin has that height
        const double rolled = sample.outcome.jump_angle - space.at(sample.number).release_angle;
        EXPECT_EQ(sample.outcome.jump_distance, rolled);
      }
    }
    EXPECT_EQ(numbers.size(), count);
  }
}

TEST(Audit, FindsExactAndIntegrationInAgreement) {
  const Spec spec = grid("auto", "1e-12", "0.3");
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_EQ(report.designs, 480u);
  EXPECT_EQ(report.method, "gsl-rk8pd");
  EXPECT_EQ(report.flag_mismatches + report.beyond_tolerance + report.undecided, 0u);
  EXPECT_GT(report.max_abs_height_error, 0.0) << "two methods never agree to the last bit everywhere";
  EXPECT_LT(report.max_abs_height_error, 1e-11);
}

TEST(Audit, FindsWhatALooseIntegrationGetsWrong) {
  const Spec spec = grid("gsl-rk8pd", "3e-3", "1");
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_EQ(report.method, "exact");
  EXPECT_EQ(report.designs, 1600u);
  EXPECT_GT(report.flag_mismatches, 0u);
  EXPECT_TRUE(report.first_mismatch);
}

TEST(Audit, SeesAWrongNumberThatWasStored) {
  const Spec spec = grid("exact", "1e-10", "1");
  auto samples = drawn_from(spec);
  const auto jumped =
      std::ranges::find_if(samples, [](const AuditSample& s) { return s.outcome.status == Status::jumped; });
  ASSERT_NE(jumped, samples.end());
  jumped->outcome.jump_time *= 1.0 + 1e-9;
  AuditReport report = audit(spec, samples, 0);
  EXPECT_EQ(report.first_inaccurate, jumped->number);
  EXPECT_EQ(report.beyond_tolerance, 1u);
  jumped->outcome.spurious_first_jump ^= 1;
  report = audit(spec, samples, 0);
  EXPECT_EQ(report.first_mismatch, jumped->number);
}

TEST(Audit, OfAMapInF4TellsTheErrorOfF4) {
  Spec spec = grid("exact", "1e-12", "0.3");
  spec.output.precision = "f4";
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_GT(report.max_rel_time_error, 1e-9);
  EXPECT_LT(report.max_rel_time_error, 6e-8);
  EXPECT_EQ(report.beyond_tolerance, 0u);
}

TEST(Audit, AllowsForWhatTheInputsRoundingsDo) {
  // A millionth of a millionth of a radian past the unstable equilibrium: the time is good to 1e-5 at best.
  const double equilibrium = std::numbers::pi - std::asin(std::sin(0.4) / (20.0 / 28.2)) - 0.4;
  const Spec spec = read_spec("", {fmt::format("release_angle={}", equilibrium + 1e-12), "audit=1"});
  const AuditReport report = audit(spec, drawn_from(spec), 1);
  EXPECT_GT(report.max_rel_time_error, 1e-10);
  EXPECT_EQ(report.beyond_tolerance, 0u);
}

TEST(Audit, DoesNotDependOnTheNumberOfThreads) {
  const Spec spec = grid("exact", "1e-5", "0.3");
  const AuditReport one = audit(spec, drawn_from(spec, 1), 1), four = audit(spec, drawn_from(spec, 4), 4);
  EXPECT_EQ(one.designs, four.designs);
  EXPECT_EQ(one.max_abs_height_error, four.max_abs_height_error);
  EXPECT_EQ(one.max_rel_time_error, four.max_rel_time_error);
  EXPECT_EQ(one.first_mismatch, four.first_mismatch);
}

TEST(Audit, DoesNotTakeADesignThatFailedForADisagreement) {
  Spec spec = grid("gsl-rk8pd", "1e-10", "0.3");
  spec.numerics.max_steps = 40;
  const auto samples = drawn_from(spec);
  const auto failed =
      std::ranges::count(samples, Status::failed, [](const AuditSample& s) { return s.outcome.status; });
  const AuditReport report = audit(spec, samples, 0);
  EXPECT_GT(report.failed, 0u);
  EXPECT_EQ(report.failed, static_cast<std::size_t>(failed));
  EXPECT_LT(report.failed, report.designs);
  EXPECT_EQ(report.flag_mismatches + report.beyond_tolerance, 0u);
}

TEST(Audit, NeverAuditsAMethodByItself) {
  Numerics numerics;
  EXPECT_NE(audit_method(numerics), resolved_method(numerics));
  for (const GslStepper& stepper : gsl_steppers()) {
    numerics.method = stepper.name;
    EXPECT_EQ(audit_method(numerics), "exact");
  }
}

}  // namespace
}  // namespace leapmap
