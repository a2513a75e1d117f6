// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/map_spec.hpp"

#include <gtest/gtest.h>

#include "engine/map_layout.hpp"
#include "map/schema.hpp"
#include "map/writer.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

/// An empty map of a spec, read again.
Spec through_a_map(const testing::TemporaryFolder& folder, const Spec& spec) {
  const std::vector<hdf5::Attribute> attributes{
      {"filetype", std::string(map_filetype)},
      {"version", std::vector<std::int32_t>{format_major, format_minor}},
      {"spec", resolved_text(spec)}};
  const MapLayout layout = layout_of(spec);
  const Tiling tiling(shape_of(spec));
  MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, attributes, true);
  return spec_of(writer.reader(), "map.h5");
}

TEST(MapSpec, OfAGridComesBackFromItsMap) {
  const testing::TemporaryFolder folder;
  const Spec spec =
      read_spec("", {"mass_ratio={from=0.1,to=20,count=7,scale=\"log\"}", "slope={values=[0.3,0.1]}",
                     "tolerance=1e-7", "fields=[\"status\"]", "runway=3"});
  const Spec back = through_a_map(folder, spec);
  EXPECT_EQ(first_difference(back, spec), std::nullopt);
  EXPECT_EQ(resolved_text(back), resolved_text(spec));
}

TEST(MapSpec, OfAListHoldsItsDesignsWithoutTheFile) {
  const testing::TemporaryFolder folder;
  folder.write("designs.csv", "slope,mass_ratio\n0.4,2.44\n0.5,1\n0.1,0.30000000000000004\n");
  Spec spec = read_spec("", {"points=" + (folder / "designs.csv"), "release_spin=0.25"});
  const Spec back = through_a_map(folder, spec);
  EXPECT_EQ(first_difference(back, spec), std::nullopt);
  for (std::size_t i = 0; i < 3; ++i)
    for (const Option* parameter : design_parameters(spec))
      EXPECT_EQ(value_of(*parameter, DesignSpace(back).at(i)), value_of(*parameter, DesignSpace(spec).at(i)));
  spec.list.columns[1].values[2] = 0.3;
  const auto difference = first_difference(back, spec);
  ASSERT_TRUE(difference);
  EXPECT_NE(difference->find("mass_ratio"), std::string::npos) << *difference;
}

TEST(MapSpec, ADifferenceIsToldByItsKeyAndValues) {
  const auto difference = [](const std::vector<std::string>& there, const std::vector<std::string>& here,
                             bool only_designs = false) {
    return first_difference(read_spec("", there), read_spec("", here), only_designs).value_or("none");
  };
  EXPECT_EQ(difference({"tolerance=1e-12"}, {}), "numerics.tolerance is 1e-12 there and 1e-10 here");
  EXPECT_EQ(difference({"tolerance=1e-12", "method=gsl-rk8pd"}, {}, true), "none");
  EXPECT_EQ(difference({"method=auto"}, {"method=exact"}), "none");
  EXPECT_EQ(difference({"file=a.h5"}, {"file=b.h5"}), "none") << "a map may be moved";
  EXPECT_NE(difference({"slope={values=[0.1,0.2]}"}, {"slope={values=[0.1,0.3]}"}).find("design.slope"),
            std::string::npos);
  EXPECT_NE(difference({"slope={values=[0.1,0.2]}"}, {}).find("axes"), std::string::npos);
  EXPECT_NE(difference({"slope={values=[0.1,0.2]}", "mass_ratio={values=[1,2]}"},
                       {"mass_ratio={values=[1,2]}", "slope={values=[0.1,0.2]}"})
                .find("axes are [slope, mass_ratio] there"),
            std::string::npos);
  EXPECT_NE(difference({"fields=[\"status\"]"}, {}).find("output.fields is status there and not set here"),
            std::string::npos);
  EXPECT_NE(difference({"compression=3"}, {}).find("output.compression is 3 there"), std::string::npos);
}

}  // namespace
}  // namespace leapmap
