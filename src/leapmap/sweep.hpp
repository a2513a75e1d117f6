// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Solving the designs of a spec into a map on disk, cross-checked and crash-safe.
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

/// One of the parts into which a map is divided, at most 10,000.
struct Shard {
  std::size_t number = 1;  ///< number of this part, from 1
  std::size_t of = 1;      ///< number of parts
};

/// Options of sweep.
struct SweepOptions {
  std::optional<Shard> shard{};  ///< solve this part only, into a file of its own beside the map
  bool resume = false;           ///< continue the MAP.part that an interrupted sweep left, if there is one
  bool overwrite = false;        ///< replace an existing map and, without `resume`, its .part
  int threads = 0;               ///< number of threads; 0: all that OpenMP offers
  double commit_interval = 1.0;  ///< time between commits [s], >= 0; a crash loses at most that much work
  bool lock = true;              ///< false: do not lock files on a file system without locks
  /// Receives the number of designs stored and their total: once before the first is solved, from the
  /// caller's thread; then after each chunk, from the thread that writes.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Polled after each chunk, from any thread; if it returns true, the sweep ends and keeps what is done.
  std::function<bool()> stop_requested{};
};

/// Result of sweep.
struct Report {
  bool whole = false;                  ///< whether the map is complete; if not, MAP.part keeps what is done
  bool was_whole = false;              ///< whether the map of this spec was complete before
  std::size_t designs = 0;             ///< number of designs in the spec
  std::size_t done = 0;                ///< number of designs in the map
  std::size_t solved = 0;              ///< number of designs that this call solved
  StatusCounts statuses{};             ///< number of designs with each status
  double seconds = 0.0;                ///< duration of solving, without the cross-check [s]
  bool durable = true;                 ///< false: a power failure may still undo the map's renaming
  std::optional<AuditReport> audit{};  ///< cross-check of the whole map; unset: numerics.audit is 0
};

/// Solves a spec into the map `path`.
/// @throws InputError if spec or options are not allowed, or if the file exists and may not be replaced;
///         KeptError if the file can no longer be written; IoError
Report sweep(const Spec& spec, const std::string& path, const SweepOptions& options = {});

/// A map could no longer be written. What MAP.part holds can be resumed.
struct KeptError : IoError {
  /// @param what          the message
  /// @param kept_designs  number of designs that MAP.part holds
  /// @param all_designs   number of designs in the spec
  KeptError(const std::string& what, std::size_t kept_designs, std::size_t all_designs)
      : IoError(what), kept(kept_designs), designs(all_designs) {}
  std::size_t kept;     ///< number of designs that MAP.part holds
  std::size_t designs;  ///< number of designs in the spec
};

/// Result of retry_failed.
struct RetryReport {
  std::size_t retried = 0;       ///< number of designs solved again
  std::size_t still_failed = 0;  ///< number of these that failed again
  StatusCounts statuses{};       ///< number of designs with each status in the whole map, afterwards
  bool durable = true;           ///< false: a power failure may still undo the map's renaming
};

/// Options of retry_failed.
struct RetryOptions {
  std::optional<Numerics> how{};  ///< method to use; unset: the one that cross-checks the map's method
  int threads = 0;                ///< number of threads; 0: all that OpenMP offers
  bool lock = true;               ///< false: do not lock files on a file system without locks
  /// Polled from any thread; if it returns true, the map remains unchanged.
  std::function<bool()> stop_requested{};
};

/// Solves the designs with status failed of a complete map again, by another method.
///
/// The results go into a copy that replaces the map when it is complete. Derivatives and statistics of
/// manufactured hoops are not computed for these designs; they remain NaN.
/// @return  nullopt if stopped; the map is unchanged then
/// @throws InputError if the map is incomplete, stores no status or is in use; BrokenFile if it is damaged;
///         IoError
std::optional<RetryReport> retry_failed(const std::string& path, const RetryOptions& options = {});

}  // namespace leapmap
