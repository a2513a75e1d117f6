// SPDX-License-Identifier: GPL-3.0-or-later
/// What files of ours call themselves, and their version.
#pragma once

#include <cstdint>
#include <string_view>

namespace leapmap {

inline constexpr std::string_view map_filetype = "leapmap map";
inline constexpr std::string_view shard_filetype = "leapmap shard";
inline constexpr std::string_view cliffs_filetype = "leapmap cliffs";
inline constexpr std::string_view trace_filetype = "leapmap trace";
inline constexpr const char* shard_attribute = "shard";  ///< of a shard: which of how many, "3/16"
/// Of a shard: which tiles of the map it holds, a bit each, the first tile's the lowest of the first number.
inline constexpr const char* shard_tiles_attribute = "shard_tiles";
/// Of a joined map: how many it was joined of.
inline constexpr const char* shards_attribute = "shards";
/// Of a map whose values stay in its shards: the tiles_checksum of each, in the order of its datasets'
/// sources.
inline constexpr const char* shard_checksums_attribute = "shard_checksums";
inline constexpr const char* tiles_checksum_attribute = "tiles_checksum";
/// An axis is held in memory, and told in the resolved spec.
inline constexpr std::int64_t most_axis_values = 1'000'000;
/// A map of more is terabytes: surely a typing error.
inline constexpr double most_designs = 1e12;
inline constexpr int format_major = 1;  ///< readers refuse a newer one
/// 1: f4; 2: compression, status_counts, the NeXus group; 3: Coulomb friction's fields; 4: a checksum of each
/// chunk and of the file, the audit's state; 5: the referee; 6: labels of a list; 7: derivatives; 8: hoops as
/// made; 9: later jumps; 10: their audit, and gaits'; 11: shards; 12: measures of jumps; 13: [hoop], motors
/// in flight; 14: derivatives by numbers of [hoop]; 15: resisting torques;
/// 16: parameters in the units of the nominal hoop; 17: proofs; 18: pendulums.
inline constexpr int format_minor = 19;

}  // namespace leapmap
