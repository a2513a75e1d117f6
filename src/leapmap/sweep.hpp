// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves the designs of a spec into a map on disk, audited on the way; crash-safe.
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

/// Part `number`, from 1, of so many parts of a map, at most 10 000.
struct Shard {
  std::size_t number = 1, of = 1;
};

struct SweepOptions {
  std::optional<Shard> shard{};  ///< only this part of the map, into a file of its own beside it (shard_path)
  bool resume = false;           ///< go on with the MAP.part that an earlier sweep left, if there is one
  bool overwrite = false;        ///< replace an existing map; without resume its .part as well
  int threads = 0;               ///< 0: as many as OpenMP offers
  double commit_interval =
      1.0;           ///< [s] >= 0; kill -9 or a power cut loses no more than that and tiles in hand
  bool lock = true;  ///< false: do without locks where the file system has none
  /// Told how many designs of how many are in the map: once before the first is solved, from the caller's
  /// thread; then after each tile, from the thread that writes.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Asked after each tile, from any thread; true: the sweep ends early and keeps what is done.
  std::function<bool()> stop_requested{};
};

struct Report {
  bool whole = false;                  ///< false: it was stopped, and MAP.part keeps what is done
  bool was_whole = false;              ///< resumed, and the map of this spec was there already
  std::size_t designs = 0;             ///< of the spec
  std::size_t done = 0;                ///< in the map now
  std::size_t solved = 0;              ///< by this call
  StatusCounts statuses{};             ///< designs in the map by how they ended
  double seconds = 0.0;                ///< of this call's solving, without its audit's share of the threads
  bool durable = true;                 ///< false: a power cut may undo the map's taking its place
  std::optional<AuditReport> audit{};  ///< of the whole map; unset: numerics.audit is 0
};

/// Solves spec into the map `path`. Throws InputError if spec or options are not allowed, or the file is
/// there and may not be replaced; KeptError if the file cannot be written any more; IoError.
Report sweep(const Spec& spec, const std::string& path, const SweepOptions& options = {});

/// A map could not be written any more.
struct KeptError : IoError {
  KeptError(const std::string& what, std::size_t kept_designs, std::size_t all_designs)
      : IoError(what), kept(kept_designs), designs(all_designs) {}
  std::size_t kept, designs;  ///< designs that MAP.part keeps, to be gone on with by resume; of so many
};

struct RetryReport {
  std::size_t retried = 0, still_failed = 0;
  StatusCounts statuses{};  ///< of the whole map, after
  bool durable = true;      ///< false: a power cut may undo the map's taking its place
};

struct RetryOptions {
  std::optional<Numerics> how{};  ///< unset: by the method that audits the map's
  int threads = 0;                ///< 0: as many as OpenMP offers
  bool lock = true;               ///< false: do without locks where the file system has none
  std::function<bool()>
      stop_requested{};  ///< asked now and then, from any thread; true: the map stays as it is
};

/// Solves the designs with status failed in a finished map again: as options.how says if that is another way
/// than the map's, else by the method that audits it; and stores what comes out in a copy that takes the
/// map's place once it is whole. Derivatives and numbers of hoops as made are not solved for again: of these
/// designs they stay as they are, not a number. Returns nullopt if stopped; the map is unchanged then. Throws
/// InputError if the map is not whole, holds no status or is in use; BrokenFile if it is not what was
/// written; IoError.
std::optional<RetryReport> retry_failed(const std::string& path, const RetryOptions& options = {});

}  // namespace leapmap
