// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves the failed designs of a map again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "leapmap/outcome.hpp"
#include "map/journaled_file.hpp"
#include "sweep/spec.hpp"

namespace leapmap {

struct RetryReport {
  std::size_t retried = 0, still_failed = 0;
  StatusCounts statuses{};  ///< of the whole map, after
  bool durable = true;      ///< false: a power cut may undo it (JournaledFile::rename)
};

/// How failed designs of a map made by `there` are solved again: as `here` says if that is another way, else
/// by the method that audits it.
Numerics retry_numerics(const Numerics& there, const Numerics& here);

/// Solves the designs with status failed in the map `path`, which is of this spec, again, spec.numerics
/// saying how, and stores what comes out: on a copy, PATH.retry, which takes the map's place once it is whole
/// and was read again. All else in the map stays. Returns nullopt if stopped; the map is unchanged then.
/// Throws InputError if the map is not whole, holds no status, or is in use; BrokenFile if it is not what was
/// written; IoError.
std::optional<RetryReport> retry_failed(const std::string& path, const Spec& spec, int threads,
                                        Locking locking = Locking::required,
                                        const std::function<bool()>& stop_requested = {});

}  // namespace leapmap
