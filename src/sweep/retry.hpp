// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves the failed designs of a map again.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "leapmap/sweep.hpp"
#include "map/journaled_file.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// How failed designs of a map made by `there` are solved again: as `here` says if that is another way, else
/// by the method that audits it.
Numerics retry_numerics(const Numerics& there, const Numerics& here, const Scene& scene);

/// retry_failed of the map `path`, which is of this spec, spec.numerics saying how.
std::optional<RetryReport> retry_with(const std::string& path, const Spec& spec, int threads,
                                      Locking locking = Locking::required,
                                      const std::function<bool()>& stop_requested = {});

}  // namespace leapmap
