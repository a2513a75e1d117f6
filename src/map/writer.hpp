// SPDX-License-Identifier: GPL-3.0-or-later
/// Writes a map tile by tile. Until it is whole it is called FILE.part; FILE itself is only ever a whole map.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "map/hdf5.hpp"
#include "map/schema.hpp"
#include "map/tile.hpp"
#include "trajectory/outcome.hpp"

namespace leapmap {

/// A parameter as the map shows it: an axis (a dimension scale) or a column of a list of designs.
struct MapAxis {
  std::string name;
  std::string unit;
  std::string long_name;
  std::vector<double> values;
};

struct MapLayout {
  std::vector<MapAxis> axes;     ///< one dimension each; empty: a list, whose one dimension is `design`
  std::vector<MapAxis> columns;  ///< of a list: its parameters, along `design`
  std::vector<const Field*> fields;
  double time_unit = 1.0;  ///< sqrt(R/g) [s]
  bool single = false;     ///< quantities as f4, not f8
};

class MapWriter {
 public:
  /// Creates FILE.part and everything in it but the values. Refuses (InputError) to replace FILE or FILE.part
  /// unless overwrite is set; throws IoError if it cannot be written.
  MapWriter(const std::string& path, const MapLayout& layout, const Tiling& tiling,
            std::span<const hdf5::Attribute> attributes, bool overwrite);
  /// Without finish or keep_part before it: removes what was written.
  ~MapWriter();
  MapWriter(const MapWriter&) = delete;
  MapWriter& operator=(const MapWriter&) = delete;

  /// Stores a tile's outcomes, in the tile's order. Not for two threads at once.
  void write(const Tile& tile, std::span<const Outcome> outcomes);
  /// Brings what was written so far to the file; throws IoError if the disk is full.
  void flush();
  /// Adds closing attributes, brings everything to disk and gives the file its name.
  void finish(std::span<const hdf5::Attribute> attributes);
  /// Closes the unfinished file and leaves it as FILE.part, whose name is returned.
  std::string keep_part();

 private:
  void close_datasets();

  std::string path_, part_;
  hdf5::Handle file_;
  std::vector<const Field*> fields_;
  std::vector<hdf5::Handle> datasets_;
  double time_unit_;
  bool settled_ = false;
  std::vector<double> quantities_;
  std::vector<std::uint8_t> codes_;
};

/// How many bytes the map's values take.
std::uint64_t map_bytes(const MapLayout& layout, const Tiling& tiling);

}  // namespace leapmap
