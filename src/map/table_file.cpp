// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/table_file.hpp"

#include <numeric>

#include "map/hdf5_driver.hpp"

namespace leapmap {

void write_table(const std::string& path, const std::string& filetype, std::span<const TableColumn> columns,
                 std::span<const hdf5::Attribute> attributes) {
  hdf5::refuse_other_file(path, filetype);
  const std::string part = path + ".part";
  hdf5::File file = hdf5::File::create(part);
  try {
    hdf5::annotate(file, attributes);
    std::vector<double> numbers(
        std::visit([](const auto& values) { return values.size(); }, columns.front().values));
    std::iota(numbers.begin(), numbers.end(), 0.0);
    const hdf5::Handle rows = hdf5::write_series(file, "row", "1", "number of the row, from 0",
                                                 std::span<const double>(numbers), nullptr);
    for (const TableColumn& column : columns)
      std::visit(
          [&](const auto& values) {
            hdf5::write_series(file, column.name, column.unit, column.long_name, std::span(values), &rows);
          },
          column.values);
    file.finish(path);
  } catch (...) {
    file.discard();
    throw;
  }
}

}  // namespace leapmap
