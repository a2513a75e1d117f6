// SPDX-License-Identifier: GPL-3.0-or-later
/// Against 40-digit arithmetic by programs that share no code with this one (tests/reference).
#include <gtest/gtest.h>

#include "support/designs.hpp"
#include "support/reference_table.hpp"

namespace leapmap {
namespace {

/// Tolerances of one table: absolute for heights, relative for times.
struct Tolerance {
  double height, time;
};

void compare_with(const std::string& table, const Tolerance& tolerance) {
  RollingIntegration rolling(testing::adaptive("gsl-rk8pd", 1e-12));
  const auto rows = testing::read_reference(table);
  ASSERT_FALSE(rows.empty());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const std::string where = table + " row " + std::to_string(i + 1);
    const Outcome outcome = rolling.solve(row.design(), testing::idle_scene());
    EXPECT_EQ(name_of(outcome.status), row.cells.at("status")) << where;
    if (row.has("candidates")) {
      EXPECT_EQ(outcome.candidates, row.number("candidates")) << where;
    }
    EXPECT_EQ(outcome.spurious_first_jump, row.has("spurious") ? row.number("spurious") : 255) << where;
    const auto check = [&](const std::string& name, double value, double allowed) {
      if (row.has(name)) {
        EXPECT_NEAR(value, row.number(name), allowed) << where << " " << name;
      } else {
        EXPECT_TRUE(std::isnan(value)) << where << " " << name;
      }
    };
    const auto height = [&](const std::string& name, double value) { check(name, value, tolerance.height); };
    const auto time = [&](const std::string& name, double value) {
      check(name, value, row.has(name) ? tolerance.time * std::abs(row.number(name)) : 0.0);
    };
    height("jump_height", outcome.jump_height);
    height("first_jump_height", outcome.first_jump_height);
    height("dip", outcome.dip);
    time("jump_time", outcome.jump_time);
    time("jump_angle", outcome.jump_angle);
    time("jump_spin", outcome.jump_spin);
    time("apex_time", outcome.apex_time);
    time("flight_time", outcome.flight_time);
    time("first_jump_time", outcome.first_jump_time);
  }
}

// The integration's own error at 1e-12 is about 1e-12 (measured: 8e-13).
TEST(ReferenceTables, ReleasesFromRestAtTheTop) { compare_with("noslip_top_release.csv", {1e-11, 1e-11}); }
TEST(ReferenceTables, GeneralReleases) { compare_with("noslip_general.csv", {1e-11, 1e-11}); }
TEST(ReferenceTables, HoopsThatTurnRound) { compare_with("noslip_turning.csv", {1e-11, 1e-11}); }
TEST(ReferenceTables, DrivenHoops) { compare_with("noslip_drive.csv", {1e-11, 1e-11}); }
// Mass ratios to 1e9 and releases 1e-9 rad from an unstable equilibrium amplify any error by up to 1e9: times
// are good to 2e-6 here, and no status, flag or count is wrong.
TEST(ReferenceTables, StressedDesigns) { compare_with("noslip_stress.csv", {1e-9, 1e-5}); }

}  // namespace
}  // namespace leapmap
