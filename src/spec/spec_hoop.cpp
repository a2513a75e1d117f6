// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spec_hoop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "hoop/body.hpp"
#include "leapmap/errors.hpp"
#include "model/variable.hpp"
#include "spec/designs.hpp"
#include "support/closest.hpp"
#include "support/number.hpp"
#include "support/wrapped.hpp"

namespace leapmap {
namespace {

std::vector<std::string_view> names_of(bool of_weight) {
  std::vector<std::string_view> names;
  for (const BodyNumber& row : body_numbers())
    if (row.of_weight() == of_weight) names.push_back(row.name);
  return names;
}

[[noreturn]] void refuse(const std::string& place, const std::string& key, const std::string& what,
                         const std::string& allowed) {
  throw InputError(
      fmt::format("{}: {}: {}; allowed: {}", place, key.empty() ? "[hoop]" : "hoop." + key, what, allowed));
}

[[noreturn]] void refuse_unknown(const std::string& place, const std::string& key, std::string_view name,
                                 std::span<const std::string_view> names) {
  refuse(place, key, "unknown key" + did_you_mean(name, names), fmt::format("{}", fmt::join(names, ", ")));
}

std::string line_of(const std::string& origin, const toml::node& node) {
  return fmt::format("{}:{}", origin, node.source().begin.line);
}

Entry entry_of(const std::string& key, const std::string& place, const toml::node& node) {
  return {.option = find_option("hoop", key),
          .place = place,
          .position = node.source().begin,
          .node = &node,
          .key = key};
}

/// Adds the numbers of a table of the section, `of` being "" or "slug.". extra: its key that is no number.
void add_numbers(const toml::table& table, const std::string& of, std::string_view extra,
                 const std::string& origin, std::vector<Entry>& entries) {
  const bool of_weight = !of.empty();
  for (const auto& [key, node] : table) {
    if (key.str() == extra) continue;
    const std::string name = of + std::string(key.str());
    std::vector<std::string_view> names = names_of(of_weight);
    if (std::ranges::find(names, key.str()) == names.end()) {
      names.push_back(extra);
      refuse_unknown(line_of(origin, node), name, key.str(), names);
    }
    entries.push_back(entry_of("hoop." + name, line_of(origin, node), node));
  }
  for (const BodyNumber& row : body_numbers())
    if (row.needed && row.of_weight() == of_weight && !table.contains(row.name))
      refuse(line_of(origin, table), of_weight ? of.substr(0, of.size() - 1) : std::string(row.name),
             of_weight ? fmt::format("'{}' is missing", row.name) : "is missing",
             fmt::format("{} = \"... {}\"", row.name, find_own_unit(row.unit)->example));
}

std::string name_of_weight(const toml::table& table, const std::string& origin) {
  const auto* name = table["name"].as_string();
  if (!name || name->get().empty() || name->get().find_first_of(".=[] \t\n\"'") != std::string::npos)
    refuse(line_of(origin, table), "weight",
           name ? "the name '" + name->get() + "' cannot be part of a key" : "'name' is missing",
           "a name of letters, digits, - and _, for example name = \"slug\"");
  std::vector<std::string_view> taken = names_of(false);
  taken.push_back("weight");
  if (std::ranges::find(taken, name->get()) != taken.end())
    refuse(line_of(origin, table), "weight", fmt::format("the name '{}' is a key of [hoop]", name->get()),
           "a name of its own, for example name = \"slug\"");
  return name->get();
}

[[noreturn]] void refuse_weights(const std::string& place, const Body& body, const std::string& key,
                                 const std::string& name) {
  std::vector<std::string_view> names;
  for (const Weight& each : body.weights) names.push_back(each.name);
  refuse(place, key, fmt::format("no weight has the name '{}'{}", name, did_you_mean(name, names)),
         names.empty() ? "weights, by [[hoop.weight]] in a spec" : fmt::format("{}", fmt::join(names, ", ")));
}

/// That an axis or a column is of a number that the body has, in its range.
void check_axis(const Spec& spec, const Axis& axis) {
  if (!find_body_number(axis.key)) return;
  if (!spec.hoop)
    throw InputError(
        fmt::format("{}: {}: there is no [hoop]; allowed: with [hoop] in the spec, as in sweeps/drawing.toml",
                    origin_of(spec), axis.key));
  const auto variable = find_variable(axis.key, &*spec.hoop);
  if (!variable) check_hoop_key(*spec.hoop, axis.key, origin_of(spec));
  for (const double value : axis.values)
    if (!variable->range.holds(value))
      throw InputError(fmt::format("{}: {} = {} is out of range; allowed: {}", origin_of(spec), axis.key,
                                   value, allowed_values(variable->range, variable->unit)));
}

/// The least and the largest of a number over all designs.
std::pair<double, double> bounds_of(const Spec& spec, const std::string& key, double nominal) {
  const Axis* axis = find_varying(spec, key);
  if (!axis) return {nominal, nominal};
  const auto [least, most] = std::ranges::minmax(axis->values);
  return {least, most};
}

/// That no ratio of any design is beyond what a design may have; weights count as if they were on the rim.
void check_ratios(const Spec& spec) {
  const Body& body = *spec.hoop;
  const double radius = 0.5 * bounds_of(spec, "hoop.diameter", body.diameter).first, square = radius * radius;
  double weights = 0.0,
         inertia = std::isnan(body.inertia) ? 0.0 : bounds_of(spec, "hoop.inertia", body.inertia).second;
  for (const Weight& weight : body.weights) {
    const std::string of = "hoop." + weight.name;
    const double mass = bounds_of(spec, of + ".mass", weight.mass).second;
    const double at = bounds_of(spec, of + ".at", weight.at).second;
    if (at > radius)
      throw InputError(fmt::format("{}: {}.at = {} is beyond the rim of the smallest hoop; allowed: up to {}",
                                   origin_of(spec), of, at, radius));
    weights += mass, inertia += mass * square + bounds_of(spec, of + ".inertia", weight.inertia).second;
  }
  const double ring = bounds_of(spec, "hoop.mass", body.mass).first;
  constexpr double most_ratio = 1e12;  // as of a design
  if (weights > most_ratio * ring || inertia > most_ratio * ring * square)
    throw InputError(
        fmt::format("{}: hoop.mass = {} is a trillionth of the weights' masses, or of the inertia "
                    "over R^2, or less; allowed: more",
                    origin_of(spec), ring));
}

}  // namespace

void check_hoop_key(const Body& body, const std::string& key, const std::string& place) {
  const std::string of_hoop = key.substr(std::string_view("hoop.").size());
  const std::size_t dot = of_hoop.find('.');
  if (dot == std::string::npos) {
    if (!find_body_number(key)) refuse_unknown(place, of_hoop, of_hoop, names_of(false));
    return;
  }
  const std::string weight = of_hoop.substr(0, dot);
  if (std::ranges::find(body.weights, weight, &Weight::name) == body.weights.end())
    refuse_weights(place, body, of_hoop, weight);
  if (!find_body_number(key)) refuse_unknown(place, of_hoop, of_hoop.substr(dot + 1), names_of(true));
}

Body read_hoop(const toml::node& section, const std::string& origin, std::vector<Entry>& entries) {
  const toml::table* table = section.as_table();
  if (!table) refuse(line_of(origin, section), "", "is no section", "[hoop] above its keys");
  add_numbers(*table, "", "weight", origin, entries);
  Body body;
  const toml::node* weights = table->get("weight");
  if (!weights) return body;
  const toml::array* list = weights->as_array();
  if (!list || (!list->empty() && !list->is_array_of_tables()))
    refuse(line_of(origin, *weights), "weight", "is no list of weights",
           "[[hoop.weight]] above the keys of each");
  for (const toml::node& one : *list) {
    body.weights.push_back({.name = name_of_weight(*one.as_table(), origin)});
    add_numbers(*one.as_table(), body.weights.back().name + ".", "name", origin, entries);
  }
  return body;
}

Entry hoop_override(const Body& body, const std::string& key, const toml::node& value) {
  check_hoop_key(body, key, command_line);
  Entry entry = entry_of(key, command_line, value);
  entry.position = {};
  return entry;
}

void assign_to_hoop(const Entry& entry, Spec& spec) {
  Body& body = *spec.hoop;
  if (const toml::table* table = entry.node->as_table()) {
    spec.axes.push_back(to_axis(entry, *table));
    find_variable(entry.key, &body)->in(spec.design, body) = spec.axes.back().values.front();
  } else {
    find_variable(entry.key, &body)->in(spec.design, body) = to_number(entry, *entry.node);
  }
}

void check_hoop(const Spec& spec) {
  for (const auto* varying : {&spec.axes, &spec.list.columns})
    for (const Axis& axis : *varying) check_axis(spec, axis);
  if (!spec.hoop) return;
  try {
    static_cast<void>(reduce_body(*spec.hoop));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", origin_of(spec), error.what()));
  }
  check_ratios(spec);
}

namespace {

/// What is doubtful about one hoop, in words; empty: nothing.
std::string doubt_of(const Body& body) {
  const double radius = 0.5 * body.diameter, square = radius * radius;
  constexpr double osmium = 22'600.0;  // kg m-3
  const double sphere = osmium * 4.0 / 3.0 * std::numbers::pi * square * radius;
  if (const double mass = reduce_checked(body).total_mass; mass > sphere)
    return fmt::format(
        "{:.4g} kg in a hoop of {:.4g} m is more than a sphere of osmium of that diameter; "
        "grams are written \"... g\"",
        mass, body.diameter);
  constexpr double rounding = 1e-6;  // of what a drawing states
  if (body.inertia > (1.0 + rounding) * body.mass * square)
    return fmt::format(
        "inertia = {:.4g} kg m2 is larger than that of a thin ring of its mass and diameter, "
        "{:.4g} kg m2",
        body.inertia, body.mass * square);
  return {};
}

}  // namespace

std::vector<std::string> doubts_of_hoop(const Spec& spec) {
  const auto note = [&](const std::string& where, const std::string& doubt) {
    return std::vector{fmt::format("{}: [hoop]{}: {}", origin_of(spec), where, doubt)};
  };
  std::vector<const Axis*> varying;
  for (const Axis& axis : spec.axes)
    if (find_body_number(axis.key)) varying.push_back(&axis);
  if (varying.empty()) {
    const std::string doubt = doubt_of(*spec.hoop);
    return doubt.empty() ? std::vector<std::string>{} : note("", doubt);
  }
  for (const Axis* axis : varying)
    for (const double value : {std::ranges::min(axis->values), std::ranges::max(axis->values)}) {
      Body body = *spec.hoop;
      Design unused;
      find_variable(axis->key, &body)->in(unused, body) = value;
      if (const std::string doubt = doubt_of(body); !doubt.empty())
        return note(fmt::format(" at {} = {:.4g}", axis->key, value), doubt);
    }
  return {};
}

Scales common_scales(const Spec& spec) {
  Scales scales = scales_of(spec.scene);
  if (mass_varies(spec)) scales.mass = 0.0;
  if (find_varying(spec, "hoop.diameter")) scales.radius = std::numeric_limits<double>::quiet_NaN();
  return scales;
}

Scales nominal_scales(const Spec& spec) {
  Scales scales = scales_of(spec.scene);
  if (spec.hoop) scales.mass = reduce_checked(*spec.hoop).total_mass;
  return scales;
}

Scales scales_of(const Spec& spec, const Design& design) {
  const Scales nominal = nominal_scales(spec);
  return {nominal.radius * design.size, nominal.gravity, nominal.mass * design.mass};
}

Scales scales_of_manufactured(const Spec& spec, Scales scales) {
  for (const Spread& spread : spec.scatter.spreads) {
    if (is_body_mass(spread.parameter)) scales.mass = 0.0;
    if (spread.parameter == "hoop.diameter") scales.radius = std::numeric_limits<double>::quiet_NaN();
  }
  return scales;
}

bool may_be_held(double Design::*parameter) {
  return std::ranges::find(same_in_si, parameter, &SameInSi::parameter) != same_in_si.end();
}

void hold(const std::string& parameter, Spec& spec) {
  if (!is_held(spec, parameter)) spec.nominal_units.push_back(parameter);
}

bool is_held(const Spec& spec, const std::string& parameter) {
  return std::ranges::find(spec.nominal_units, parameter) != spec.nominal_units.end();
}

std::vector<SameInSi> held_in_si(const Spec& spec) {
  std::vector<SameInSi> held;
  for (const SameInSi& one : same_in_si)
    if (std::ranges::any_of(spec.nominal_units,
                            [&](const std::string& name) { return member_of(name) == one.parameter; }))
      held.push_back(one);
  return held;
}

std::optional<SiUnit> si_unit(const Spec& spec, const std::string& parameter) {
  if (!is_held(spec, parameter)) return {};
  const OwnUnit& own = *find_own_unit(find_option("", parameter)->unit);
  return SiUnit{own.size(nominal_scales(spec)), own.si};
}

bool mass_varies(const Spec& spec) {
  const auto is_mass = [](const Axis& axis) { return is_body_mass(axis.key); };
  return std::ranges::any_of(spec.axes, is_mass) || std::ranges::any_of(spec.list.columns, is_mass);
}

void forget_mass_that_varies(Spec& spec) {
  if (mass_varies(spec)) spec.scene.mass = 0.0;
}

std::vector<std::string> body_keys(const Spec& spec) {
  std::vector<std::string> keys;
  if (!spec.hoop) return keys;
  for (const BodyNumber& row : body_numbers()) {
    if (!row.of_weight()) keys.push_back(fmt::format("hoop.{}", row.name));
    for (const Weight& weight : spec.hoop->weights)
      if (row.of_weight()) keys.push_back(fmt::format("hoop.{}.{}", weight.name, row.name));
  }
  return keys;
}

std::string hoop_help() {
  constexpr std::size_t column = 24;
  std::string help =
      "\n[hoop], instead of mass_ratio, offset_ratio, inertia_factor, radius and mass; angles count from the "
      "weights' common centre of mass\n";
  const auto add = [&](bool of_weight) {
    for (const BodyNumber& row : body_numbers())
      if (row.of_weight() == of_weight)
        help += list_entry(fmt::format("  {} *", row.name),
                           fmt::format("{} [{}], for example in {}.", row.meaning_of(), row.unit,
                                       find_own_unit(row.unit)->example),
                           column);
  };
  add(false);
  help += "[[hoop.weight]], any number of them; as options --hoop.NAME.mass VALUE\n";
  help += list_entry("  name", "a name of its own.", column);
  add(true);
  return help;
}

std::string hoop_text(const Spec& spec, const std::function<std::string(const Axis&)>& text_of_axis) {
  if (!spec.hoop) return {};
  const auto line = [&](const BodyNumber& row, const std::string& key, double value) -> std::string {
    const auto axis = std::ranges::find(spec.axes, key, &Axis::key);
    if (axis == spec.axes.end() && std::isnan(value)) return {};  // of a thin ring
    return fmt::format("{} = {}\n", row.name,
                       axis == spec.axes.end() ? toml_number(value) : text_of_axis(*axis));
  };
  std::string text = "\n[hoop]\n";
  for (const BodyNumber& row : body_numbers())
    if (const auto* member = std::get_if<double Body::*>(&row.member))
      text += line(row, fmt::format("hoop.{}", row.name), (*spec.hoop).**member);
  for (const Weight& weight : spec.hoop->weights) {
    text += fmt::format("\n[[hoop.weight]]\nname = \"{}\"\n", weight.name);
    for (const BodyNumber& row : body_numbers())
      if (const auto* member = std::get_if<double Weight::*>(&row.member))
        text += line(row, fmt::format("hoop.{}.{}", weight.name, row.name), weight.**member);
  }
  return text;
}

}  // namespace leapmap
