// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/point_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "leapmap/errors.hpp"
#include "map/layout.hpp"
#include "spec/options.hpp"
#include "support/csv.hpp"

namespace leapmap {
namespace {

/// The option a column of the header stands for.
const Option* column_option(const std::string& place, std::string_view name) {
  const auto parameters = design_parameters();
  const auto found = std::ranges::find(parameters, name, &Option::key);
  if (found == parameters.end()) {
    std::vector<std::string_view> keys;
    for (const Option* parameter : parameters) keys.push_back(parameter->key);
    throw InputError(fmt::format("{}: column '{}' is not a parameter of a design; allowed: {}, {}", place,
                                 name, label_name, fmt::join(keys, ", ")));
  }
  return *found;
}

}  // namespace

PointList read_points(const std::string& path, const std::string& origin) {
  CsvFile file(path, fmt::format("a CSV file as design.points of {}", origin));
  PointList list;
  list.path = path;
  list.count = 0;
  std::vector<const Option*> columns;  // null: the labels
  for (const std::string& name : file.header()) {
    columns.push_back(name == label_name ? nullptr : column_option(file.place(), name));
    if (columns.back()) list.columns.push_back({name, {}});
  }
  if (!columns.empty() && list.columns.empty())
    throw InputError(file.place() + ": no column is a parameter of a design; allowed: at least one");
  std::vector<std::string> cells;
  while (file.next(cells)) {
    const std::string& place = file.place();
    auto column = list.columns.begin();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!columns[i]) {
        list.labels.push_back(cells[i]);
        continue;
      }
      try {
        (column++)->values.push_back(parse_number(*columns[i], cells[i]));
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: column {} = {}", place, columns[i]->key, error.what()));
      }
    }
    ++list.count;
  }
  if (list.count == 0)
    throw InputError(fmt::format("{}: no designs; allowed: a header and at least one line", path));
  return list;
}

}  // namespace leapmap
