// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/tile.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <functional>
#include <numeric>
#include <utility>

namespace leapmap {

namespace {

std::size_t product(const std::vector<std::size_t>& extents) {
  return std::accumulate(extents.begin(), extents.end(), std::size_t{1}, std::multiplies<>());
}

/// Doubles the shortest side that can still grow until the tile is as large as it should be. Then each
/// side is shortened as far as the number of tiles along it allows: what reaches over the map's edge would be
/// encoded, too.
std::vector<std::size_t> balanced_tile(const std::vector<std::size_t>& shape, std::size_t most,
                                       std::size_t least) {
  constexpr std::size_t wanted_tiles = 64;
  const std::size_t target = std::bit_floor(std::min(most, std::max(product(shape) / wanted_tiles, least)));
  std::vector<std::size_t> tile(shape.size(), 1);
  while (product(tile) < target) {
    std::size_t shortest = shape.size();
    for (std::size_t i = shape.size(); i-- > 0;)
      if (tile[i] < shape[i] && (shortest == shape.size() || tile[i] < tile[shortest])) shortest = i;
    if (shortest == shape.size()) break;
    tile[shortest] = std::min(2 * tile[shortest], shape[shortest]);
  }
  const auto parts = [](std::size_t whole, std::size_t part) { return (whole + part - 1) / part; };
  for (std::size_t i = 0; i < tile.size(); ++i) tile[i] = parts(shape[i], parts(shape[i], tile[i]));
  return tile;
}

}  // namespace

std::size_t designs_of(const std::vector<std::size_t>& shape) { return product(shape); }

Tiling::Tiling(std::vector<std::size_t> shape, std::vector<std::size_t> tile_shape)
    : shape_(std::move(shape)),
      tile_shape_(std::move(tile_shape)),
      designs_(product(shape_)),
      whole_designs_(designs_) {
  assert(shape_.size() == tile_shape_.size());
  for (std::size_t i = 0; i < shape_.size(); ++i) {
    assert(tile_shape_[i] > 0 && tile_shape_[i] <= shape_[i]);
    tiles_along_.push_back((shape_[i] + tile_shape_[i] - 1) / tile_shape_[i]);
  }
  tiles_ = product(tiles_along_);
}

Tiling::Tiling(std::vector<std::size_t> shape, std::size_t most, std::size_t least)
    : Tiling(shape, balanced_tile(shape, most, least)) {}

Tiling Tiling::part(std::vector<std::size_t> numbers) const {
  assert(!is_part_);
  Tiling some = *this;
  some.is_part_ = true;
  some.chosen_ = std::move(numbers);
  some.designs_ = 0;
  for (std::size_t k = 0; k < some.chosen_.size(); ++k) some.designs_ += some.tile(k).count;
  return some;
}

std::size_t Tiling::largest_tile() const { return product(tile_shape_); }

Tile Tiling::tile(std::size_t number) const {
  Tile tile;
  unravel(is_part_ ? chosen_[number] : number, tiles_along_, tile.start);
  tile.extent.resize(shape_.size());
  for (std::size_t i = 0; i < shape_.size(); ++i) {
    tile.start[i] *= tile_shape_[i];
    tile.extent[i] = std::min(tile_shape_[i], shape_[i] - tile.start[i]);
  }
  tile.count = product(tile.extent);
  return tile;
}

std::size_t Tiling::number(const Tile& tile, std::size_t index) const {
  std::vector<std::size_t> position;
  unravel(index, tile.extent, position);
  std::size_t number = 0;
  for (std::size_t i = 0; i < shape_.size(); ++i) number = number * shape_[i] + tile.start[i] + position[i];
  return number;
}

std::size_t Tiling::designs_before(const Tile& tile) const {
  // Along each dimension: all tiles that start earlier there, and at the same place along those before it.
  std::size_t before = 0, same = 1, beyond = whole_designs_;
  for (std::size_t i = 0; i < shape_.size(); ++i) {
    beyond /= shape_[i];
    before += same * tile.start[i] * beyond;
    same *= tile.extent[i];
  }
  return before;
}

void unravel(std::size_t index, const std::vector<std::size_t>& extent, std::vector<std::size_t>& position) {
  position.resize(extent.size());
  for (std::size_t i = extent.size(); i-- > 0;) {
    position[i] = index % extent[i];
    index /= extent[i];
  }
}

std::size_t place_along(const std::vector<std::size_t>& extent, std::size_t index, std::size_t dimension) {
  for (std::size_t i = extent.size(); i-- > dimension + 1;) index /= extent[i];
  return index % extent[dimension];
}

}  // namespace leapmap
