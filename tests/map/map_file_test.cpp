// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "leapmap/errors.hpp"
#include "map/hdf5_driver.hpp"
#include "map/reader.hpp"
#include "map/writer.hpp"
#include "support/small_map.hpp"
#include "support/system_calls.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;

using testing::small_attributes, testing::small_layout, testing::numbered;

TEST(MapFile, WhatIsWrittenTileByTileIsReadBackInPlace) {
  const testing::TemporaryFolder folder;
  const Tiling tiling({3, 5}, {2, 2});  // tiles cut short on both sides
  {
    const MapLayout layout = small_layout();
    MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, small_attributes, false);
    testing::write_rest(writer, layout, tiling);
    EXPECT_FALSE(fs::exists(folder / "map.h5")) << "until it is whole it has no name";
    writer.set_seconds(1.5);
    EXPECT_TRUE(writer.finish(std::vector<hdf5::Attribute>{{"audit_designs", std::int64_t{7}}}));
  }
  EXPECT_FALSE(fs::exists(folder / "map.h5.part"));
  const MapReader map(folder / "map.h5");
  EXPECT_EQ(map.shape(), (std::vector<std::size_t>{3, 5}));
  EXPECT_EQ(map.dimensions()[0].name, "slope");
  EXPECT_EQ(map.dimensions()[1].values, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(map.attribute("title"), "täst");
  EXPECT_EQ(map.attribute("wall_time"), "1.5");
  EXPECT_EQ(map.attribute("audit_designs"), "7");
  EXPECT_EQ(map.unit("jump_time"), "s");
  EXPECT_EQ(map.fields().size(), map_fields().size());
  const Tile whole{{0, 0}, {3, 5}, 15};
  const auto heights = map.read("jump_height", whole), times = map.read("jump_time", whole),
             statuses = map.read("status", whole), dips = map.read("dip", whole);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(heights[i], static_cast<double>(i) + 0.25);
    EXPECT_EQ(times[i], static_cast<double>(i));
    EXPECT_EQ(statuses[i], i % 2 ? 1.0 : 2.0);
    EXPECT_TRUE(std::isnan(dips[i]));
  }
  EXPECT_EQ(map.read("candidates", Tile{{1, 2}, {1, 2}, 2}), (std::vector<double>{7, 8}));
}

TEST(MapFile, AListHasOneDimensionAndItsParametersAlongIt) {
  const testing::TemporaryFolder folder;
  MapLayout layout = small_layout();
  layout.axes.clear();
  layout.columns = {{"slope", "rad", "slope of the plane", {0.3, 0.1}}};
  const Tiling tiling({2}, {2});
  MapWriter writer = MapWriter::begin(folder / "list.h5", layout, tiling, small_attributes, false);
  testing::write_rest(writer, layout, tiling);
  EXPECT_TRUE(writer.finish({}));
  const MapReader map(folder / "list.h5");
  ASSERT_EQ(map.dimensions().size(), 1u);
  EXPECT_EQ(map.dimensions()[0].name, "design");
  EXPECT_EQ(map.fields()[0], "slope");
  EXPECT_EQ(map.read("slope", Tile{{0}, {2}, 2}), (std::vector<double>{0.3, 0.1}));
}

TEST(MapFile, AnUnfinishedMapLeavesNothingBehind) {
  const testing::TemporaryFolder folder;
  {
    const MapLayout layout = small_layout();
    const Tiling tiling({3, 5}, {3, 5});
    const MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, small_attributes, false);
  }
  EXPECT_FALSE(fs::exists(folder / "map.h5"));
  EXPECT_FALSE(fs::exists(folder / "map.h5.part"));
}

TEST(MapFile, AWholeMapThatCannotBeGivenItsNameIsKeptAsItsPart) {
  const testing::TemporaryFolder folder;
  const MapLayout layout = small_layout();
  const Tiling tiling({3, 5}, {1, 5});
  {
    MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, small_attributes, false);
    testing::write_rest(writer, layout, tiling);
    folder.write("map.h5", "somebody else's by now");
    EXPECT_THROW(static_cast<void>(writer.finish({})), IoError);
    EXPECT_EQ(writer.committed(), 15u);
  }
  EXPECT_EQ(fs::file_size(folder / "map.h5"), 22u);
  EXPECT_TRUE(MapReader(folder / "map.h5.part").is_whole());
}

/// Of two tiles, stored as they are: so long that it is verified while it goes to disk.
struct LongMap {
  static constexpr std::size_t each = 12'000;
  Tiling tiling{{2, each}, {1, each}};
  MapLayout layout = small_layout();

  LongMap() {
    layout.axes[0].values = {0.1, 0.2};
    layout.axes[1].values.resize(each);
    for (std::size_t i = 0; i < each; ++i) layout.axes[1].values[i] = static_cast<double>(i + 1);
    layout.compression = 0;
  }
  /// Commits after each tile but the last.
  MapWriter written(const std::string& path) const {
    MapWriter writer = MapWriter::begin(path, layout, tiling, small_attributes, true);
    writer.write(testing::numbered_tile(layout, tiling, 0));
    writer.commit();
    writer.write(testing::numbered_tile(layout, tiling, 1));
    return writer;
  }
};

TEST(MapFile, ALongMapIsSealedAsItIsOnDisk) {
  const testing::TemporaryFolder folder;
  const LongMap map;
  EXPECT_TRUE(map.written(folder / "map.h5").finish({}));
  EXPECT_GT(fs::file_size(folder / "map.h5"), std::uintmax_t{4} << 20);
  EXPECT_EQ(JournaledFile(folder / "map.h5", JournaledFile::Access::read).seal_holds(), true);
  EXPECT_EQ(MapReader(folder / "map.h5").read("jump_time", map.tiling.tile(1))[7], map.each + 7.0);
}

TEST(MapFile, ALongMapThatCannotBeSyncedIsLeftAsOfItsLastCommit) {
  const testing::TemporaryFolder folder;
  const LongMap map;
  {
    MapWriter writer = map.written(folder / "map.h5");
    testing::before_system_call = [](const testing::SystemCall& call) {
      if (call.kind == testing::SystemCall::Kind::sync) throw IoError("the disk is gone");
    };
    EXPECT_THROW(static_cast<void>(writer.finish({})), IoError);
    testing::before_system_call = nullptr;
    EXPECT_EQ(writer.committed(), map.each);
  }
  EXPECT_FALSE(fs::exists(folder / "map.h5"));
  EXPECT_EQ(MapReader(folder / "map.h5.part").attribute("tiles_done"), "1");
}

TEST(MapFile, ALongMapKilledAtAnyMomentIsWholeOrGoneOnWith) {
  const testing::TemporaryFolder folder;
  const LongMap map;
  const std::string path = folder / "map.h5";
  const long stride = std::getenv("LEAPMAP_EVERY_CALL") ? 1 : 17;
  const auto whole = [&] { static_cast<void>(map.written(path).finish({})); };
  std::size_t resumed = 0;
  for (long call = 0; testing::dies_at_call(call, whole); call += stride) {
    if (fs::exists(path)) {
      fs::remove(path);
    } else if (fs::exists(path + ".part") && !hdf5::File::blank(path + ".part")) {
      MapWriter writer = MapWriter::resume(path, map.layout, map.tiling, false);
      EXPECT_NO_THROW(writer.verify()) << "call " << call;
      ++resumed;
    }
    fs::remove(path + ".part");
  }
  EXPECT_GT(resumed, 0u);
}

TEST(MapFile, AFileWhoseVerificationFailsIsCommittedAllTheSame) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "file.h5", part = path + ".part";
  bool committed = false;
  {
    hdf5::File file = hdf5::File::create(part, "leapmap map");
    hdf5::annotate(file, small_attributes);
    const auto verify = [&](hid_t) {
      file.bytes().note_failure("a read fails");
      throw IoError("a tile cannot be read");
    };
    EXPECT_THROW(static_cast<void>(file.finish(path, false, verify, [&] { committed = true; })), IoError);
  }
  EXPECT_TRUE(committed);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_EQ(hdf5::read_text(hdf5::File::open(part), "title"), "täst");
}

TEST(MapFile, AKeptPartShowsItsHolesAsNotComputed) {
  const testing::TemporaryFolder folder;
  const Tiling tiling({3, 5}, {1, 5});
  const MapLayout layout = small_layout();
  MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, small_attributes, false);
  writer.write(testing::numbered_tile(layout, tiling, 0));
  EXPECT_THROW(MapReader(folder / "map.h5.part"), InputError) << "nobody reads what is being written";
  writer.keep({});
  const MapReader map(folder / "map.h5.part");
  EXPECT_FALSE(map.is_whole());
  const Tile whole{{0, 0}, {3, 5}, 15};
  EXPECT_EQ(map.read("status", whole)[4], 2.0);
  EXPECT_EQ(map.read("status", whole)[5], 0.0);
  EXPECT_EQ(map.read("spurious_first_jump", whole)[5], 255.0);
  EXPECT_TRUE(std::isnan(map.read("jump_height", whole)[14]));
}

TEST(MapFile, ExistingFilesAreRefusedAndLeftAlone) {
  const testing::TemporaryFolder folder;
  const std::string existing = folder.write("map.h5", "precious");
  const auto create = [&](const std::string& path, bool overwrite) {
    const MapLayout layout = small_layout();
    const Tiling tiling({3, 5}, {3, 5});
    const MapWriter writer = MapWriter::begin(path, layout, tiling, small_attributes, overwrite);
  };
  EXPECT_THROW(create(existing, false), InputError);
  EXPECT_EQ(fs::file_size(existing), 8u);
  EXPECT_THROW(create(existing, true), InputError) << "--overwrite is for maps";
  EXPECT_EQ(fs::file_size(existing), 8u);
  folder.write("other.h5.part", "left by an interrupted sweep");
  EXPECT_THROW(create(folder / "other.h5", false), InputError);
  EXPECT_EQ(fs::file_size(folder / "other.h5.part"), 28u);
}

TEST(MapFile, WhatCannotBeWrittenIsAnIoError) {
  const testing::TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  const auto create = [&](const std::string& path) {
    const MapLayout layout = small_layout();
    const Tiling tiling({3, 5}, {3, 5});
    const MapWriter writer = MapWriter::begin(path, layout, tiling, small_attributes, false);
  };
  EXPECT_THROW(create(file + "/map.h5"), IoError);
  EXPECT_THROW(create("/proc/map.h5"), IoError);
  create(folder / "new/folders/map.h5");  // made on the way
  EXPECT_TRUE(fs::is_directory(folder / "new/folders"));
}

TEST(MapFile, FilesOfAnotherTypeOrANewerVersionAreRefusedWithAReason) {
  const testing::TemporaryFolder folder;
  const auto complaint = [](const std::string& path) -> std::string {
    try {
      MapReader map(path);
    } catch (const IoError& error) {
      return error.what();
    }
    return "(accepted)";
  };
  EXPECT_NE(complaint(folder / "nowhere.h5").find("No such file"), std::string::npos);
  EXPECT_NE(complaint(folder.write("text.h5", "not HDF5")).find("cannot be read as HDF5"), std::string::npos);
  EXPECT_TRUE(
      hdf5::File::create(folder / "other.h5", "another").finish(folder / "other.h5", true, [](hid_t) {}));
  EXPECT_NE(complaint(folder / "other.h5").find("not a leapmap map"), std::string::npos);
  {
    auto newer = small_attributes;
    newer[1].second = std::vector<std::int32_t>{format_major + 1, 0};
    const MapLayout layout = small_layout();
    const Tiling tiling({3, 5}, {3, 5});
    MapWriter writer = MapWriter::begin(folder / "newer.h5", layout, tiling, newer, false);
    testing::write_rest(writer, layout, tiling);
    EXPECT_TRUE(writer.finish({}));
  }
  EXPECT_NE(complaint(folder / "newer.h5").find("newer leapmap"), std::string::npos);
}

}  // namespace
}  // namespace leapmap
