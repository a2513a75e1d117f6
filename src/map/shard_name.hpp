// SPDX-License-Identifier: GPL-3.0-or-later
/// How shards of a map, and their files, are called.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "leapmap/sweep.hpp"

namespace leapmap {

inline constexpr std::size_t most_shards = 10'000;

/// From "3/16". Throws InputError.
Shard parse_shard(std::string_view text);

/// Throws InputError unless it is one: 1 <= number <= of <= most_shards.
void check_shard(const Shard& shard);
std::string text_of(const Shard& shard);

/// The file of a shard, beside the map that it is part of: MAP.3-of-16.h5 of MAP.h5.
std::string shard_path(const std::string& map, const Shard& shard);

/// Which shard, of whatever map, a file says to be by its name alone; nothing: none.
std::optional<Shard> shard_by_name(const std::string& file);

}  // namespace leapmap
