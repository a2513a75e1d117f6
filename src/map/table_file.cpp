// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/table_file.hpp"

#include <cassert>
#include <numeric>

#include "leapmap/errors.hpp"
#include "map/hdf5_driver.hpp"
#include "support/output_file.hpp"

namespace leapmap {
namespace {

void write_table(hid_t file, const Table& table) {
  hdf5::Handle rows;
  for (const TableColumn& column : table) {
    assert(hdf5::size_of(column.values) == hdf5::size_of(table.front().values));
    const bool first = &column == &table.front();
    hdf5::Handle written = hdf5::write_series(file, column.name, column.unit, column.long_name, column.values,
                                              first ? nullptr : &rows);
    first ? void(rows = std::move(written)) : written.close("writing " + column.name);
  }
  rows.close("writing " + table.front().name);
}

}  // namespace

TableColumn numbered_rows(std::size_t count) {
  std::vector<double> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.0);
  return {"row", "1", "number of the row, from 0", numbers};
}

void refuse_taken(const std::string& path, std::string_view filetype, Locking locking) {
  const std::string file = behind_links(path);
  hdf5::refuse_other_file(file, filetype, locking);
  refuse_unwritable(file);
}

bool write_tables(const std::string& path, const std::string& filetype, std::span<const Table> tables,
                  std::span<const hdf5::Attribute> attributes, Locking locking) {
  hdf5::refuse_other_file(path, filetype, locking);
  const std::string part = path + ".part";
  hdf5::File file = hdf5::File::create(part, filetype, locking);
  try {
    hdf5::annotate(file, attributes);
    for (const Table& table : tables) write_table(file, table);
    return file.finish(path, true, [&](hid_t written) {
      for (const Table& table : tables)
        for (const TableColumn& column : table)
          if (!hdf5::holds(written, column.name, column.values))
            throw BrokenFile(part + ": " + column.name + " differs from what was written");
    });
  } catch (...) {
    file.discard();
    throw;
  }
}

}  // namespace leapmap
