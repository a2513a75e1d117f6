// SPDX-License-Identifier: GPL-3.0-or-later
/// Every kind of bad input is refused with one line that names file, key, value and what is allowed.
#include <gtest/gtest.h>

#include "leapmap/errors.hpp"
#include "spec/spec.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

struct BadSpec {
  const char* name;
  const char* text;
  std::vector<const char*> told;  ///< what the line must contain
};

void PrintTo(const BadSpec& spec, std::ostream* out) { *out << spec.name; }

class BadSpecs : public ::testing::TestWithParam<BadSpec> {};

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const testing::TemporaryFolder folder;
  folder.write("empty.csv", "");
  folder.write("header_only.csv", "slope\n");
  folder.write("unknown_column.csv", "slope,sloppe\n0.1,0.2\n");
  folder.write("twice.csv", "slope,slope\n0.1,0.2\n");
  folder.write("too_many.csv", "slope,mass_ratio\n0.1,0.2\n0.1,0.2,0.3\n");
  folder.write("too_few.csv", "slope,mass_ratio\n0.1\n");
  folder.write("words.csv", "slope\n0.1\nsteep\n");
  folder.write("nan.csv", "slope\nnan\n");
  folder.write("negative.csv", "mass_ratio\n-1\n");
  folder.write("good.csv", "slope\n0.1\n");
  folder.write("mu.csv", "slope,mu_static\n0.1,0.4\n");
  try {
    check_spec(read_spec(folder.write("spec.toml", text), overrides));  // as a sweep does
  } catch (const InputError& error) {
    return error.what();
  }
  return testing::accepted;
}

TEST_P(BadSpecs, AreRefusedWithOneLineThatSaysWhy) {
  testing::expect_one_line(refusal(GetParam().text), GetParam().told);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadSpecs,
    ::testing::Values(
        BadSpec{"not_toml", "[design\nslope = 1", {"spec.toml:1", "not TOML"}},
        BadSpec{"word_without_quotes", "[numerics]\nmethod = exact", {"spec.toml:2", "not TOML"}},
        BadSpec{"unit_without_quotes",
                "[design]\nslope = 12 deg",
                {"spec.toml:2", "not TOML", "needs quotes: \"12 deg\""}},
        BadSpec{"unknown_key",
                "[design]\nslop = 0.4",
                {"spec.toml:2", "design.slop", "unknown key", "allowed", "slope"}},
        BadSpec{
            "unknown_section", "[desing]\nslope = 0.4", {"spec.toml:1", "[desing]", "allowed", "[design]"}},
        BadSpec{"key_outside_a_section", "slope = 0.4", {"spec.toml:1", "slope"}},
        BadSpec{"key_in_the_wrong_section", "[scene]\nslope = 0.4", {"scene.slope", "unknown key"}},
        BadSpec{"missing_to",
                "[design]\nslope = { from = 0.1, count = 3 }",
                {"spec.toml:2", "'to' is missing", "allowed"}},
        BadSpec{"missing_from", "[design]\nslope = { to = 0.1, count = 3 }", {"'from' is missing"}},
        BadSpec{"missing_count", "[design]\nslope = { from = 0.1, to = 0.2 }", {"'count' is missing"}},
        BadSpec{"count_0", "[design]\nslope = { from = 0.1, to = 0.2, count = 0 }", {"count", "allowed"}},
        BadSpec{"count_too_large",
                "[design]\nslope = { from = 0.1, to = 0.2, count = 10000000 }",
                {"count", "1000000"}},
        BadSpec{"value_twice", "[design]\nslope = { values = [0.1, 0.2, 0.1] }", {"slope", "twice"}},
        BadSpec{"no_fields", "[output]\nfields = []", {"fields", "jump_height"}},
        BadSpec{"count_negative", "[design]\nslope = { from = 0.1, to = 0.2, count = -3 }", {"count"}},
        BadSpec{"count_fraction",
                "[design]\nslope = { from = 0.1, to = 0.2, count = 2.5 }",
                {"count", "whole number"}},
        BadSpec{"count_1_of_two", "[design]\nslope = { from = 0.1, to = 0.2, count = 1 }", {"count"}},
        BadSpec{"equal_bounds", "[design]\nslope = { from = 0.1, to = 0.1, count = 4 }", {"'from' and 'to'"}},
        BadSpec{"log_from_0",
                "[design]\nmass_ratio = { from = 0, to = 2, count = 4, scale = \"log\" }",
                {"log", "> 0"}},
        BadSpec{"unknown_scale",
                "[design]\nmass_ratio = { from = 1, to = 2, count = 4, scale = \"cubic\" }",
                {"scale", "linear"}},
        BadSpec{
            "scale_not_text", "[design]\nmass_ratio = { from = 1, to = 2, count = 4, scale = 3 }", {"scale"}},
        BadSpec{"axis_typo", "[design]\nslope = { form = 0.1, to = 0.2, count = 3 }", {"'form'", "allowed"}},
        BadSpec{"step_that_misses_the_end",
                "[design]\nslope = { from = 0.1, to = 0.2, step = 0.03 }",
                {"'step' leads 3.33", "whole number of steps"}},
        BadSpec{"step_of_0", "[design]\nslope = { from = 0.1, to = 0.2, step = 0 }", {"'step'"}},
        BadSpec{
            "tiny_step", "[design]\nslope = { from = 0.0, to = 1.0, step = 1e-9 }", {"'step' is too small"}},
        BadSpec{"step_and_count",
                "[design]\nslope = { from = 0.1, to = 0.2, step = 0.1, count = 2 }",
                {"'count' does not belong"}},
        BadSpec{"values_and_bounds", "[design]\nslope = { values = [0.1], to = 0.2 }", {"'to'"}},
        BadSpec{"no_values", "[design]\nslope = { values = [] }", {"values"}},
        BadSpec{"too_many_designs",
                "[design]\nslope = { from = 0, to = 1, count = 1000000 }\nmass_ratio = { from = 0, to = 1, "
                "count = 1000000 }\noffset_ratio = { from = 0, to = 1, count = 2 }",
                {"designs", "at most"}},
        BadSpec{"negative_mass_ratio",
                "[design]\nmass_ratio = -1",
                {"spec.toml:2", "mass_ratio = -1", "[0, 1000000000000]"}},
        BadSpec{"negative_mass_ratio_in_an_axis",
                "[design]\nmass_ratio = { values = [1, -1] }",
                {"mass_ratio", "-1"}},
        BadSpec{"slope_of_91_degrees", "[design]\nslope = \"91 deg\"", {"design.slope", "91 deg", "90 deg"}},
        BadSpec{"slope_of_90_degrees", "[design]\nslope = \"90 deg\"", {"90 deg"}},
        BadSpec{"slope_axis_to_91_degrees",
                "[design]\nslope = { from = \"2 deg\", to = \"91 deg\", count = 3 }",
                {"91 deg"}},
        BadSpec{"nan", "[design]\nslope = nan", {"slope = nan", "allowed"}},
        BadSpec{"infinite", "[design]\nmass_ratio = inf", {"mass_ratio = inf"}},
        BadSpec{"text_for_a_number", "[design]\nmass_ratio = \"heavy\"", {"mass_ratio", "heavy", "number"}},
        BadSpec{"degrees_for_a_ratio", "[design]\nmass_ratio = \"2 deg\"", {"mass_ratio", "number"}},
        BadSpec{"bool_for_a_number", "[design]\nslope = true", {"slope", "number"}},
        BadSpec{"axis_for_the_scene", "[scene]\nrunway = { values = [1, 2] }", {"scene.runway", "no axis"}},
        BadSpec{"unknown_method", "[numerics]\nmethod = \"euler\"", {"method", "euler", "gsl-rk8pd"}},
        BadSpec{"tolerance_0", "[numerics]\ntolerance = 0", {"tolerance", "allowed"}},
        BadSpec{"unknown_friction", "[scene]\nfriction = \"viscous\"", {"friction", "viscous", "coulomb"}},
        BadSpec{"mu_without_friction",
                "[scene]\nmu_static = 0.4",
                {"spec.toml:2", "scene.mu_static = 0.4", "never slips", "--friction coulomb"}},
        BadSpec{"restitution_without_friction",
                "[scene]\nrestitution = 0.1",
                {"scene.restitution = 0.1", "--friction coulomb"}},
        BadSpec{"mu_axis_without_friction",
                "[scene]\nmu_kinetic = { values = [0.1, 0.2] }",
                {"scene.mu_kinetic", "--friction coulomb"}},
        BadSpec{"mu_column_without_friction",
                "[design]\npoints = \"mu.csv\"",
                {"mu.csv", "column 'mu_static'", "--friction coulomb"}},
        BadSpec{"unknown_field", "[output]\nfields = [\"jump_hight\"]", {"jump_hight", "jump_height"}},
        BadSpec{"field_twice", "[output]\nfields = [\"dip\", \"dip\"]", {"dip", "twice"}},
        BadSpec{"hop_height_negative", "[scene]\nhop_height = -0.1", {"hop_height", "-0.1"}},
        BadSpec{"unreadable_csv", "[design]\npoints = \"nowhere.csv\"", {"nowhere.csv", "cannot be read"}},
        BadSpec{"empty_csv", "[design]\npoints = \"empty.csv\"", {"empty.csv", "is empty"}},
        BadSpec{"csv_without_designs",
                "[design]\npoints = \"header_only.csv\"",
                {"header_only.csv", "no designs"}},
        BadSpec{"csv_unknown_column",
                "[design]\npoints = \"unknown_column.csv\"",
                {"unknown_column.csv:1", "sloppe", "allowed"}},
        BadSpec{"csv_column_twice", "[design]\npoints = \"twice.csv\"", {"twice.csv:1", "slope", "twice"}},
        BadSpec{"csv_a_column_too_many",
                "[design]\npoints = \"too_many.csv\"",
                {"too_many.csv:3", "3 values", "2"}},
        BadSpec{"csv_a_column_too_few", "[design]\npoints = \"too_few.csv\"", {"too_few.csv:2", "1 values"}},
        BadSpec{"csv_words", "[design]\npoints = \"words.csv\"", {"words.csv:3", "slope", "steep"}},
        BadSpec{"csv_nan", "[design]\npoints = \"nan.csv\"", {"nan.csv:2", "nan"}},
        BadSpec{"csv_negative_mass_ratio",
                "[design]\npoints = \"negative.csv\"",
                {"negative.csv:2", "mass_ratio", "-1"}},
        BadSpec{"csv_and_an_axis",
                "[design]\npoints = \"good.csv\"\nmass_ratio = { values = [1, 2] }",
                {"points", "mass_ratio"}}),
    [](const auto& tested) { return tested.param.name; });

TEST(BadOverrides, AreRefusedLikeBadKeys) {
  for (const auto& [text, word] :
       {std::pair{"slope", "KEY=VALUE"}, std::pair{"slop=1", "unknown key"},
        std::pair{"scene.slope=1", "unknown key"}, std::pair{"slope=91deg", "90 deg"},
        std::pair{"slope={from=1", "not TOML"}, std::pair{"slope={from=5 deg}", "needs quotes"},
        std::pair{"slope=", "number"}}) {
    const std::string line = refusal("", {text});
    EXPECT_NE(line.find(word), std::string::npos) << text << ": " << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(BadSpecFile, NoHintOfAUnitIsGivenWhereAWordLacksItsQuotes) {
  EXPECT_EQ(refusal("[numerics]\nmethod = exact").find("needs quotes"), std::string::npos);
}

TEST(BadSpecFile, AMissingSpecIsRefused) {
  EXPECT_THROW(read_spec("/nowhere/spec.toml", {}), InputError);
  EXPECT_THROW(read_spec("/tmp", {}), InputError);
}

}  // namespace
}  // namespace leapmap
