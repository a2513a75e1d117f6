// SPDX-License-Identifier: GPL-3.0-or-later
/// A table of a study on disk: columns of numbers or texts along one dimension, `row`.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "map/hdf5.hpp"

namespace leapmap {

struct TableColumn {
  std::string name;
  std::string unit;  ///< as UDUNITS reads it; "1": a pure number, or a text
  std::string long_name;
  std::variant<std::vector<double>, std::vector<std::string>> values;
};

/// Writes the columns, all equally long, as a netCDF-readable HDF5 file, replacing path only once it is
/// whole. Throws InputError if path is a file of another type, IoError if it cannot be written.
void write_table(const std::string& path, const std::string& filetype, std::span<const TableColumn> columns,
                 std::span<const hdf5::Attribute> attributes);

}  // namespace leapmap
