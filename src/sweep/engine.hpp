// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves the tiles of a sweep on all threads and hands them on in order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "map/tile.hpp"
#include "sweep/spec.hpp"
#include "trajectory/outcome.hpp"

namespace leapmap {

struct EngineOptions {
  int threads = 0;                       ///< 0: as many as OpenMP offers
  std::function<bool()> stop_requested;  ///< asked after each tile; true: no further tile is begun
  std::function<void(std::size_t designs_done)> progress;  ///< after each tile handed on
};

/// Takes a tile's outcomes, in the tile's order. Called for one tile at a time, tiles in order of their
/// numbers, from whichever thread; what it throws ends the sweep and is thrown on by run_sweep.
using TileSink = std::function<void(const Tile&, std::span<const Outcome>)>;

/// Solves every tile; returns the number of designs handed on, all of them unless a stop was requested.
/// Outcomes depend on the spec alone, not on threads or timing; memory does not grow with the number of
/// designs.
std::size_t run_sweep(const Spec& spec, const Tiling& tiling, const EngineOptions& options,
                      const TileSink& sink);

/// Seconds per design on one thread, from a seeded sample solved for about the given time.
double seconds_per_design(const Spec& spec, double seconds);

}  // namespace leapmap
