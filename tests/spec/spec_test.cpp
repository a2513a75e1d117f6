// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spec.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "leapmap/errors.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Spec parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const testing::TemporaryFolder folder;
  return read_spec(folder.write("spec.toml", text), overrides);
}

TEST(Spec, AnEmptySpecIsThePapersHoop) {
  const Spec spec = read_spec("", {});
  EXPECT_EQ(spec.design.slope, 0.40);
  EXPECT_EQ(spec.design.mass_ratio, 20.0 / 8.2);
  EXPECT_EQ(spec.scene.radius, 0.041);
  EXPECT_TRUE(spec.axes.empty());
  EXPECT_EQ(Tiling(shape_of(spec)).designs(), 1u);
}

TEST(Spec, TheInterfacesExampleIsUnderstoodWordForWord) {
  const Spec spec = parse(R"(
    [scene]
    friction       = "sticking"
    mu_static      = 0.5
    mu_kinetic     = 0.5
    restitution    = 0.0
    rest_speed     = 1e-3
    runway         = 5.0
    hop_height     = 0.05
    radius         = 0.041
    gravity        = 9.81
    [design]
    slope          = { from = "2 deg", to = "50 deg", count = 241 }
    mass_ratio     = { from = 0.1, to = 20, count = 256, scale = "log" }
    offset_ratio   = { values = [0.6, 0.8, 1.0] }
    inertia_factor = 1.0
    release_angle  = "180 deg"
    release_spin   = 0.0
    [numerics]
    method    = "auto"
    tolerance = 1e-10
    audit     = 0.001
    [output]
    file  = "maps/slope_mass_ratio.h5"
    fields = ["jump_height", "jump_time", "spurious_first_jump"]
  )");
  ASSERT_EQ(spec.axes.size(), 3u);
  EXPECT_EQ(spec.axes[0].key, "slope");
  EXPECT_EQ(spec.axes[1].key, "mass_ratio");
  EXPECT_EQ(spec.axes[2].key, "offset_ratio");
  EXPECT_EQ(shape_of(spec), (std::vector<std::size_t>{241, 256, 3}));
  EXPECT_EQ(spec.output.fields.size(), 3u);
  EXPECT_DOUBLE_EQ(spec.design.release_angle, std::numbers::pi);
}

TEST(Spec, AxesKeepTheOrderTheyAreWrittenInAndOverridesKeepTheirTurn) {
  const std::string text =
      "[design]\nslope = { values = [0.1, 0.2] }\noffset_ratio = { values = [1] }\nmass_ratio = { values = "
      "[1, 2, 3] }\n";
  const auto keys = [](const Spec& spec) {
    std::string joined;
    for (const Axis& axis : spec.axes) joined += axis.key + " ";
    return joined;
  };
  EXPECT_EQ(keys(parse(text)), "slope offset_ratio mass_ratio ");
  EXPECT_EQ(keys(parse(text, {"slope={values=[0.3]}"})), "slope offset_ratio mass_ratio ");
  EXPECT_EQ(keys(parse(text, {"offset_ratio=0.5"})), "slope mass_ratio ");
  EXPECT_EQ(keys(parse(text, {"design.release_spin={from=0,to=1,count=2}"})),
            "slope offset_ratio mass_ratio release_spin ");
}

TEST(Spec, LinearAndLogAxesHitTheirBoundsExactly) {
  const Spec spec = parse(
      "[design]\nslope = { from = \"2 deg\", to = \"50 deg\", count = 7 }\n"
      "mass_ratio = { from = 0.1, to = 20, count = 5, scale = \"log\" }\n"
      "inertia_factor = { from = 0.5, to = 0.5, count = 1 }\n");
  const auto &slope = spec.axes[0].values, &ratio = spec.axes[1].values;
  EXPECT_EQ(slope.front(), 2 * degree);
  EXPECT_EQ(slope.back(), 50 * degree);
  EXPECT_NEAR(slope[3], 26 * degree, 1e-16);
  EXPECT_EQ(ratio.front(), 0.1);
  EXPECT_EQ(ratio.back(), 20.0);
  for (std::size_t i = 1; i < ratio.size(); ++i)
    EXPECT_NEAR(ratio[i] / ratio[i - 1], std::pow(200.0, 0.25), 1e-14);
  EXPECT_EQ(spec.axes[2].values, std::vector<double>{0.5});
}

TEST(Spec, OverridesTakeNumbersWordsAnglesAndTablesWithOrWithoutTheirSection) {
  const Spec spec =
      parse("", {"numerics.method=gsl-rkf45", "tolerance=1e-12", "slope=30deg", "release_angle=\"90 deg\"",
                 "mass_ratio={from=1,to=2,count=2}", "output.fields=[\"status\"]", "max_steps=7e3"});
  EXPECT_EQ(spec.numerics.method, "gsl-rkf45");
  EXPECT_EQ(spec.numerics.tolerance, 1e-12);
  EXPECT_DOUBLE_EQ(spec.design.slope, 30 * degree);
  EXPECT_DOUBLE_EQ(spec.design.release_angle, 90 * degree);
  EXPECT_EQ(spec.axes.size(), 1u);
  EXPECT_EQ(spec.output.fields, std::vector<std::string>{"status"});
  EXPECT_EQ(spec.numerics.max_steps, 7000);
}

TEST(Spec, ResolvedTextReadsBackAsTheSameSpec) {
  const testing::TemporaryFolder folder;
  const Spec spec = parse(
      "[design]\nmass_ratio = { from = 0.1, to = 20, count = 11, scale = \"log\" }\n"
      "slope = { from = \"2 deg\", to = \"50 deg\", count = 13 }\nrelease_angle = \"170 deg\"\n"
      "[output]\nfile = 'a \"quoted\" name.h5'\nfields = [\"status\", \"dip\"]\n[scene]\nradius = 1\n");
  const Spec again = read_spec(folder.write("resolved.toml", resolved_text(spec)), {});
  ASSERT_EQ(again.axes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.axes[i].key, spec.axes[i].key);
    EXPECT_EQ(again.axes[i].values, spec.axes[i].values);  // to the last bit
  }
  EXPECT_EQ(again.design.release_angle, spec.design.release_angle);
  EXPECT_EQ(again.scene.radius, 1.0);
  EXPECT_EQ(again.output.file, spec.output.file);
  EXPECT_EQ(again.output.fields, spec.output.fields);
  EXPECT_EQ(resolved_text(again), resolved_text(spec));
}

TEST(Spec, ResolvedTextKeepsAnAxisOverAnyParameterAndOverAllOfThem) {
  std::set<std::string_view> seen;
  for (const Mechanism model : {Mechanism::hoop, Mechanism::pendulum}) {
    const std::vector<std::string> scene{fmt::format("model={}", name_of(model)), "friction=coulomb"};
    std::vector<std::string> all = scene;
    for (const Option* parameter : design_parameters()) {
      if (!has({.model = model, .friction = Friction::coulomb}, parameter->only_of)) continue;
      seen.insert(parameter->key);
      const std::string axis = fmt::format("{}={{values=[0.25,0.5]}}", parameter->key);
      all.push_back(axis);
      std::vector<std::string> one = scene;
      one.push_back(axis);
      for (const std::vector<std::string>& settings : {one, all}) {
        const Spec spec = read_spec("", settings), again = parse_spec(resolved_text(spec), "text", {});
        ASSERT_EQ(again.axes.size(), settings.size() - scene.size());
        for (std::size_t i = 0; i < again.axes.size(); ++i) EXPECT_EQ(again.axes[i].key, spec.axes[i].key);
        EXPECT_EQ(resolved_text(again), resolved_text(spec));
      }
    }
  }
  EXPECT_EQ(seen.size(), design_parameters().size());
}

TEST(Spec, MuKineticIsMuStaticUnlessGiven) {
  EXPECT_EQ(parse("[scene]\nfriction = \"coulomb\"\nmu_static = 0.3\n").design.mu_kinetic, 0.3);
  EXPECT_EQ(parse("[scene]\nfriction = \"coulomb\"\nmu_static = 0.3\nmu_kinetic = 0.2\n").design.mu_kinetic,
            0.2);
}

TEST(Spec, WhatOnlySlippingContactsHaveMayBeSpeltOutAtItsDefaultAndIsReadFromOlderMaps) {
  EXPECT_NO_THROW(parse("[scene]\nmu_static = 0.5\nmu_kinetic = 0.5\nrestitution = 0\nrest_speed = 1e-3\n"));
  EXPECT_THROW(parse_spec("", "", {"mu_static=0.5"}), InputError) << "given by hand";
  EXPECT_NO_THROW(parse_map_spec("[scene]\nmu_static = 0.3\n", "map.h5"));
  EXPECT_EQ(parse_spec("", "", {"mu_static=0.3", "friction=coulomb"}).design.mu_static, 0.3);
}

TEST(Spec, AListOfDesignsIsReadFromBesideTheSpec) {
  const testing::TemporaryFolder folder;
  folder.write("designs.csv", "\xEF\xBB\xBFslope, mass_ratio\r\n0.1,2\r\n\r\n0.2 , 3e0\r\n");
  const Spec spec =
      read_spec(folder.write("spec.toml", "[design]\npoints = \"designs.csv\"\noffset_ratio = 0.7\n"), {});
  EXPECT_EQ(spec.list.count, 2u);
  const DesignSpace space(spec);
  EXPECT_EQ(space.at(1).slope, 0.2);
  EXPECT_EQ(space.at(1).mass_ratio, 3.0);
  EXPECT_EQ(space.at(0).offset_ratio, 0.7);
}

TEST(Spec, AListIsReadAsSpreadsheetsAndNumpyWriteIt) {
  const testing::TemporaryFolder folder;
  folder.write("designs.csv", "# slope,\"mass_ratio\"\r\n\"20 deg\", 2\r\n0.2,\"3\"\r\n");
  const Spec spec = read_spec(folder.write("spec.toml", "[design]\npoints = \"designs.csv\"\n"), {});
  const DesignSpace space(spec);
  EXPECT_EQ(space.at(0).slope, 20.0 * degree);
  EXPECT_EQ(space.at(1).mass_ratio, 3.0);
}

TEST(Spec, AValueBesideAColumnOfItsNameIsRefused) {
  const testing::TemporaryFolder folder;
  folder.write("designs.csv", "slope\n0.1\n");
  const std::string path = folder.write("spec.toml", "[design]\npoints = \"designs.csv\"\nslope = 0.3\n");
  try {
    read_spec(path, {});
    FAIL() << "the column would win without a word";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("slope = 0.3 has no effect beside the column"),
              std::string::npos)
        << error.what();
  }
}

TEST(Spec, DesignsAreNumberedWithTheLastAxisFastest) {
  const Spec spec = parse("[design]\nslope = { values = [0.1, 0.2] }\nmass_ratio = { values = [1, 2, 3] }\n");
  const DesignSpace space(spec);
  EXPECT_EQ(space.at(0).mass_ratio, 1.0);
  EXPECT_EQ(space.at(2).mass_ratio, 3.0);
  EXPECT_EQ(space.at(2).slope, 0.1);
  EXPECT_EQ(space.at(3).slope, 0.2);
  std::vector<Design> designs(2);
  space.fill(Tile{{1, 1}, {1, 2}, 2}, 0, designs);
  EXPECT_EQ(designs[0].slope, 0.2);
  EXPECT_EQ(designs[0].mass_ratio, 2.0);
  EXPECT_EQ(designs[1].mass_ratio, 3.0);
}

TEST(Spec, AnAxisByStepsHasBothBounds) {
  const Spec spec = parse(
      "[design]\nslope = { from = \"10 deg\", to = \"40 deg\", step = \"0.1 deg\" }\n"
      "mass_ratio = { from = 3, to = 1, step = 0.5 }\n"
      "release_spin = { from = 1, to = -1, step = -1 }\n");
  ASSERT_EQ(spec.axes[0].values.size(), 301u);
  EXPECT_EQ(spec.axes[0].values.back(), 40.0 * degree);
  EXPECT_NEAR(spec.axes[0].values[1], 10.1 * degree, 1e-15);
  EXPECT_EQ(spec.axes[1].values, (std::vector{3.0, 2.5, 2.0, 1.5, 1.0}));
  EXPECT_EQ(spec.axes[2].values, (std::vector{1.0, 0.0, -1.0}));
}

TEST(Spec, AnAxisIsShownByItsBoundsWhereTheyGiveTheSameBits) {
  const Spec spec = parse(
      "[design]\nslope = { from = \"2 deg\", to = \"50 deg\", count = 241 }\n"
      "mass_ratio = { from = 0.1, to = 20, count = 256, scale = \"log\" }\n"
      "offset_ratio = { values = [0.6, 0.7, 0.9, 1.0] }\n");
  EXPECT_EQ(resolved_text(spec).find("from"), std::string::npos) << "a map keeps the values themselves";
  const std::string text = readable_text(spec);
  EXPECT_NE(text.find("mass_ratio = { from = 0.1, to = 20.0, count = 256, scale = \"log\" }"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("offset_ratio = { values = [0.6, 0.7, 0.9, 1.0] }"), std::string::npos) << text;
  EXPECT_NE(readable_text(parse("[design]\nrelease_spin = { values = [-1.0, -0.5, -0.0, 0.5, 1.0] }\n"))
                .find("-0.0"),
            std::string::npos);
  const Spec again = parse(text);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(again.axes[i].values, spec.axes[i].values);
}

TEST(Options, EveryKeyIsDeclaredOnceAndInTheHelp) {
  const std::string help = options_help();
  for (const Option& option : spec_options()) {
    EXPECT_EQ(find_option(option.section, option.key), &option) << option.key << ": once in a section";
    if (option.section != "scatter" || option.key == "samples" || option.key == "seed") {
      // [numerics] has a tolerance, too, which is the one without a section.
      if (option.section != "goal" && &option != find_option("gait", "tolerance")) {
        EXPECT_EQ(find_option("", option.key), &option) << option.key << ": without a section it is this one";
      }
    }
    EXPECT_NE(help.find(std::string(option.key)), std::string::npos) << option.key;
    EXPECT_FALSE(option.meaning.empty()) << option.key;
  }
}

TEST(Tiles, OfGaitsWithFrictionAreLargerAndStillMany) {
  const auto tiles = [](std::size_t along, const std::vector<std::string>& more) {
    std::vector<std::string> overrides{fmt::format("slope={{from=0.1,to=0.5,count={}}}", along),
                                       fmt::format("mass_ratio={{from=1,to=9,count={}}}", along),
                                       "scene.friction=coulomb"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return tiling_of(read_spec("", overrides));
  };
  for (const std::size_t along : {10u, 20u, 40u, 100u, 400u}) {
    const Tiling plain = tiles(along, {}), of_gaits = tiles(along, {"gait.settle=100"});
    EXPECT_GE(of_gaits.largest_tile(), plain.largest_tile()) << along;
    EXPECT_GE(of_gaits.size(), along < 20 ? 1u : 6u) << along;
  }
  EXPECT_GE(tiles(100, {"gait.settle=100"}).largest_tile(), 256u);
  EXPECT_LE(tiles(100, {}).largest_tile(), 128u);
}

}  // namespace
}  // namespace leapmap
