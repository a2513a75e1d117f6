// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/point_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "leapmap/errors.hpp"
#include "map/layout.hpp"
#include "model/variable.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"
#include "spec/spec_hoop.hpp"
#include "support/closest.hpp"
#include "support/csv.hpp"

namespace leapmap {
namespace {

/// The option a column of the header stands for.
const Option* column_option(const std::string& place, std::string_view name) {
  if (find_body_number(name)) return find_option("hoop", name);
  const auto parameters = design_parameters();
  const auto found = std::ranges::find(parameters, name, &Option::key);
  if (found == parameters.end()) {
    std::vector<std::string_view> keys;
    for (const Option* parameter : parameters) keys.push_back(parameter->key);
    throw InputError(
        fmt::format("{}: column '{}' is not a parameter of a design{}; allowed: {}, {}, and with "
                    "[hoop] its numbers, for example hoop.mass",
                    place, name, did_you_mean(name, keys), label_name, fmt::join(keys, ", ")));
  }
  return *found;
}

/// "slope [deg]" as "slope" and "deg".
std::pair<std::string, std::string> name_and_unit(const std::string& header) {
  const std::size_t open = header.find('[');
  if (open == header.npos || !header.ends_with(']')) return {header, ""};
  const std::size_t end = header.find_last_not_of(' ', open - (open > 0 ? 1 : 0));
  return {header.substr(0, open == 0 || end == header.npos ? 0 : end + 1),
          header.substr(open + 1, header.size() - open - 2)};
}

/// Whether hoops have a parameter in the SI, whatever their mass and size.
bool is_in_si(const Option& option, const std::string& text) {
  const auto* slot = std::get_if<ParameterSlot>(&option.slot);
  return slot && may_be_held(slot->member) && number_in_si(text, *find_own_unit(option.unit));
}

}  // namespace

PointList read_points(const std::string& path, const std::string& origin, Scales scales,
                      const std::optional<Scales>& nominal, std::vector<std::string>& in_si) {
  CsvFile file(path, fmt::format("a CSV file as design.points of {}", origin));
  PointList list;
  list.path = path;
  list.count = 0;
  std::vector<const Option*> columns;         // null: the labels
  std::vector<std::optional<bool>> are_held;  // as the first line has them
  std::vector<std::string> units;
  for (const std::string& text : file.header()) {
    if (file.header().size() == 1 && text.find(';') != text.npos)
      throw InputError(
          fmt::format("{}: has semicolons between its columns; allowed: commas, and points in "
                      "numbers",
                      file.place()));
    const auto [name, unit] = name_and_unit(text);
    columns.push_back(text == label_name ? nullptr : column_option(file.place(), name));
    units.push_back(unit.empty() ? "" : " " + unit);
    if (columns.back()) list.columns.push_back({name, {}});
    if (is_body_mass(name)) scales.mass = 0.0;  // each design has its own
    if (name == "hoop.diameter") scales.radius = std::numeric_limits<double>::quiet_NaN();
  }
  if (!columns.empty() && list.columns.empty())
    throw InputError(file.place() + ": no column is a parameter of a design; allowed: at least one");
  are_held.resize(columns.size());
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
        const std::string text = cells[i] + units[i];
        const bool held = nominal && is_in_si(*columns[i], text);
        if (are_held[i].value_or(held) != held)
          throw InputError(
              fmt::format("'{}' has {} unit, unlike the lines above; allowed: a unit in all "
                          "lines or in none, best in the header",
                          text, held ? "a" : "no"));
        are_held[i] = held;
        if (held && std::ranges::find(in_si, column->key) == in_si.end()) in_si.push_back(column->key);
        column->values.push_back(parse_number(*columns[i], text, held ? *nominal : scales));
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: column {} = {}", place, column->key, error.what()));
      }
      ++column;
    }
    ++list.count;
  }
  if (list.count == 0)
    throw InputError(fmt::format("{}: no designs; allowed: a header and at least one line", path));
  return list;
}

}  // namespace leapmap
