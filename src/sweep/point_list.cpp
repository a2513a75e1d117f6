// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/point_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "leapmap/errors.hpp"
#include "support/posix.hpp"
#include "sweep/options.hpp"

namespace leapmap {
namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t start = 0;;) {
    const std::size_t comma = line.find(',', start);
    std::string_view cell = line.substr(start, comma == std::string_view::npos ? comma : comma - start);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    start = comma + 1;
  }
}

/// The option a column of the header stands for.
const Option* column_option(const std::string& place, std::string_view name,
                            const std::vector<const Option*>& before) {
  const auto parameters = design_parameters();
  const auto found = std::ranges::find(parameters, name, &Option::key);
  if (found == parameters.end()) {
    std::vector<std::string_view> keys;
    for (const Option* parameter : parameters) keys.push_back(parameter->key);
    throw InputError(fmt::format("{}: column '{}' is not a parameter of a design; allowed: {}", place, name,
                                 fmt::join(keys, ", ")));
  }
  if (std::ranges::find(before, *found) != before.end())
    throw InputError(fmt::format("{}: column '{}' is there twice; allowed: once", place, name));
  return *found;
}

}  // namespace

PointList read_points(const std::string& path, const std::string& origin) {
  TextFile file(path, fmt::format("a CSV file as design.points of {}", origin));
  PointList list;
  list.path = path;
  list.count = 0;
  std::vector<const Option*> columns;
  std::string line;
  for (long number = 1; file.next_line(line); ++number) {
    std::string_view text = line;
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.find_first_not_of(" \t") == std::string_view::npos) continue;
    const std::string place = fmt::format("{}:{}", path, number);
    if (columns.empty() && text.starts_with('#')) text.remove_prefix(1);  // numpy.savetxt's header
    const auto cells = split(text);
    if (columns.empty()) {
      for (const std::string_view name : cells) {
        columns.push_back(column_option(place, name, columns));
        list.columns.push_back({std::string(name), {}});
      }
      continue;
    }
    if (cells.size() != columns.size())
      throw InputError(fmt::format("{}: {} values; allowed: {}, one for each column of the header", place,
                                   cells.size(), columns.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      try {
        list.columns[i].values.push_back(parse_number(*columns[i], cells[i]));
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
