// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Joining the shards of a map, which SweepOptions::shard made.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "leapmap/audit.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// Options of join.
struct JoinOptions {
  std::size_t shards = 0;  ///< number of shards; 0: the number in their file names
  bool overwrite = false;  ///< replace an existing map
  bool lock = true;        ///< false: do not lock files on a file system without locks
  /// Leave the values in the shards: the map then has HDF5's virtual datasets, which read them from there.
  bool as_virtual = false;
  /// Receives the number of designs joined and their total, after each chunk.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Polled after each chunk; if it returns true, join ends and removes what it wrote.
  std::function<bool()> stop_requested{};
};

/// Result of join.
struct JoinReport {
  std::size_t shards = 0;              ///< number of shards
  std::size_t tiles = 0;               ///< number of chunks copied
  std::size_t designs = 0;             ///< number of designs
  StatusCounts statuses{};             ///< number of designs with each status
  bool durable = true;                 ///< false: a power failure may still undo the map's renaming
  std::optional<AuditReport> audit{};  ///< cross-check of the whole map; unset: the sweep had none
  Spec spec{};                         ///< the map's spec
};

/// Joins the shards that lie beside `path` into the map `path`.
///
/// Copies every chunk as it is stored, so that the datasets equal those of one sweep bit for bit. The shards
/// remain.
/// @return  nullopt if stopped
/// @throws InputError, which names the shard to make again, if one is missing, unfinished, doubled or from
///         another spec or program; BrokenFile if one is damaged; IoError. No map remains in these cases.
std::optional<JoinReport> join(const std::string& path, const JoinOptions& options = {});

}  // namespace leapmap
