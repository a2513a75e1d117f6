// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/tile.hpp"

#include <gtest/gtest.h>

#include <set>

namespace leapmap {
namespace {

TEST(Tiling, CoversEveryDesignExactlyOnce) {
  for (const std::vector<std::size_t>& shape :
       {std::vector<std::size_t>{1}, {7}, {1000}, {241, 256}, {13, 1, 9}, {121, 128, 8}, {3, 5, 2, 7, 4}}) {
    const Tiling tiling(shape);
    std::set<std::vector<std::size_t>> seen;
    std::size_t designs = 0;
    for (std::size_t number = 0; number < tiling.size(); ++number) {
      const Tile tile = tiling.tile(number);
      designs += tile.count;
      std::vector<std::size_t> position;
      for (std::size_t i = 0; i < tile.count; ++i) {
        unravel(i, tile.extent, position);
        for (std::size_t k = 0; k < shape.size(); ++k) {
          position[k] += tile.start[k];
          ASSERT_LT(position[k], shape[k]);
        }
        EXPECT_TRUE(seen.insert(position).second);
      }
    }
    EXPECT_EQ(designs, tiling.designs());
    EXPECT_EQ(seen.size(), tiling.designs());
  }
}

TEST(Tiling, TilesAreNeighboursAndNeitherTooManyNorTooLarge) {
  const Tiling grid({241, 256});
  EXPECT_EQ(grid.tile_shape(),
            (std::vector<std::size_t>{16, 32}));  // about equally long along each dimension
  EXPECT_GE(grid.size(), 64u);
  const Tiling billion({1000, 1000, 1000});
  const auto& tile = billion.tile_shape();
  EXPECT_LE(tile[0] * tile[1] * tile[2], 16384u);
  EXPECT_GE(tile[0] * tile[1] * tile[2], 8192u);
  for (const std::size_t side : tile) EXPECT_GE(side, 16u);
}

TEST(Unravel, TheLastDimensionIsFastest) {
  std::vector<std::size_t> position;
  unravel(7, {2, 3, 2}, position);
  EXPECT_EQ(position, (std::vector<std::size_t>{1, 0, 1}));
}

TEST(Tiling, ReachesOverTheMapsEdgeByLessThanADesignForEachTile) {
  for (const std::vector<std::size_t>& shape : std::vector<std::vector<std::size_t>>{
           {200, 200, 100}, {200, 200, 5}, {9, 9}, {101, 99}, {1000003}, {5, 5, 5, 5, 5, 5, 5, 5}}) {
    const Tiling tiling(shape);
    for (std::size_t k = 0; k < shape.size(); ++k) {
      const std::size_t side = tiling.tile_shape()[k], tiles = (shape[k] + side - 1) / side;
      EXPECT_LT(side * tiles - shape[k], tiles) << shape[k];
    }
  }
}

TEST(Tiling, KnowsHowManyDesignsComeBeforeATile) {
  const Tiling tiling({7, 9, 5}, {4, 4, 3});
  std::size_t before = 0;
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    EXPECT_EQ(tiling.designs_before(tiling.tile(t)), before);
    before += tiling.tile(t).count;
  }
  EXPECT_EQ(before, tiling.designs());
}

}  // namespace
}  // namespace leapmap
