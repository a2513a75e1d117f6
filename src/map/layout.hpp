// SPDX-License-Identifier: GPL-3.0-or-later
/// What stands in a map before its first value: axes, columns, empty fields, and a NeXus group that tells
/// viewers what to plot.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "map/hdf5.hpp"
#include "map/tile.hpp"
#include "model/fields.hpp"

namespace leapmap {

/// A parameter as the map shows it: an axis (a dimension scale) or a column of a list of designs.
struct MapAxis {
  std::string name;
  std::string unit;
  std::string long_name;
  std::vector<double> values;
};

struct MapLayout {
  std::vector<MapAxis> axes;        ///< one dimension each; empty: a list, whose one dimension is `design`
  std::vector<MapAxis> columns;     ///< of a list: its parameters, along `design`
  std::vector<std::string> labels;  ///< of a list: a name of each design; empty: none
  std::vector<const Field*> fields;
  bool single = false;  ///< quantities as f4, not f8
  int compression = 0;  ///< deflate's level, after a shuffle of bytes; 0: none
};

inline constexpr const char* label_name = "label";  ///< the dataset of labels
inline constexpr std::size_t most_label_bytes = 200;

/// Whether a quantity is stored as f4: bounds that are proved would not hold once they are rounded.
bool is_single(const MapLayout& layout, const Field& field);

/// Bytes of one value of a field as stored: 1, 4 or 8.
std::size_t value_bytes(const MapLayout& layout, const Field& field);

/// What a field holds where nothing was computed, in the type stored.
const void* fill_value(const MapLayout& layout, const Field& field);

/// How many bytes the map's values take before compression.
std::uint64_t map_bytes(const MapLayout& layout, const Tiling& tiling);

/// Creates every dataset in an empty file and writes axes and columns. Returns the datasets of the fields, in
/// the layout's order. With sources these are virtual datasets made of them. Throws IoError.
std::vector<hdf5::Handle> lay_out(hid_t file, const MapLayout& layout, const Tiling& tiling,
                                  std::span<const hdf5::Source> sources = {});

/// Throws BrokenFile, naming path and what, unless axes, columns and descriptions in a file are those that
/// lay_out writes.
void check_layout(hid_t file, const MapLayout& layout, const Tiling& tiling, const std::string& path);

/// The datasets of the layout's fields, in its order. Throws IoError.
std::vector<hdf5::Handle> open_fields(hid_t file, const MapLayout& layout);

}  // namespace leapmap
