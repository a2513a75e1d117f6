// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables on disk, as the studies and a traced motion make them: columns along one dimension.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "map/hdf5.hpp"
#include "map/journaled_file.hpp"

namespace leapmap {

struct TableColumn {
  std::string name;
  std::string unit;  ///< as UDUNITS reads it; "1": a pure number, or a text
  std::string long_name;
  hdf5::SeriesValues values;
};

/// Columns, all equally long, along the first one, which is their dimension.
using Table = std::vector<TableColumn>;

/// The dimension of a table whose rows have nothing but a number.
TableColumn numbered_rows(std::size_t count);

/// Before the work that fills tables: throws InputError if what has that name is of another type, IoError if
/// no file can be made there.
void refuse_taken(const std::string& path, std::string_view filetype, Locking locking);

/// Writes the tables as a netCDF-readable HDF5 file, replacing path only once it is whole and was read again.
/// Returns false if a power cut may undo that (JournaledFile::rename). Throws InputError if path is a file of
/// another type, IoError if it cannot be written.
[[nodiscard]] bool write_tables(const std::string& path, const std::string& filetype,
                                std::span<const Table> tables, std::span<const hdf5::Attribute> attributes,
                                Locking locking);

}  // namespace leapmap
