// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether a map is what was written, and right.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "map/journaled_file.hpp"

namespace leapmap {

struct CheckOptions {
  std::size_t sample = 200;  ///< designs to solve again by another method, at random; 0: none
  int threads = 0;           ///< 0: as many as OpenMP offers
  Locking locking = Locking::required;
  std::function<bool()>
      stop_requested;  ///< asked now and then; true: the report covers what was done until then
};

struct CheckReport {
  std::vector<std::string> findings;   ///< what is wrong and where, a line each; empty: nothing
  std::size_t tiles = 0, designs = 0;  ///< that were read
  bool whole = true;                   ///< false: the .part of a sweep that was stopped
  bool sealed = true;                  ///< the file ends with a checksum of all of it, which holds
  std::optional<AuditReport> sample;   ///< unset: not solved again, as the map is damaged or does not want it
};

/// Whether the file's bytes are those that were written, by its own checksum; unset: it has none. Throws
/// InputError if somebody is writing it, IoError if it cannot be read.
std::optional<bool> seal_holds(const std::string& path, Locking locking);

/// Reads everything in a map, or in the .part of one: axes and descriptions against its spec, every chunk
/// with its checksum, every value against what its field may hold, designs by status against their count, and
/// a sample against another method. What is no map of ours is a finding too. Throws IoError if the system
/// fails to read the file, InputError while a sweep is writing it.
CheckReport check_map(const std::string& path, const CheckOptions& options);

}  // namespace leapmap
