// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/tile_encoder.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "support/small_map.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

/// Outcomes of every kind of bits: numbers that nothing compresses, NaN, infinities, zeros.
std::vector<Outcome> wild(std::size_t count, bool compressible) {
  std::mt19937_64 random(5);
  const auto number = [&] { return compressible ? 0.5 : std::bit_cast<double>(random()); };
  std::vector<Outcome> outcomes(count);
  for (Outcome& o : outcomes) {
    o.status = static_cast<Status>(random() % status_count);
    o.spurious_first_jump = static_cast<std::uint8_t>(random());
    o.candidates = static_cast<std::uint8_t>(random());
    for (const Field& field : map_fields())
      if (const auto* quantity = std::get_if<Quantity>(&field.source)) o.*quantity->member = number();
    o.phase_sequence = compressible ? 0 : random();
  }
  return outcomes;
}

/// The one map of all 7 x 9 x 5 outcomes, read back by HDF5's own filters, is what was put in.
void expect_round_trip(int compression, bool single, bool compressible) {
  SCOPED_TRACE(::testing::Message() << "compression " << compression << ", f4 " << single << ", compressible "
                                    << compressible);
  const testing::TemporaryFolder folder;
  const std::vector<std::size_t> shape{7, 9, 5};
  const Tiling tiling(shape, {4, 4, 3});  // tiles cut short along every dimension
  MapLayout layout = testing::small_layout();
  layout.axes = {{"slope", "rad", "", std::vector<double>(7)},
                 {"mass_ratio", "1", "", std::vector<double>(9)},
                 {"offset_ratio", "1", "", std::vector<double>(5)}};
  layout.compression = compression;
  layout.single = single;
  const std::vector<Outcome> outcomes = wild(tiling.designs(), compressible);
  MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, testing::small_attributes, false);
  TileEncoder encoder(layout, tiling);
  std::size_t bytes = 0;
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const Tile tile = tiling.tile(t);
    std::vector<Outcome> some;
    for (std::size_t i = 0; i < tile.count; ++i) some.push_back(outcomes[tiling.number(tile, i)]);
    const std::size_t piece = some.size() / 3;
    encoder.take(0, {some.data(), piece});
    encoder.take(piece, {some.data() + piece, some.size() - piece});
    const EncodedTile encoded = encoder.encode(t);
    bytes += encoded.bytes();
    writer.write(encoded);
  }
  EXPECT_TRUE(writer.finish({}));
  if (compressible && compression > 0) {
    EXPECT_LT(bytes, map_bytes(layout, tiling) / 2);
  }
  const MapReader map(folder / "map.h5");
  const hdf5::Handle words(H5Dopen2(map.file(), "phase_sequence", H5P_DEFAULT), H5Dclose, "phase_sequence");
  const std::vector<std::uint64_t> sequences = hdf5::read_words(words, {0, 0, 0}, shape, "phase_sequence");
  for (std::size_t i = 0; i < outcomes.size(); ++i) ASSERT_EQ(sequences[i], outcomes[i].phase_sequence);
  for (const Field& field : map_fields()) {
    if (std::holds_alternative<Word>(field.source)) continue;
    const std::vector<double> stored =
        map.read(std::string(field.name), Tile{{0, 0, 0}, shape, tiling.designs()});
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      double expected;
      if (const auto* code = std::get_if<Code>(&field.source)) {
        expected = code->value(outcomes[i]);
      } else {
        const auto& quantity = std::get<Quantity>(field.source);
        expected = outcomes[i].*quantity.member;
        if (single) expected = static_cast<float>(expected);
      }
      const bool same = std::isnan(expected) ? std::isnan(stored[i]) : stored[i] == expected;
      ASSERT_TRUE(same) << field.name << " " << i << ": " << stored[i] << " " << expected;
    }
  }
}

TEST(TileEncoder, WhatItEncodesHdf5DecodesToTheSameBits) {
  for (const int compression : {0, 1, 6, 9})
    for (const bool single : {false, true})
      for (const bool compressible : {false, true}) expect_round_trip(compression, single, compressible);
}

TEST(TileEncoder, CountsHowTheDesignsEnded) {
  const MapLayout layout = testing::small_layout();
  const Tiling tiling({3, 5}, {2, 3});
  const EncodedTile encoded = testing::numbered_tile(layout, tiling, 0);  // designs 0 to 2 and 5 to 7
  EXPECT_EQ(encoded.statuses[static_cast<std::size_t>(Status::jumped)], 3u);
  EXPECT_EQ(encoded.statuses[static_cast<std::size_t>(Status::no_jump)], 3u);
}

TEST(TileEncoder, StoresWhatDoesNotGetSmallerAsItIs) {
  MapLayout layout = testing::small_layout();
  layout.fields = {find_field("jump_height"), find_field("status")};
  const Tiling tiling({3, 5}, {3, 5});
  const EncodedTile encoded = testing::encoded(layout, tiling, 0, wild(15, false));
  EXPECT_EQ(encoded.chunks[0].skipped_filters, 2u) << "shuffled, not deflated";
  EXPECT_EQ(encoded.chunks[0].bytes.size(), 15u * 8u + 4u) << "and a checksum";
}

/// What HDF5 reads of one field's tile, written to a file.
void expect_read_back(const MapLayout& layout, const Tiling& tiling, const EncodedTile& encoded,
                      const std::vector<Outcome>& outcomes) {
  const testing::TemporaryFolder folder;
  MapWriter writer = MapWriter::begin(folder / "map.h5", layout, tiling, testing::small_attributes, false);
  writer.write(encoded);
  EXPECT_TRUE(writer.finish({}));
  const std::vector<double> stored =
      MapReader(folder / "map.h5").read("jump_height", Tile{{0, 0}, tiling.shape(), tiling.designs()});
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    ASSERT_TRUE(stored[i] == outcomes[i].jump_height ||
                (std::isnan(stored[i]) && std::isnan(outcomes[i].jump_height)));
}

TEST(TileEncoder, PassesNoiseOnAsStoredBlocksOfTheSameStream) {
  MapLayout layout = testing::small_layout();
  layout.fields = {find_field("jump_height"), find_field("status")};
  layout.axes = {{"slope", "rad", "", std::vector<double>(300)},
                 {"mass_ratio", "1", "", std::vector<double>(300)}};
  layout.compression = 1;
  const std::vector<std::size_t> shape{300, 300};  // planes of 90,000 bytes: more than one stored block
  const Tiling tiling(shape, shape);
  std::mt19937_64 random(6);
  std::vector<Outcome> outcomes(tiling.designs());
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    outcomes[i].status = Status::jumped;
    outcomes[i].jump_height =
        0.5 + 1e-7 * static_cast<double>(i) + std::ldexp(static_cast<double>(random() >> 11), -80);
  }
  const EncodedTile encoded = testing::encoded(layout, tiling, 0, outcomes);
  const std::vector<std::byte>& bytes = encoded.chunks[0].bytes;
  EXPECT_EQ(encoded.chunks[0].skipped_filters, 0u);
  EXPECT_EQ(std::to_integer<int>(bytes[2]), 0) << "a stored block, and not the last";
  EXPECT_GT(bytes.size(), 3 * outcomes.size()) << "the last three bytes of every number are noise";
  EXPECT_LT(bytes.size(), 6 * outcomes.size()) << "the first ones are not";

  expect_read_back(layout, tiling, encoded, outcomes);
}

/// A tile of 80 x 64 heights: random from 0.5 to 1 for the designs that `jumps` picks, NaN for the others.
struct SparseTile {
  MapLayout layout = testing::small_layout();
  Tiling tiling{{80, 64}, {80, 64}};
  std::vector<Outcome> outcomes;

  template <class Jumps>
  explicit SparseTile(const Jumps& jumps) : outcomes(tiling.designs()) {
    layout.fields = {find_field("jump_height")};
    layout.axes = {{"slope", "rad", "", std::vector<double>(80)},
                   {"mass_ratio", "1", "", std::vector<double>(64)}};
    std::mt19937_64 random(7);
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      if (jumps(i)) outcomes[i].jump_height = 0.5 + std::ldexp(static_cast<double>(random() >> 11), -54);
  }
};

TEST(TileEncoder, WritesRunsAndTheNoiseBetweenThemWithoutASearch) {
  for (const std::size_t rows : {0u, 3u, 40u}) {  // that jump, in the middle of the tile
    SCOPED_TRACE(rows);
    const SparseTile tile([&](std::size_t i) { return i / 64 >= 20 && i / 64 < 20 + rows; });
    const EncodedTile encoded = testing::encoded(tile.layout, tile.tiling, 0, tile.outcomes);
    const std::vector<std::byte>& bytes = encoded.chunks[0].bytes;
    EXPECT_EQ(encoded.chunks[0].skipped_filters, 0u);
    EXPECT_EQ(std::to_integer<int>(bytes[2]) & 7, 2) << "a block of fixed codes, and not the last";
    EXPECT_LE(bytes.size(), 7 * 64 * rows + 8 * 50) << "runs and block heads of eight planes";
    expect_read_back(tile.layout, tile.tiling, encoded, tile.outcomes);
  }
}

TEST(TileEncoder, SearchesWhereRunsAreShortOrRowsComeAgain) {
  const SparseTile few([](std::size_t i) { return i % 17 == 0; });
  const EncodedTile encoded = testing::encoded(few.layout, few.tiling, 0, few.outcomes);
  EXPECT_LE(encoded.chunks[0].bytes.size(), 5120u)
      << "301 numbers, and some six bytes for the gap before each";
  expect_read_back(few.layout, few.tiling, encoded, few.outcomes);

  SparseTile rows([](std::size_t) { return true; });
  for (std::size_t i = 320; i < rows.outcomes.size(); ++i)
    rows.outcomes[i].jump_height = rows.outcomes[i - 320].jump_height;
  const EncodedTile again = testing::encoded(rows.layout, rows.tiling, 0, rows.outcomes);
  EXPECT_LE(again.chunks[0].bytes.size(), 2u * 8u * 320u) << "320 different numbers";
  expect_read_back(rows.layout, rows.tiling, again, rows.outcomes);
}

}  // namespace
}  // namespace leapmap
