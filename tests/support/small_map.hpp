// SPDX-License-Identifier: GPL-3.0-or-later
/// A map of 3 x 5 designs whose outcomes carry their numbers.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "map/schema.hpp"
#include "map/writer.hpp"

namespace leapmap::testing {

inline MapLayout small_layout() {
  MapLayout layout;
  layout.axes = {{"slope", "rad", "slope of the plane", {0.1, 0.2, 0.3}},
                 {"mass_ratio", "1", "mass ratio", {1, 2, 3, 4, 5}}};
  for (const Field& field : map_fields()) layout.fields.push_back(&field);
  layout.compression = 1;
  return layout;
}

inline const std::vector<hdf5::Attribute> small_attributes{
    {"filetype", std::string(map_filetype)},
    {"version", std::vector<std::int32_t>{format_major, format_minor}},
    {"title", std::string("täst")}};

inline Outcome numbered(std::size_t number) {
  Outcome outcome;
  outcome.status = number % 2 ? Status::jumped : Status::no_jump;
  outcome.candidates = static_cast<std::uint8_t>(number);
  outcome.jump_height = static_cast<double>(number) + 0.25;
  outcome.jump_time = static_cast<double>(number);
  return outcome;
}

/// A tile whose outcomes are these.
inline EncodedTile encoded(const MapLayout& layout, const Tiling& tiling, std::size_t number,
                           const std::vector<Outcome>& outcomes) {
  TileEncoder encoder(layout, tiling);
  encoder.take(0, outcomes);
  return encoder.encode(number);
}

/// A tile of any map whose outcomes carry their numbers, as the layout stores it.
inline EncodedTile numbered_tile(const MapLayout& layout, const Tiling& tiling, std::size_t number) {
  const Tile tile = tiling.tile(number);
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < tile.count; ++i) outcomes.push_back(numbered(tiling.number(tile, i)));
  return encoded(layout, tiling, number, outcomes);
}

/// Writes what is missing; calls after_each after each tile.
inline void write_rest(MapWriter& writer, const MapLayout& layout, const Tiling& tiling,
                       const std::function<void()>& after_each = {}) {
  while (writer.progress().tiles < tiling.size()) {
    writer.write(numbered_tile(layout, tiling, writer.progress().tiles));
    if (after_each) after_each();
  }
}

}  // namespace leapmap::testing
