// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/point_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "leapmap/errors.hpp"
#include "map/layout.hpp"
#include "support/posix.hpp"
#include "sweep/options.hpp"

namespace leapmap {
namespace {

/// The cells of a line, after RFC 4180: a quoted one may hold commas, and quotes written twice.
std::vector<std::string> split(std::string_view line, const std::string& place) {
  std::vector<std::string> cells;
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  for (;;) {
    std::string cell;
    skip_blanks();
    if (line.starts_with('"')) {
      for (bool inside = true; inside;) {
        line.remove_prefix(1);
        const std::size_t quote = line.find('"');
        if (quote == std::string_view::npos)
          throw InputError(place + ": a quote without an end; allowed: cells that end on their line");
        cell += line.substr(0, quote);
        line.remove_prefix(quote + 1);
        inside = line.starts_with('"');
        if (inside) cell += '"';
      }
      skip_blanks();
      if (!line.empty() && line.front() != ',')
        throw InputError(place + ": text after a quoted cell; allowed: a comma, or the end of the line");
    } else {
      cell = line.substr(0, line.find(','));
      cell.erase(cell.find_last_not_of(" \t") + 1);
      line.remove_prefix(std::min(line.find(','), line.size()));
    }
    cells.push_back(std::move(cell));
    if (line.empty()) return cells;
    line.remove_prefix(1);
  }
}

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
  TextFile file(path, fmt::format("a CSV file as design.points of {}", origin));
  PointList list;
  list.path = path;
  list.count = 0;
  std::vector<const Option*> columns;  // null: the labels
  std::string line;
  for (long number = 1; file.next_line(line); ++number) {
    std::string_view text = line;
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.find_first_not_of(" \t") == std::string_view::npos) continue;
    const std::string place = fmt::format("{}:{}", path, number);
    if (columns.empty() && text.starts_with('#')) text.remove_prefix(1);  // numpy.savetxt's header
    const auto cells = split(text, place);
    if (columns.empty()) {
      for (const std::string& name : cells) {
        const bool twice = std::ranges::count(cells, name) > 1;
        if (twice)
          throw InputError(fmt::format("{}: column '{}' is there twice; allowed: once", place, name));
        columns.push_back(name == label_name ? nullptr : column_option(place, name));
        if (columns.back()) list.columns.push_back({name, {}});
      }
      if (list.columns.empty())
        throw InputError(place + ": no column is a parameter of a design; allowed: at least one");
      continue;
    }
    if (cells.size() != columns.size())
      throw InputError(fmt::format("{}: {} values; allowed: {}, one for each column of the header", place,
                                   cells.size(), columns.size()));
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
