// SPDX-License-Identifier: GPL-3.0-or-later
/// One map of all the shards that sweeps with SweepOptions::shard made of it.
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

struct JoinOptions {
  std::size_t shards = 0;  ///< of how many the map is; 0: of as many as those beside it say
  bool overwrite = false;  ///< replace an existing map
  bool lock = true;        ///< false: do without locks where the file system has none
  /// The values stay in the shards, and the map has HDF5's virtual datasets, which look them up there: for a
  /// map too large to be copied. It is worth as much as the shards beside it.
  bool as_virtual = false;
  /// Told how many designs of how many are in the map, after each tile.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Asked after each tile; true: the joining ends and nothing is kept.
  std::function<bool()> stop_requested{};
};

struct JoinReport {
  std::size_t shards = 0, tiles = 0, designs = 0;
  StatusCounts statuses{};
  bool durable = true;                 ///< false: a power cut may undo the map's taking its place
  std::optional<AuditReport> audit{};  ///< of the whole map; unset: it had none
  Spec spec{};                         ///< of the map
};

/// Joins the shards of the map `path`, which lie beside it: every chunk is copied as it is stored, so that
/// the map's datasets are those of one sweep bit for bit. The shards stay. Returns nullopt if stopped. Throws
/// InputError, which says which to make again, if a shard is missing, unfinished, doubled or of another spec
/// or program, BrokenFile, which says so too, if some are not what was written, IoError. Nothing is left of
/// the map then.
std::optional<JoinReport> join(const std::string& path, const JoinOptions& options = {});

}  // namespace leapmap
