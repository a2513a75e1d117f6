// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/retry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>

#include "engine/map_layout.hpp"
#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "spec/designs.hpp"
#include "support/sweep_into.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

const std::vector<std::string> grid{"slope={from=0.1,to=0.8,count=20}",
                                    "mass_ratio={from=0.5,to=10,count=30}"};

/// A grid solved by a method into a map.
Spec sweep(const std::string& path, std::vector<std::string> settings) {
  settings.insert(settings.begin(), grid.begin(), grid.end());
  const Spec spec = read_spec("", settings);
  const MapLayout layout = layout_of(spec);
  const Tiling tiling(shape_of(spec));
  const std::vector<hdf5::Attribute> attributes{
      {"filetype", std::string(map_filetype)},
      {"version", std::vector<std::int32_t>{format_major, format_minor}},
      {"spec", resolved_text(spec)}};
  MapWriter writer = MapWriter::begin(path, layout, tiling, attributes, false);
  testing::sweep_into(writer, spec, layout, tiling);
  EXPECT_TRUE(writer.finish({}));
  return spec;
}

TEST(Retry, SettlesTheFailedByAnotherMethodAndLeavesTheRest) {
  const testing::TemporaryFolder folder;
  Spec spec = sweep(folder / "map.h5", {"method=gsl-rk8pd", "max_steps=40"});
  sweep(folder / "exact.h5", {"tolerance=1e-12"});
  const Tile all{{0, 0}, {20, 30}, 600};
  const auto before_status = MapReader(folder / "map.h5").read("status", all);
  const auto before = MapReader(folder / "map.h5").read("jump_time", all);
  const auto failed = std::ranges::count(before_status, static_cast<double>(Status::failed));
  ASSERT_GT(failed, 0);

  spec.numerics = retry_numerics(spec.numerics, spec.numerics, spec.scene);
  EXPECT_EQ(spec.numerics.method, "exact");
  const RetryReport report = retry_with(folder / "map.h5", spec, 2).value();
  EXPECT_EQ(report.retried, static_cast<std::size_t>(failed));
  EXPECT_EQ(report.still_failed, 0u);
  EXPECT_EQ(std::accumulate(report.statuses.begin(), report.statuses.end(), std::int64_t{0}), 600);

  const MapReader map(folder / "map.h5"), exact(folder / "exact.h5");
  for (const Field& field : map_fields()) {
    if (!map.has(std::string(field.name))) continue;
    if (!has(spec.scene, field) || field.of_sequence || field.of_gait) continue;  // not of this map
    const auto ours = map.read(std::string(field.name), all),
               theirs = exact.read(std::string(field.name), all);
    for (std::size_t i = 0; i < 600; ++i) {
      if (std::isnan(ours[i]) && std::isnan(theirs[i])) continue;
      // solved in other lanes, times agree within their tolerance; what was not failed was integrated at
      // 1e-10
      EXPECT_NEAR(ours[i], theirs[i], 1e-8 * (1.0 + std::abs(theirs[i]))) << field.name << " " << i;
    }
  }
  const auto after = map.read("jump_time", all);
  for (std::size_t i = 0; i < 600; ++i)
    if (before_status[i] == static_cast<double>(Status::jumped)) {
      EXPECT_EQ(after[i], before[i]);
    }
  EXPECT_EQ(hdf5::read_integers(map.file(), "retry_designs")[0], failed);
  EXPECT_FALSE(std::filesystem::exists(folder / "map.h5.part"));
}

TEST(Retry, OfAMapWithoutStatusOrUnfinishedIsRefusedAndLeavesNothingBehind) {
  const testing::TemporaryFolder folder;
  const Spec bare = sweep(folder / "bare.h5", {"fields=[\"jump_height\"]"});
  EXPECT_THROW(retry_with(folder / "bare.h5", bare, 1), InputError);
  const Spec whole = sweep(folder / "whole.h5", {});
  const auto written = std::filesystem::last_write_time(folder / "whole.h5");
  EXPECT_EQ(retry_with(folder / "whole.h5", whole, 1)->retried, 0u);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "whole.h5"), written)
      << "nothing failed: nothing is touched";
  EXPECT_THROW(retry_with(folder / "nowhere.h5", whole, 1), IoError);
  for (const auto& entry : std::filesystem::directory_iterator(folder / "."))
    EXPECT_EQ(entry.path().extension(), ".h5") << entry.path();
}

TEST(Retry, StoppedItLeavesTheMapAsItWas) {
  const testing::TemporaryFolder folder;
  Spec spec = sweep(folder / "map.h5", {"method=gsl-rk8pd", "max_steps=40"});
  const Tile all{{0, 0}, {20, 30}, 600};
  const auto before = MapReader(folder / "map.h5").read("status", all);
  spec.numerics = retry_numerics(spec.numerics, spec.numerics, spec.scene);
  EXPECT_FALSE(retry_with(folder / "map.h5", spec, 1, Locking::required, [] { return true; }));
  EXPECT_EQ(MapReader(folder / "map.h5").read("status", all), before);
}

TEST(Retry, TakesTheUsersOwnWayIfItIsAnother) {
  const Spec there = read_spec("", {}), other = read_spec("", {"tolerance=1e-13"});
  EXPECT_EQ(retry_numerics(there.numerics, other.numerics, there.scene).tolerance, 1e-13);
  EXPECT_EQ(retry_numerics(there.numerics, there.numerics, there.scene).method, "gsl-rk8pd");
}

}  // namespace
}  // namespace leapmap
