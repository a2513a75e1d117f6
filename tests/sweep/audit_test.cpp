// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit.hpp"

#include <gtest/gtest.h>

#include "sweep/designs.hpp"

namespace leapmap {
namespace {

Spec grid(const std::string& tolerance, const std::string& share) {
  return read_spec("", {"slope={from=0.1,to=0.8,count=40}", "mass_ratio={from=0.5,to=10,count=40}",
                        "tolerance=" + tolerance, "audit=" + share});
}

TEST(Audit, SolvesTheShareAskedForByAnotherMethodAndAgreesAtATightTolerance) {
  const AuditReport report = audit(grid("1e-12", "0.1"), 0);
  EXPECT_EQ(report.designs, 160u);
  EXPECT_EQ(report.method, "gsl-rkck");
  EXPECT_EQ(report.flag_mismatches, 0u);
  EXPECT_FALSE(report.first_mismatch);
  EXPECT_GT(report.max_abs_height_error, 0.0) << "two methods never agree to the last bit everywhere";
  EXPECT_LT(report.max_abs_height_error, 1e-9);
}

TEST(Audit, FindsWhatALooseToleranceGetsWrong) {
  const Spec spec = grid("3e-3", "1");
  const AuditReport report = audit(spec, 0);
  EXPECT_EQ(report.designs, 1600u);
  EXPECT_GT(report.flag_mismatches, 0u);
  ASSERT_TRUE(report.first_mismatch);
  // The design named is one that the two methods really see differently.
  const Design design = DesignSpace(spec).at(*report.first_mismatch);
  RollingIntegration ours(integration_options(spec.numerics)), theirs(audit_method(spec.numerics).options);
  const Outcome a = ours.solve(design, spec.scene), b = theirs.solve(design, spec.scene);
  EXPECT_TRUE(a.status != b.status || a.spurious_first_jump != b.spurious_first_jump ||
              a.candidates != b.candidates);
}

TEST(Audit, DoesNotDependOnTheNumberOfThreads) {
  const Spec spec = grid("1e-5", "0.3");
  const AuditReport one = audit(spec, 1), four = audit(spec, 4);
  EXPECT_EQ(one.designs, four.designs);
  EXPECT_EQ(one.max_abs_height_error, four.max_abs_height_error);
  EXPECT_EQ(one.max_rel_time_error, four.max_rel_time_error);
  EXPECT_EQ(one.first_mismatch, four.first_mismatch);
}

TEST(Audit, NeverAuditsAMethodByItself) {
  for (const GslStepper& stepper : gsl_steppers()) {
    Numerics numerics;
    numerics.method = stepper.name;
    EXPECT_NE(audit_method(numerics).name, stepper.name);
  }
  EXPECT_NE(audit_method(Numerics{}).name, resolved_method(Numerics{}));
}

}  // namespace
}  // namespace leapmap
