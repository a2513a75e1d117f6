// SPDX-License-Identifier: GPL-3.0-or-later
/// The sections [scatter] and [goal] of a spec: hoops as made, and what they must do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/fields.hpp"
#include "spec/spec_entry.hpp"
#include "support/number.hpp"

namespace leapmap {
namespace {

constexpr std::string_view spread_forms =
    "{ normal = WIDTH } or { uniform = WIDTH }, its standard deviation or half width";
constexpr std::string_view goal_forms = "{ at_least = ... }, { at_most = ... }, both, or { is = ... }";

/// "2 %" as 2; nothing if that is not its form.
std::optional<double> to_percent(const toml::node& node) {
  const auto* text = node.as_string();
  if (!text || !text->get().ends_with('%')) return std::nullopt;
  std::string_view digits = text->get();
  digits.remove_suffix(1);
  return number_in(digits);
}

/// A phase_sequence by its letters, for example "RSF".
std::optional<double> to_phases(std::string_view letters) {
  constexpr std::size_t most_phases = 26;  // beyond, not every sequence is a number of its own
  constexpr std::string_view phases = "RSF";
  if (letters.empty() || letters.size() > most_phases) return std::nullopt;
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const auto phase = phases.find(letters[i]);
    if (phase == phases.npos) return std::nullopt;
    word |= std::uint64_t{phase + 1} << 2 * i;
  }
  return static_cast<double>(word);
}

/// What a goal compares a field with: a number, or the name of a code.
double to_bound(const Entry& entry, const Field& field, const toml::node& node, std::string_view part) {
  const auto* text = node.as_string();
  const auto* code = std::get_if<Code>(&field.source);
  if (text && code && !code->names.empty()) {
    const auto name = std::find(code->names.begin(), code->names.end(), text->get());
    if (name == code->names.end())
      refuse(entry, fmt::format("'{}' is unknown", text->get()),
             fmt::format("one of {}", fmt::join(code->names, ", ")));
    return static_cast<double>(name - code->names.begin());
  }
  if (code && !code->names.empty() && part != "is")
    refuse(entry, fmt::format("'{}' does not belong to this goal", part),
           fmt::format("{{ is = ... }} with one of {}", fmt::join(code->names, ", ")));
  if (std::holds_alternative<Word>(field.source)) {
    const auto phases = text ? to_phases(text->get()) : std::nullopt;
    if (!phases || part != "is")
      refuse(entry, "is not a sequence of phases", "for example { is = \"RSF\" }, up to 26 letters");
    return *phases;
  }
  return to_number(entry, node, part);
}

/// Goal::unit_of_nominal: not 0 if the limits have a unit of the SI, and each hoop has its own of leapmap's.
double unit_of_nominal(const Entry& entry, const Field& field, const toml::table& goal) {
  if (!std::holds_alternative<Quantity>(field.source)) return 0.0;
  std::size_t in_si = 0;
  for (const auto& [part, node] : goal) in_si += to_si(entry, node).has_value();
  if (in_si == 0) return 0.0;
  if (in_si < goal.size())
    refuse(entry, "has one limit in a unit of the SI, which differs from hoop to hoop, and one in leapmap's",
           "both in the same");
  return find_own_unit(entry.option->unit)->size(entry.nominal);
}

}  // namespace

Spread to_spread(const Entry& entry) {
  const toml::table* table = entry.node->as_table();
  if (!table || table->size() != 1) refuse(entry, "is not a tolerance", spread_forms);
  const auto only = table->cbegin();
  const std::string_view law = only->first.str();
  const toml::node& node = only->second;
  if (law != "normal" && law != "uniform") refuse(entry, fmt::format("'{}' is unknown", law), spread_forms);
  Spread spread{.parameter = entry.key, .law = law == "normal" ? Spread::Law::normal : Spread::Law::uniform};
  const auto percent = to_percent(node);
  spread.percent = percent.has_value();
  if (!percent && node.is_string() && !find_own_unit(entry.option->unit))
    refuse(entry, fmt::format("'{}' is not a width", law),
           fmt::format("{}, or as \"2 %\"", allowed_values(*entry.option)));
  spread.width = percent ? *percent : to_number(entry, node, law);
  if (!in_range(*entry.option, spread.width))
    refuse(entry, fmt::format("'{}' is out of range", law),
           fmt::format("{}, or as \"2 %\"", allowed_values(*entry.option)));
  return spread;
}

Goal to_goal(const Entry& entry) {
  const Field& field = *find_field(entry.option->key);
  const toml::table* table = entry.node->as_table();
  if (!table || table->empty()) refuse(entry, "is not a goal", goal_forms);
  Goal goal{.field = std::string(field.name), .unit_of_nominal = unit_of_nominal(entry, field, *table)};
  for (const auto& [part, node] : *table) {
    if (part != "at_least" && part != "at_most" && !(part == "is" && table->size() == 1))
      refuse(entry, fmt::format("'{}' does not belong to this goal", part.str()), goal_forms);
    const double bound =
        goal.unit_of_nominal > 0.0 ? *to_si(entry, node) : to_bound(entry, field, node, part.str());
    if (part != "at_most") goal.at_least = bound;
    if (part != "at_least") goal.at_most = bound;
  }
  if (goal.at_least > goal.at_most) refuse(entry, "contradicts itself", "'at_least' not above 'at_most'");
  return goal;
}

}  // namespace leapmap
