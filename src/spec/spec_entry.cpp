// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spec_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "spec/quantity.hpp"
#include "spec/spacing.hpp"

namespace leapmap {
namespace {

/// "key = value" as the user wrote it, on one line.
std::string quoted(const Entry& entry) {
  const toml::node& node = *entry.node;
  std::ostringstream text;
  if (node.is_floating_point())
    text << fmt::format("{}", *node.value<double>());  // as short as it was written
  else
    node.visit([&](const auto& value) { text << value; });
  std::string flat = text.str();
  std::ranges::replace(flat, '\n', ' ');
  return fmt::format("{} = {}", name_of(entry), flat);
}

}  // namespace

std::string name_of(const Entry& entry) {
  return entry.option->section == "hoop" ? entry.key : fmt::format("{}.{}", entry.option->section, entry.key);
}

void refuse(const Entry& entry, std::string_view what, std::string_view allowed) {
  throw InputError(fmt::format("{}: {}: {}; allowed: {}", entry.place, quoted(entry), what, allowed));
}

double to_number(const Entry& entry, const toml::node& node, std::string_view part) {
  const Option& option = *entry.option;
  const std::string where = part.empty() ? "" : fmt::format("'{}' ", part);
  if (const auto* text = node.as_string()) {
    try {
      return parse_number(option, text->get(), entry.scales);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}{}", entry.place, name_of(entry), where, error.what()));
    }
  }
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) refuse(entry, where + "is not a number", allowed_values(option));
  if (!in_range(option, *value))
    refuse(entry, where + "is out of range" + meant_degrees(option.range, option.unit, *value),
           allowed_values(option));
  return *value;
}

std::optional<double> to_si(const Entry& entry, const toml::node& node) {
  const OwnUnit* own = find_own_unit(entry.option->unit);
  const auto* text = node.as_string();
  if (!own || !text || own->size(entry.scales) > 0.0 || !(own->size(entry.nominal) > 0.0)) return {};
  try {
    return number_in_si(text->get(), *own);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}: {}; allowed: {}", entry.place, name_of(entry), error.what(),
                                 allowed_values(*entry.option)));
  }
}

namespace {

/// Counts the numbers of a value, or of an axis, a tolerance or a goal, that have a unit of the SI and that
/// have none.
void count_units(const OwnUnit& own, const toml::node& node, std::size_t& with, std::size_t& without) {
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      if (key != "count" && key != "scale" && key != "is") count_units(own, value, with, without);
  } else if (const auto* array = node.as_array()) {
    for (const toml::node& value : *array) count_units(own, value, with, without);
  } else if (const auto* text = node.as_string()) {
    try {
      ++(number_in_si(text->get(), own) ? with : without);
    } catch (const InputError&) {
      return;  // it is refused where it is read
    }
  } else {
    ++without;
  }
}

}  // namespace

bool has_unit(const Entry& entry) {
  const OwnUnit* own = find_own_unit(entry.option->unit);
  std::size_t with = 0, without = 0;
  if (own) count_units(*own, *entry.node, with, without);
  if (with > 0 && without > 0)
    refuse(entry, "has a unit at some of its numbers only", "a unit at all of them or at none");
  return with > 0;
}

std::optional<std::int64_t> to_whole(const toml::node& node) {
  if (node.is_integer()) return node.value<std::int64_t>();
  const auto value = node.is_floating_point() ? node.value<double>() : std::nullopt;
  if (!value || *value != std::floor(*value) || std::abs(*value) > 1e15) return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

namespace {

constexpr std::string_view axis_forms =
    "{ from, to, count, scale = \"linear\" | \"log\" }, { from, to, step } or { values = [...] }";

/// { values }.
std::vector<double> to_list(const Entry& entry, const toml::table& table) {
  const toml::array* array = table["values"].as_array();
  if (!array || array->empty()) refuse(entry, "'values' is not a list of numbers", axis_forms);
  if (array->size() > static_cast<std::size_t>(most_axis_values))
    refuse(entry, fmt::format("'values' are {} numbers", array->size()),
           fmt::format("up to {}", most_axis_values));
  std::vector<double> values;
  for (const toml::node& node : *array) values.push_back(to_number(entry, node, "values"));
  if (repeated(values)) refuse(entry, "a value appears twice", "each once");
  return values;
}

/// How many steps lead from one bound to the other.
std::size_t count_of_steps(const Entry& entry, const toml::table& table, double from, double to) {
  const double step = std::abs(to_number(entry, *table.get("step"), "step")),
               steps = std::abs(to - from) / step;
  // Bounds and step are rounded, so that a whole number of steps is one but for some roundings.
  if (!(steps >= 1.0 && std::abs(steps - std::round(steps)) < 1e-9 * steps))
    refuse(entry, fmt::format("'step' leads {} steps from 'from' to 'to'", steps),
           "a whole number of steps, or count instead of step");
  if (std::round(steps) >= most_axis_values)
    refuse(entry, "'step' is too small", fmt::format("up to {} values", most_axis_values));
  return static_cast<std::size_t>(std::round(steps)) + 1;
}

/// { from, to, count, scale }, { from, to, step } or, of a free axis, { from, to, scale }.
Spacing to_spacing(const Entry& entry, const toml::table& table) {
  const bool steps = table.contains("step");
  for (const std::string_view part : {"from", "to"})
    if (!table.contains(part)) refuse(entry, fmt::format("'{}' is missing", part), axis_forms);
  Spacing spacing{.from = to_number(entry, *table.get("from"), "from"),
                  .to = to_number(entry, *table.get("to"), "to"),
                  .count = 1};
  const double from = spacing.from, to = spacing.to;
  if (steps) {
    spacing.count = count_of_steps(entry, table, from, to);
    return spacing;
  }
  const std::string scale = table["scale"].value_or(std::string(table.contains("scale") ? "?" : "linear"));
  if (scale != "linear" && scale != "log") refuse(entry, "'scale' is unknown", "\"linear\" or \"log\"");
  spacing.log = scale == "log";
  if (spacing.log && !(from > 0.0 && to > 0.0))
    refuse(entry, "a log axis starts and ends above 0", "'from' and 'to' > 0");
  if (!table.contains("count")) {  // a free one: its bounds
    if (!(from < to)) refuse(entry, "'from' is not below 'to'", "two bounds, the smaller one first");
    spacing.count = 2;
    return spacing;
  }
  const auto count = to_whole(*table.get("count"));
  if (!count || *count < 1 || *count > most_axis_values)
    refuse(entry, "'count' is not a number of values",
           fmt::format("a whole number from 1 to {}", most_axis_values));
  if (*count > 1 && from == to)
    refuse(entry, "'from' and 'to' are the same", "two different bounds, or count = 1");
  if (*count == 1 && from != to) refuse(entry, "'count' is 1", "2 or more, or 'from' equal to 'to'");
  spacing.count = static_cast<std::size_t>(*count);
  return spacing;
}

}  // namespace

Axis to_axis(const Entry& entry, const toml::table& table) {
  using Names = std::vector<std::string_view>;
  const Names names = table.contains("values") ? Names{"values"}
                      : table.contains("step") ? Names{"from", "to", "step"}
                                               : Names{"from", "to", "count", "scale"};
  for (const auto& [key, node] : table)
    if (std::ranges::find(names, key.str()) == names.end())
      refuse(entry, fmt::format("'{}' does not belong to this axis", key.str()), axis_forms);
  Axis axis{entry.key, {}};
  if (table.contains("values")) {
    axis.values = to_list(entry, table);
    return axis;
  }
  const Spacing spacing = to_spacing(entry, table);
  axis.values = values_of(spacing);
  axis.free = !table.contains("step") && !table.contains("count");
  axis.spaced = !axis.free;
  axis.log = spacing.log;
  return axis;
}

}  // namespace leapmap
