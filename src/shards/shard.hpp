// SPDX-License-Identifier: GPL-3.0-or-later
/// Shards: parts of a map for jobs of their own, each as much work as the others, of whole tiles.
///
/// Which tiles a shard has follows from the spec and the number of shards alone: a sample of each tile's
/// designs tells what it takes, counted (DesignEffort) and not timed, so that jobs on any machine share the
/// map alike.
#pragma once

#include <cstddef>
#include <vector>

#include "leapmap/sweep.hpp"
#include "map/hdf5.hpp"
#include "map/shard_name.hpp"
#include "map/tile.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// What each tile takes, all of them together the whole map's work, as it is told for so many shards.
std::vector<double> tile_efforts(const Spec& spec, const Tiling& tiling, std::size_t shards, int threads = 0);

/// The numbers of the tiles of each of so many shards, ascending: the hardest tiles first, each to the shard
/// that has least to do.
std::vector<std::vector<std::size_t>> share_tiles(const std::vector<double>& efforts, std::size_t shards);

/// A shard's part of the tiling: nothing, for some, if there are fewer tiles than shards.
/// threads: to look at the map with; 0: all.
Tiling shard_of(const Spec& spec, const Tiling& tiling, const Shard& shard, int threads = 0);

/// A shard's tiles, of so many that the map has, as its file tells them, and back. The latter throws
/// BrokenFile for numbers that no tiling has.
std::vector<std::int64_t> bits_of(const std::vector<std::size_t>& tiles, std::size_t count);
std::vector<std::size_t> tiles_in(const std::vector<std::int64_t>& bits, std::size_t count);
/// The same of a shard's file. Throws IoError if it does not tell.
std::vector<std::size_t> tiles_held(hid_t shard, std::size_t count);

}  // namespace leapmap
