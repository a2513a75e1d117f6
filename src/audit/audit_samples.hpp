// SPDX-License-Identifier: GPL-3.0-or-later
/// Which of a sweep's outcomes are solved again, as the map keeps them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "leapmap/outcome.hpp"
#include "map/reader.hpp"
#include "map/tile.hpp"
#include "spec/spec.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// An outcome taken from a sweep on its way to the map.
struct AuditSample {
  std::size_t number;  ///< of the design, C order over the whole map
  Outcome outcome;
  std::vector<double> gradient{};  ///< what the map stores, of each quantity by each parameter; empty: none
};

/// The designs of a tile that the audit looks at, by their place in it; which ones depends on share and map
/// alone. Over all tiles, ceil(share * designs).
std::vector<std::size_t> audit_draw(double share, const Tiling& tiling, const Tile& tile);
/// Of those the ones in a piece of the tile, from its design `first` on.
std::vector<std::size_t> audit_draw(double share, const Tiling& tiling, const Tile& tile, std::size_t first,
                                    std::size_t designs);

/// The samples drawn from a piece of a tile, its outcomes `first`, first + 1, ..., rounded as the map rounds
/// them.
std::vector<AuditSample> audit_samples(const Spec& spec, const Tiling& tiling, const Tile& tile,
                                       std::size_t first, std::span<const Outcome> outcomes,
                                       const Gradients& gradients = {});

/// The samples of a tile of a finished map: the outcomes are the solver's, but all that the map stores is the
/// map's.
std::vector<AuditSample> audit_samples(const MapReader& map, const Spec& spec, double share,
                                       const Tiling& tiling, const Tile& tile, const Solver& solve);

}  // namespace leapmap
