// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads a map: its axes, attributes and fields, a block at a time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "map/hdf5.hpp"
#include "map/tile.hpp"

namespace leapmap {

class MapReader {
 public:
  /// Opens a map (or the .part of one). Throws IoError if it is no leapmap map, or of a newer major version.
  explicit MapReader(const std::string& path);

  /// A dimension: its name, unit and values.
  struct Dimension {
    std::string name, unit;
    std::vector<double> values;
  };
  const std::vector<Dimension>& dimensions() const { return dimensions_; }
  std::vector<std::size_t> shape() const;

  /// The datasets that lie along all dimensions, in file order: the fields and, in a list, its parameters.
  const std::vector<std::string>& fields() const { return fields_; }
  std::string unit(const std::string& field) const;

  /// A root attribute as text, numbers in their shortest form; empty if it is not there.
  std::string attribute(const std::string& name) const;

  /// A block of a field, C order; codes as numbers.
  std::vector<double> read(const std::string& field, const Tile& block) const;

 private:
  hdf5::Handle open(const std::string& dataset) const;

  std::string path_;
  hdf5::Handle file_;
  std::vector<Dimension> dimensions_;
  std::vector<std::string> fields_;
};

}  // namespace leapmap
