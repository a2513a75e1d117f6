// SPDX-License-Identifier: GPL-3.0-or-later
#include "request/request.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "request/solver.hpp"
#include "spec/spec.hpp"

namespace leapmap {
namespace {

std::vector<std::string> names_of(const std::vector<const Field*>& columns) {
  std::vector<std::string> names;
  for (const Field* column : columns) names.emplace_back(column->name);
  return names;
}

using Names = std::vector<std::string>;

TEST(Request, HasTheColumnsThatTheSpecNamesInTheOrderOfTheFile) {
  const Spec spec =
      read_spec("", {"fields=[\"status\", \"jump_height\"]", "gradients=[\"jump_time\", \"jump_height\"]",
                     "gradients_by=[\"mass_ratio\", \"slope\"]"});
  EXPECT_EQ(names_of(columns_of(spec)),
            (Names{"jump_height", "status", "jump_time_by_slope", "jump_time_by_mass_ratio",
                   "jump_height_by_slope", "jump_height_by_mass_ratio"}));
  const GradientWanted wanted = derivatives_of(request_of(spec));
  ASSERT_EQ(wanted.of.size(), 2u);
  EXPECT_EQ(wanted.of[0], OutcomeNumber(&Outcome::jump_time));
  EXPECT_EQ(wanted.by, (std::vector<std::size_t>{0, 1}));  // slope, mass_ratio
}

TEST(Request, LeavesOutByDefaultWhatMustBeNamed) {
  const Spec spec = read_spec("", {"jumps=3"});
  EXPECT_FALSE(wants(request_of(spec), "sequence_condition"));
  EXPECT_TRUE(wants(request_of(spec), "jump_height_3"));
  EXPECT_TRUE(wants(request_of_everything(spec), "sequence_condition"));
}

TEST(Request, FollowsNoMoreJumpsThanItsColumnsNeed) {
  const Spec spec = read_spec("", {"jumps=5", "gait.settle=40"});
  const auto followed = [&](const char* column) { return request_of(spec, {find_field(column)}); };
  EXPECT_EQ(scene_asked(followed("jump_height")).jumps, 1);
  EXPECT_EQ(scene_asked(followed("jump_height_3")).jumps, 5);
  EXPECT_EQ(scene_asked(followed("jump_height_3_by_slope")).jumps, 5);
  EXPECT_EQ(scene_followed(followed("jump_height")).jumps, 1);
  EXPECT_EQ(scene_followed(followed("gait_height")).jumps, 40);
}

TEST(Request, HasEachColumnAsAmongAllOthers) {
  for (const char* friction : {"sticking", "coulomb"}) {
    const Spec spec = read_spec("", {fmt::format("scene.friction={}", friction), "clear_height=0.1",
                                     "slope=0.3", "mass_ratio=3", "offset_ratio=0.8"});
    const auto solved = [&](const std::vector<const Field*>& columns) {
      Outcome outcome;
      make_solver(request_of(spec, columns))({&spec.design, 1}, {&outcome, 1});
      return outcome;
    };
    const std::vector<const Field*> fields = fields_of(spec.scene);
    const Outcome all = solved(fields);
    ASSERT_EQ(all.status, Status::jumped);
    for (const Field* field : fields) {
      if (std::holds_alternative<Word>(field->source)) continue;
      const double among_all = stored_number(*field, all), alone = stored_number(*field, solved({field}));
      EXPECT_EQ(std::isnan(alone), std::isnan(among_all)) << field->name << ", " << friction;
      if (std::isnan(among_all)) continue;
      // Times may be known to more digits where others are asked for: all are good to 1e-9.
      EXPECT_NEAR(alone, among_all, 1e-8 * (1.0 + std::abs(among_all))) << field->name << ", " << friction;
    }
  }
}

TEST(Request, AsksOfASampleWhatItsGoalsAndStatisticsNeed) {
  const Spec spec =
      read_spec("", {"scatter.slope={normal=0.01}", "goal.jump_time={at_most=1}", "fields=[\"jump_angle\"]"});
  const Request request = request_of(spec);
  EXPECT_TRUE(wants_samples(request));
  EXPECT_TRUE(wants(request, "jump_angle_mean") && wants(request, "yield"));
  const Request sample = request_of_sample(request);
  EXPECT_EQ(names_of(sample.columns), (Names{"status", "jump_time", "jump_angle"}));
  EXPECT_FALSE(wants_samples(sample));
  EXPECT_FALSE(wants_samples(request_of(spec, {find_field("status")})));
}

}  // namespace
}  // namespace leapmap
