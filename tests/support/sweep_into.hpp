// SPDX-License-Identifier: GPL-3.0-or-later
/// A sweep into a map, without the program around it.
#pragma once

#include <memory>

#include "engine/engine.hpp"
#include "map/writer.hpp"

namespace leapmap::testing {

inline void sweep_into(MapWriter& writer, const Spec& spec, const MapLayout& layout, const Tiling& tiling,
                       const EngineOptions& options = {}) {
  run_sweep(spec, request_of(spec), tiling, options, [&] {
    const auto encoder = std::make_shared<TileEncoder>(layout, tiling);
    return TileWork{[encoder](const Tile&, std::size_t first, const Solved& solved) {
                      encoder->take(first, solved.outcomes,
                                    [&](const Field& field) { return solved.column(field); });
                    },
                    [&writer, encoder](std::size_t number, const Tile&) {
                      const auto encoded = std::make_shared<EncodedTile>(encoder->encode(number));
                      return Prepared{[&writer, encoded] { writer.write(*encoded); }, encoded->bytes()};
                    }};
  });
}

}  // namespace leapmap::testing
