// SPDX-License-Identifier: GPL-3.0-or-later
/// A map that is stopped anywhere, gone on with, holds the values of one that was not.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "leapmap/errors.hpp"
#include "map/writer.hpp"
#include "support/small_map.hpp"
#include "support/system_calls.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;
using testing::numbered;

const MapLayout layout = testing::small_layout();
const Tiling tiling({3, 5}, {1, 2});  // nine tiles

MapWriter begin(const std::string& path) {
  return MapWriter::begin(path, layout, tiling, testing::small_attributes, false);
}

/// Writes all tiles and commits after each.
void sweep(const std::string& path) {
  MapWriter writer = begin(path);
  testing::write_rest(writer, layout, tiling, [&] { writer.commit(); });
  EXPECT_TRUE(writer.finish({}));
}

/// Expects the first `tiles` tiles as they were written, and holes after them.
void expect_values(const MapReader& map, std::size_t tiles) {
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const Tile tile = tiling.tile(t);
    const auto heights = map.read("jump_height", tile), statuses = map.read("status", tile);
    for (std::size_t i = 0; i < tile.count; ++i) {
      const Outcome outcome = numbered(tiling.number(tile, i));
      ASSERT_EQ(statuses[i], t < tiles ? static_cast<double>(outcome.status) : 0.0)
          << "tile " << t << " of " << tiles;
      ASSERT_TRUE(t < tiles ? heights[i] == outcome.jump_height : std::isnan(heights[i]));
    }
  }
}

/// Goes on with what is left of a map, to its end. Returns how many tiles were there.
std::size_t resume(const std::string& path) {
  MapWriter writer = MapWriter::resume(path, layout, tiling, false);
  writer.verify();
  const std::size_t tiles = writer.progress().tiles;
  expect_values(writer.reader(), tiles);
  testing::write_rest(writer, layout, tiling);
  EXPECT_TRUE(writer.finish({}));
  const MapReader map(path);
  expect_values(map, tiling.size());
  EXPECT_TRUE(map.is_whole());
  EXPECT_EQ(hdf5::read_integers(map.file(), "status_counts"),
            (std::vector<std::int64_t>{0, 7, 8, 0, 0, 0, 0}));
  return tiles;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Resume, AMapKilledAtAnyMomentIsGoneOnWithFromItsLastCommit) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "map.h5";
  std::size_t most = 0, blank = 0;
  const long stride = std::getenv("LEAPMAP_EVERY_CALL") ? 1 : 11;
  for (long call = 0; testing::dies_at_call(call, [&] { sweep(path); }); call += stride) {
    if (fs::exists(path)) {  // killed after it was whole
      fs::remove(path);
      continue;
    }
    if (!fs::exists(path + ".part") || hdf5::File::blank(path + ".part")) {
      EXPECT_EQ(most, 0u) << "a commit never goes back";
      ++blank;
      continue;
    }
    {
      const MapReader part(path + ".part");
      const auto tiles = part.is_whole() ? tiling.size() : std::stoul(part.attribute("tiles_done"));
      expect_values(part, tiles);
    }
    const std::size_t tiles = resume(path);
    EXPECT_TRUE(tiles == most || tiles == most + 1) << "call " << call << ": " << tiles << " after " << most;
    most = tiles;
    fs::remove(path);
  }
  EXPECT_EQ(most, tiling.size());
  EXPECT_GT(blank, 0u);
}

TEST(Resume, APartCutAtAnyByteIsGoneOnWithOrRefused) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "map.h5", part = path + ".part";
  {
    MapWriter writer = begin(path);
    for (std::size_t t = 0; t < 5; ++t) writer.write(testing::numbered_tile(layout, tiling, t));
    writer.keep({});
  }
  const std::string whole = text_of(part);
  std::size_t refused = 0, cuts = 0;
  for (std::size_t cut = 0; cut < whole.size(); cut += cut < 200 || cut + 200 > whole.size() ? 1 : 97) {
    std::ofstream(part, std::ios::binary) << whole.substr(0, cut);
    ++cuts;
    if (hdf5::File::blank(part)) continue;
    try {
      MapReader map(part);
      expect_values(map, 5);
    } catch (const IoError&) {
    }
    try {
      resume(path);
      fs::remove(path);
    } catch (const IoError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("map.h5.part"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, cuts - 20) << "what was committed is missing: nothing but a blank beginning is accepted";
  std::ofstream(part, std::ios::binary)
      << whole + std::string(1000, 'x');  // what a commit that never came left
  EXPECT_EQ(resume(path), 5u);
}

TEST(Resume, ATileThatIsNotWhatWasWrittenIsRefused) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "map.h5", part = path + ".part";
  haddr_t where = 0;
  {
    MapWriter writer = begin(path);
    writer.write(testing::numbered_tile(layout, tiling, 0));
    writer.keep({});
    const hdf5::File file = hdf5::File::open(part);
    const hdf5::Handle dataset(H5Dopen2(file, "jump_height", H5P_DEFAULT), H5Dclose, "");
    hsize_t size = 0, place[2] = {};
    unsigned mask = 0;
    const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "");
    ASSERT_GE(H5Dget_chunk_info(dataset, space, 0, place, &mask, &where, &size), 0);
  }
  std::string bytes = text_of(part);
  bytes[where + 3] = static_cast<char>(bytes[where + 3] ^ 1);
  std::ofstream(part, std::ios::binary) << bytes;
  MapWriter writer = MapWriter::resume(path, layout, tiling, false);
  EXPECT_THROW(writer.verify(), IoError);
}

TEST(Resume, WhatTheDiskTookNoMoreIsLeftAsOfTheLastCommit) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "map.h5";
  {
    MapWriter writer = begin(path);
    for (std::size_t t = 0; t < 3; ++t) writer.write(testing::numbered_tile(layout, tiling, t));
    writer.commit();
    testing::before_system_call = [](const testing::SystemCall& call) {
      if (call.kind == testing::SystemCall::Kind::write) throw IoError("no space left");
    };
    EXPECT_THROW(
        {
          testing::write_rest(writer, layout, tiling);
          writer.commit();
        },
        IoError);
    testing::before_system_call = nullptr;
  }
  EXPECT_EQ(resume(path), 3u);
}

TEST(Resume, AttributesWrittenAgainAndAgainDoNotRunOut) {
  const testing::TemporaryFolder folder;
  hdf5::File file = hdf5::File::create(folder / "file.h5", map_filetype);
  for (std::int64_t i = 0; i < 70'000; ++i) hdf5::write_attribute(file, "count", i);  // HDF5 numbers 65,535
  EXPECT_EQ(hdf5::read_integers(file, "count")[0], 69'999);
}

}  // namespace
}  // namespace leapmap
