// SPDX-License-Identifier: GPL-3.0-or-later
#include "request/request.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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
