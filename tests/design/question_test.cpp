// SPDX-License-Identifier: GPL-3.0-or-later
/// What leapmap design is asked, and refuses to be asked.
#include "design/question.hpp"

#include <gtest/gtest.h>

#include "leapmap/errors.hpp"
#include "spec/spec.hpp"
#include "support/refusal.hpp"

namespace leapmap {
namespace {

const std::string box =
    "[design]\nslope = { from = \"2 deg\", to = \"20 deg\" }\nmass_ratio = { from = 0.1, to = 20, scale = "
    "\"log\" }\n";

TEST(Question, HasTheFreeParametersInTheirOrderAndTheirSpacing) {
  const Question question =
      question_of(parse_spec(box + "[goal]\njump_height = { at_least = 1.0 }\nminimize = [\"mass_ratio\"]"));
  ASSERT_EQ(question.free.size(), 2u);
  EXPECT_EQ(question.free[0].name, "slope");
  EXPECT_FALSE(question.free[0].side.log);
  EXPECT_TRUE(question.free[1].side.log);
  ASSERT_EQ(question.objectives.size(), 1u);
  EXPECT_FALSE(question.objectives[0].maximize);
  EXPECT_EQ(question.free[question.objectives[0].parameter].name, "mass_ratio");
  EXPECT_EQ(question.one.goals.size(), 1u);
  EXPECT_TRUE(question.one.axes.empty());
}

TEST(Question, ReachesTheBoundsToTheLastBitAndTheMiddleByItsSpacing) {
  const Question question = question_of(parse_spec(box + "[goal]\nmaximize = [\"jump_height\"]"));
  const double low = question.free[0].side.low, high = question.free[0].side.high;
  const auto design_at = [&](const std::vector<double>& place) {
    return question.designs.at(question.values(place));
  };
  EXPECT_EQ(design_at({0.0, 1.0}).slope, low);
  EXPECT_EQ(design_at({1.0, 1.0}).slope, high);
  EXPECT_EQ(design_at({0.0, 0.0}).mass_ratio, 0.1);
  EXPECT_EQ(design_at({0.0, 1.0}).mass_ratio, 20.0);
  EXPECT_DOUBLE_EQ(design_at({0.5, 0.5}).slope, 0.5 * (low + high));
  EXPECT_NEAR(design_at({0.5, 0.5}).mass_ratio, std::sqrt(2.0), 1e-14)
      << "sqrt(0.1 * 20), to roundings of exp and log";
}

TEST(Question, TakesAGridsRangesToo) {
  const Question question = question_of(
      parse_spec("[design]\nslope = { from = 0.1, to = 0.4, count = 7 }\nmass_ratio = { from = 0.1, to = 20, "
                 "count = 9, scale = \"log\" }\noffset_ratio = { from = 0.5, to = 1, count = 3 }\n[goal]\n"
                 "maximize = [\"jump_height\"]"));
  EXPECT_EQ(question.free[0].side.high, 0.4);
  EXPECT_EQ(question.free[2].side.low, 0.5) << "however few values";
  EXPECT_TRUE(question.free[1].side.log);
}

TEST(Question, IsToldByItsResolvedText) {
  const Spec spec = parse_spec(box +
                               "[scatter]\nslope = { normal = 0.01 }\n[goal]\njump_height = { at_least = 1.0 "
                               "}\nyield = { at_least = 0.9 }\nmaximize = [\"yield\", \"mass_ratio\"]");
  const Spec again = parse_spec(resolved_text(spec));
  EXPECT_EQ(resolved_text(again), resolved_text(spec));
  EXPECT_EQ(again.maximize, spec.maximize);
  ASSERT_EQ(again.axes.size(), 2u);
  EXPECT_TRUE(again.axes[0].free && again.axes[1].log);
}

struct BadQuestion {
  const char* name;
  std::string text;
  std::vector<const char*> told;
};
void PrintTo(const BadQuestion& question, std::ostream* out) { *out << question.name; }

class BadQuestions : public ::testing::TestWithParam<BadQuestion> {};

TEST_P(BadQuestions, AreRefusedWithOneLineThatSaysWhy) {
  std::string line = testing::accepted;
  try {
    question_of(parse_spec(GetParam().text, "q.toml"));
  } catch (const InputError& error) {
    line = error.what();
  }
  testing::expect_one_line(line, GetParam().told);
  EXPECT_NE(line.find("allowed"), std::string::npos) << line;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadQuestions,
    ::testing::Values(
        BadQuestion{"nothing_is_free", "[goal]\nmaximize = [\"jump_height\"]", {"no parameter is free"}},
        BadQuestion{"no_objective", box, {"maximize", "minimize", "no objective"}},
        BadQuestion{"three_objectives",
                    box + "[goal]\nmaximize = [\"jump_height\", \"jump_time\", \"slope\"]",
                    {"3 quantities"}},
        BadQuestion{"unknown_field", box + "[goal]\nmaximize = [\"jump_hight\"]", {"jump_hight", "unknown"}},
        BadQuestion{"unknown_goal",
                    box + "[goal]\njump_hight = { at_least = 1.0 }\nmaximize = [\"jump_height\"]",
                    {"jump_hight", "unknown key"}},
        BadQuestion{"fixed_parameter",
                    box + "[goal]\nminimize = [\"offset_ratio\"]",
                    {"offset_ratio is fixed", "from, to"}},
        BadQuestion{"a_code", box + "[goal]\nmaximize = [\"status\"]", {"status is a code"}},
        BadQuestion{"both_ways",
                    box + "[goal]\nmaximize = [\"jump_height\"]\nminimize = [\"jump_height\"]",
                    {"jump_height", "both"}},
        BadQuestion{"bounds_the_wrong_way",
                    "[design]\nslope = { from = 0.3, to = 0.1 }\n[goal]\nmaximize = [\"jump_height\"]",
                    {"'from' is not below 'to'"}},
        BadQuestion{"bound_that_no_hoop_has",
                    "[design]\nmass_ratio = { from = -1, to = 2 }\n[goal]\nmaximize = [\"jump_height\"]",
                    {"mass_ratio", "'from'", "out of range"}},
        BadQuestion{"a_list_of_values",
                    "[design]\nslope = { values = [0.1, 0.2, 0.5] }\n[goal]\nmaximize = [\"jump_height\"]",
                    {"slope", "list of values"}},
        BadQuestion{"two_values",
                    "[design]\nslope = { values = [0.1, 0.5] }\n[goal]\nmaximize = [\"jump_height\"]",
                    {"slope", "list of values"}},
        BadQuestion{
            "values_at_equal_steps",
            "[design]\nslope = { values = [0.1, 0.2, 0.3, 0.4] }\n[goal]\nmaximize = [\"jump_height\"]",
            {"slope", "list of values"}},
        BadQuestion{"a_percentage_of_a_bound_beyond_zero",
                    "[design]\nslope = { from = -0.1, to = 0.5 }\n[scatter]\nslope = { normal = \"5 %\" }\n"
                    "[goal]\nmaximize = [\"jump_height\"]",
                    {"scatter.slope", "of zero"}},
        BadQuestion{
            "a_goal_against_itself",
            box + "[goal]\njump_time = { at_least = 2.0, at_most = 1.0 }\nmaximize = [\"jump_height\"]",
            {"contradicts itself"}},
        BadQuestion{"a_height_below_every_jump",
                    box + "[goal]\njump_height = { at_most = 0.01 }\nmaximize = [\"jump_height\"]",
                    {"jump_height", "impossible", "0.05"}},
        BadQuestion{"a_negative_time",
                    box + "[goal]\njump_time = { at_most = -1.0 }\nmaximize = [\"jump_height\"]",
                    {"jump_time", "impossible"}},
        BadQuestion{"a_jump_of_what_stalls",
                    box + "[goal]\nstatus = { is = \"stalled\" }\nmaximize = [\"jump_height\"]",
                    {"status", "contradicts jump_height"}},
        BadQuestion{"a_yield_without_scatter",
                    box + "[goal]\njump_height = { at_least = 0.5 }\nmaximize = [\"yield\"]",
                    {"yield", "[scatter]"}},
        BadQuestion{"a_yield_goal_without_scatter",
                    box + "[goal]\nyield = { at_least = 0.5 }\nmaximize = [\"jump_height\"]",
                    {"yield", "[scatter]"}},
        BadQuestion{"a_yield_of_nothing",
                    box + "[scatter]\nslope = { normal = 0.01 }\n[goal]\nmaximize = [\"yield\"]",
                    {"yield", "every goal", "[goal]"}},
        BadQuestion{"friction_without_friction",
                    box + "[goal]\nminimize = [\"slip_distance\"]",
                    {"slip_distance", "coulomb"}}));

TEST(Question, IsNoneOfASweepsSpec) {
  const Spec free = parse_spec(box);
  EXPECT_THROW(check_spec(free), InputError);
  const Spec objective = parse_spec("[goal]\nmaximize = [\"jump_height\"]");
  EXPECT_THROW(check_spec(objective), InputError);
}

}  // namespace
}  // namespace leapmap
