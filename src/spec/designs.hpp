// SPDX-License-Identifier: GPL-3.0-or-later
/// The designs of a spec by number, without ever holding them all.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "map/tile.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// The length of each dimension of the spec's map: its axes, or one list.
std::vector<std::size_t> shape_of(const Spec& spec);

/// How the spec's map is cut into tiles: where many hoops are made after each design, into smaller ones.
Tiling tiling_of(const Spec& spec);

/// The designs of a tile, in its order.
class DesignSpace {
 public:
  /// Keeps a reference to spec.
  explicit DesignSpace(const Spec& spec);

  /// Design `index` in C order over the whole map.
  Design at(std::size_t index) const;
  /// Fills in a tile's designs `first`, first + 1, ...
  void fill(const Tile& tile, std::size_t first, std::span<Design> designs) const;

 private:
  Design at_position(const std::vector<std::size_t>& position) const;

  const Spec& spec_;
  std::vector<double Design::*> members_;  // of the axes, or of the list's columns
};

/// A design's number and, in a list that has labels, its name.
std::string told_design(const Spec& spec, std::size_t number);

/// The command line that solves this design alone, every digit of it.
std::string hop_command(const Spec& spec, const Design& design);

}  // namespace leapmap
