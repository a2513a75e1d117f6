// SPDX-License-Identifier: GPL-3.0-or-later
/// The tile: a block of neighbouring designs, one task, one chunk of the file.
#pragma once

#include <cstddef>
#include <vector>

namespace leapmap {

/// A block of a map: where it starts and how far it reaches along each dimension; designs in C order, last
/// fastest.
struct Tile {
  std::vector<std::size_t> start, extent;
  std::size_t count = 0;  ///< designs in it
};

/// How a map is cut into tiles, numbered in C order. The last tiles of a dimension may be cut short.
class Tiling {
 public:
  /// tile_shape 0 along no dimension, and no longer than shape.
  Tiling(std::vector<std::size_t> shape, std::vector<std::size_t> tile_shape);
  /// Cuts a map into tiles of neighbours about equally long along each dimension: so many that work divides
  /// evenly, so large that a tile's overhead does not matter, but of no more than `most` designs. Depends on
  /// these only, never on the machine.
  explicit Tiling(std::vector<std::size_t> shape, std::size_t most = 16384);

  std::size_t size() const { return tiles_; }
  Tile tile(std::size_t number) const;
  /// The number in the whole map, C order, of a tile's design `index`.
  std::size_t number(const Tile& tile, std::size_t index) const;
  /// How many designs the tiles before this one hold.
  std::size_t designs_before(const Tile& tile) const;
  const std::vector<std::size_t>& shape() const { return shape_; }
  const std::vector<std::size_t>& tile_shape() const { return tile_shape_; }
  std::size_t designs() const { return designs_; }

 private:
  std::vector<std::size_t> shape_, tile_shape_, tiles_along_;
  std::size_t tiles_ = 1, designs_ = 1;
};

/// The position of design `index` of a block (in C order) along each of its dimensions.
void unravel(std::size_t index, const std::vector<std::size_t>& extent, std::vector<std::size_t>& position);

}  // namespace leapmap
