// SPDX-License-Identifier: GPL-3.0-or-later
#include "shards/shard.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>

#include "engine/map_layout.hpp"
#include "engine/provenance.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/join.hpp"
#include "leapmap/sweep.hpp"
#include "map/shard_name.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "support/small_map.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t along = 20, even_shards = 4;  // of so small a map one tile is more than a sixteenth
#else
constexpr std::size_t along = 40, even_shards = 16;
#endif

/// Hoops that slip a little, of which some rock to rest in hundreds of phases.
Spec uneven() {
  Spec spec;
  spec.scene.friction = Friction::coulomb;
  spec.design.restitution = 0.3;
  const auto evenly = [](double from, double to, std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i)
      values[i] = from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
    return values;
  };
  spec.axes = {{"mu_static", evenly(0.05, 1.2, along)},
               {"slope", evenly(0.035, 0.78, along + 20)},
               {"mass_ratio", evenly(0.2, 12.0, along)}};
  return spec;
}

TEST(Shards, TakeAsMuchWorkAsEachOther) {
  const Spec spec = uneven();
  const Tiling tiling = tiling_of(spec);
  const DesignSpace space(spec);
  const DesignEffort effort = model_of(spec.scene).effort(spec.scene, false);
  std::vector<double> all;  // of every tile, every design counted
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const Tile tile = tiling.tile(t);
    double sum = 0.0;
    for (std::size_t i = 0; i < tile.count; ++i) sum += effort(space.at(tiling.number(tile, i)));
    all.push_back(sum);
  }
  const auto [least, most] = std::ranges::minmax(all);
  EXPECT_GT(most / least, 20.0);  // else there is nothing to share out
  constexpr std::size_t shards = even_shards;
  const double mean = std::accumulate(all.begin(), all.end(), 0.0) / shards;
  std::set<std::size_t> seen;
  for (const auto& share : share_tiles(tile_efforts(spec, tiling, shards), shards)) {
    double load = 0.0;
    for (const std::size_t t : share) {
      load += all[t];
      EXPECT_TRUE(seen.insert(t).second);
    }
    EXPECT_LT(load, 1.25 * mean);
    EXPECT_TRUE(std::ranges::is_sorted(share));
  }
  EXPECT_EQ(seen.size(), tiling.size());
}

TEST(Shards, EffortsKnowDerivativesAndLaterJumps) {
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    Scene one, five;
    one.friction = five.friction = friction;
    five.jumps = 5;
    const Model& model = model_of(friction);
    const DesignEffort plain = model.effort(one, false), derived = model.effort(one, true),
                       followed = model.effort(five, false);
    Design jumps, stays;
    jumps.slope = 0.5, jumps.mass_ratio = 5.0, jumps.offset_ratio = 0.9;
    stays.slope = 0.05, stays.mass_ratio = 0.1;  // and rolls on
    EXPECT_GT(derived(jumps), 2.0 * plain(jumps));
    EXPECT_EQ(derived(stays), plain(stays));
    EXPECT_GT(followed(jumps), 1.5 * plain(jumps));
    EXPECT_EQ(followed(jumps), followed(jumps));  // counted, and nothing kept from one to the next
  }
}

TEST(Shards, AreTheSameWhateverTheThreads) {
  const Spec spec = uneven();
  const Tiling tiling = tiling_of(spec);
  const std::vector<double> here = tile_efforts(spec, tiling, 8);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  EXPECT_EQ(tile_efforts(spec, tiling, 8), here);
  omp_set_num_threads(threads);
}

TEST(Shards, OfHoopsThatNeverSlipHaveAsManyDesigns) {
  Spec spec = uneven();
  spec.scene.friction = Friction::sticking;
  spec.axes[0].key = "offset_ratio";
  for (double& value : spec.axes[0].values) value = std::min(value, 1.0);
  const Tiling tiling = tiling_of(spec);
  std::size_t least = tiling.designs(), most = 0;
  for (std::size_t i = 1; i <= 5; ++i) {
    const std::size_t designs = shard_of(spec, tiling, {i, 5}).designs();
    least = std::min(least, designs), most = std::max(most, designs);
  }
  EXPECT_LE(most - least, tiling.largest_tile());
}

TEST(Shards, SharesOfEqualLoadsDoNotDependOnTheOrderTheyAreFoundIn) {
  const std::vector<std::vector<std::size_t>> shares = share_tiles({1.0, 1.0, 1.0, 1.0, 1.0}, 3);
  EXPECT_EQ(shares, (std::vector<std::vector<std::size_t>>{{0, 3}, {1, 4}, {2}}));
  EXPECT_EQ(share_tiles({3.0, 1.0}, 4), (std::vector<std::vector<std::size_t>>{{0}, {1}, {}, {}}));
}

TEST(Shards, TilesAreToldInBitsAndReadAgain) {
  std::mt19937_64 random(4);
  for (const std::size_t count : {1u, 63u, 64u, 65u, 1000u}) {
    std::vector<std::size_t> tiles;
    for (std::size_t t = 0; t < count; ++t)
      if (random() % 3 == 0) tiles.push_back(t);
    EXPECT_EQ(tiles_in(bits_of(tiles, count), count), tiles);
  }
  EXPECT_THROW(tiles_in({-1}, 5), BrokenFile);  // tiles that there are not
  EXPECT_THROW(tiles_in({1, 0}, 5), BrokenFile);
}

TEST(Shards, AreNamedAndRead) {
  EXPECT_EQ(shard_path("maps/a.b.h5", {3, 16}), "maps/a.b.3-of-16.h5");
  const Shard shard = parse_shard("3/16");
  EXPECT_EQ(text_of(shard), "3/16");
  for (const char* wrong : {"", "3", "/", "0/2", "3/2", "1/", "/2", "1/2/3", "1.5/2", " 1/2", "1/99999999"})
    EXPECT_THROW(parse_shard(wrong), InputError) << wrong;
  for (const Shard wrong : {Shard{0, 8}, Shard{9, 8}, Shard{1, 0}, Shard{1, most_shards + 1}})
    EXPECT_THROW(sweep({}, "m.h5", {.shard = wrong}), InputError) << text_of(wrong);
  for (const std::string map : {"a.h5", "a.b.h5", "a", "a.1-of-2.h5"}) {
    const std::optional<Shard> named = shard_by_name(shard_path(map, shard));
    ASSERT_TRUE(named) << map;
    EXPECT_EQ(text_of(*named), "3/16") << map;
  }
  for (const char* none : {"", "a.h5", "a.3-of.h5", "3-of-16", "a.17-of-16.h5", "a.3-of-16.h5.part"})
    EXPECT_FALSE(shard_by_name(none)) << none;
}

TEST(Shards, OfALeapmapThatCutsMapsIntoOtherTilesAreJoinedAsTheyAre) {
  Spec spec;
  spec.axes = {{"slope", {0.1, 0.2, 0.3}}, {"mass_ratio", {1, 2, 3, 4, 5}}};
  const MapLayout layout = layout_of(spec);
  const Tiling others({3, 5}, {2, 3});
  ASSERT_NE(others.tile_shape(), tiling_of(spec).tile_shape());
  const testing::TemporaryFolder folder;
  const std::string path = folder / "map.h5";
  const std::array<std::vector<std::size_t>, 2> shares{{{0, 3}, {1, 2}}};
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const Tiling part = others.part(shares[k]);
    const Shard shard{k + 1, shares.size()};
    std::vector<hdf5::Attribute> attributes = provenance(spec, shard_filetype, title_of(spec));
    attributes.emplace_back(shard_attribute, text_of(shard));
    attributes.emplace_back(shard_tiles_attribute, bits_of(part.chosen(), others.size()));
    attributes.emplace_back("threads", std::int64_t{1});
    MapWriter writer = MapWriter::begin(shard_path(path, shard), layout, part, attributes, false);
    testing::write_rest(writer, layout, part);
    EXPECT_TRUE(writer.finish({}));
  }
  const auto report = join(path);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->tiles, 4u);
  const std::vector<double> heights = MapReader(path).read("jump_height", Tile{{0, 0}, {3, 5}, 15});
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_EQ(heights[i], static_cast<double>(i) + 0.25);
}

TEST(PartOfATiling, HasSomeOfTheTilesInTheirPlaces) {
  const Tiling whole({13, 9}, {4, 4});
  const Tiling some = whole.part({1, 5, 11});
  EXPECT_TRUE(some.is_part() && !whole.is_part());
  EXPECT_EQ(some.size(), 3u);
  EXPECT_EQ(some.whole_designs(), whole.designs());
  std::size_t designs = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Tile here = some.tile(k), there = whole.tile(some.chosen()[k]);
    EXPECT_EQ(here.start, there.start);
    EXPECT_EQ(here.extent, there.extent);
    EXPECT_EQ(some.designs_before(here), whole.designs_before(there));
    designs += here.count;
  }
  EXPECT_EQ(some.designs(), designs);
  EXPECT_EQ(whole.part({}).designs(), 0u);
}

}  // namespace
}  // namespace leapmap
