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

/// How a map is cut into tiles, numbered in C order. The last tiles of a dimension may be cut short. Part of
/// a map is some of its tiles, counted through: tile(k) is the k-th of them.
class Tiling {
 public:
  /// tile_shape 0 along no dimension, and no longer than shape.
  Tiling(std::vector<std::size_t> shape, std::vector<std::size_t> tile_shape);
  /// Cuts a map into tiles of neighbours about equally long along each dimension: so many that work divides
  /// evenly, so large that a tile's overhead does not matter, but of no more than `most` designs, and in a
  /// small map of half to all of `least`. Depends on these only, never on the machine.
  explicit Tiling(std::vector<std::size_t> shape, std::size_t most = 16384, std::size_t least = 64);

  /// The same map with these of its tiles only, in this order.
  Tiling part(std::vector<std::size_t> numbers) const;
  bool is_part() const { return is_part_; }

  std::size_t size() const { return is_part_ ? chosen_.size() : tiles_; }
  Tile tile(std::size_t number) const;
  /// The numbers of a part's tiles in the whole map.
  const std::vector<std::size_t>& chosen() const { return chosen_; }
  std::size_t largest_tile() const;
  /// The number in the whole map, C order, of a tile's design `index`.
  std::size_t number(const Tile& tile, std::size_t index) const;
  /// How many designs the tiles of the whole map before this one hold.
  std::size_t designs_before(const Tile& tile) const;
  const std::vector<std::size_t>& shape() const { return shape_; }
  const std::vector<std::size_t>& tile_shape() const { return tile_shape_; }
  /// Of its tiles, and of the whole map.
  std::size_t designs() const { return designs_; }
  std::size_t whole_designs() const { return whole_designs_; }

 private:
  std::vector<std::size_t> shape_, tile_shape_, tiles_along_, chosen_;
  std::size_t tiles_ = 1, designs_ = 1, whole_designs_ = 1;
  bool is_part_ = false;
};

/// How many designs a shape holds.
std::size_t designs_of(const std::vector<std::size_t>& shape);

/// The position of design `index` of a block (in C order) along each of its dimensions.
void unravel(std::size_t index, const std::vector<std::size_t>& extent, std::vector<std::size_t>& position);
/// That along one of them.
std::size_t place_along(const std::vector<std::size_t>& extent, std::size_t index, std::size_t dimension);

}  // namespace leapmap
