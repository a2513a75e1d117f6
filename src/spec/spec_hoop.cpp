// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spec_hoop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "leapmap/errors.hpp"
#include "spec/quantity.hpp"
#include "support/closest.hpp"
#include "support/wrapped.hpp"

namespace leapmap {
namespace {

/// A number of a ring or a weight.
template <class Part>
struct Key {
  std::string_view name, unit;
  double Part::*member;
  bool needed;
  std::string_view meaning;
};

constexpr std::array ring_keys{
    Key<Body>{"diameter", "m", &Body::diameter, true, "outer diameter of the hoop"},
    Key<Body>{"mass", "kg", &Body::mass, true, "mass of the ring and everything on it except the weights"},
    Key<Body>{"inertia", "kg m2", &Body::inertia, false,
              "moment of inertia of that ring about the axis; default: of a thin ring"}};
constexpr std::array weight_keys{
    Key<Weight>{"mass", "kg", &Weight::mass, true, "mass of the weight"},
    Key<Weight>{"at", "m", &Weight::at, true, "distance of its centre from the axis"},
    Key<Weight>{"angle", "rad", &Weight::angle, false, "direction of its centre; default: 0"},
    Key<Weight>{"inertia", "kg m2", &Weight::inertia, false,
                "moment of inertia about its own centre; default: 0"}};

template <class Part, std::size_t n>
std::vector<std::string_view> names_of(const std::array<Key<Part>, n>& keys) {
  std::vector<std::string_view> names;
  for (const Key<Part>& key : keys) names.push_back(key.name);
  return names;
}

std::string written(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  std::string flat = text.str();
  std::ranges::replace(flat, '\n', ' ');
  return flat;
}

[[noreturn]] void refuse(const std::string& place, const std::string& key, const std::string& what,
                         const std::string& allowed) {
  throw InputError(
      fmt::format("{}: {}: {}; allowed: {}", place, key.empty() ? "[hoop]" : "hoop." + key, what, allowed));
}

double number(const toml::node& node, const std::string& place, const std::string& key,
              std::string_view unit) {
  const std::string allowed =
      fmt::format("a number, in {} or as \"... {}\"", unit, find_own_unit(unit)->example);
  if (const auto* text = node.as_string()) {
    try {
      return number_in_own_unit(text->get(), unit, {});
    } catch (const InputError& error) {
      refuse(place, key, error.what(), allowed);
    }
  }
  if (node.is_table())
    refuse(place, key, written(node) + " is an axis",
           "one number; in Python a weight may be an array (leapmap.Weight)");
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) refuse(place, key, written(node) + " is not a number", allowed);
  return *value;
}

/// Gives the part the number of that key; false: it has none of that name.
template <class Part, std::size_t n>
bool set(Part& part, const std::array<Key<Part>, n>& keys, std::string_view name, const std::string& of,
         const toml::node& node, const std::string& place) {
  const auto key = std::ranges::find(keys, name, &Key<Part>::name);
  if (key == keys.end()) return false;
  part.*key->member = number(node, place, of + std::string(name), key->unit);
  return true;
}

[[noreturn]] void refuse_unknown(const std::string& place, const std::string& key, std::string_view name,
                                 std::span<const std::string_view> names) {
  refuse(place, key, "unknown key" + did_you_mean(name, names), fmt::format("{}", fmt::join(names, ", ")));
}

std::string line_of(const std::string& origin, const toml::node& node) {
  return fmt::format("{}:{}", origin, node.source().begin.line);
}

Weight read_weight(const toml::table& table, const std::string& origin) {
  Weight weight;
  const auto* name = table["name"].as_string();
  if (!name || name->get().empty() || name->get().find_first_of(".=[] \t\n\"'") != std::string::npos)
    refuse(line_of(origin, table), "weight",
           name ? "the name '" + name->get() + "' cannot be part of a key" : "'name' is missing",
           "a name of letters, digits, - and _, for example name = \"slug\"");
  weight.name = name->get();
  std::vector<std::string_view> taken = names_of(ring_keys);
  taken.push_back("weight");
  if (std::ranges::find(taken, weight.name) != taken.end())
    refuse(line_of(origin, table), "weight", fmt::format("the name '{}' is a key of [hoop]", weight.name),
           "a name of its own, for example name = \"slug\"");
  for (const auto& [key, node] : table)
    if (key.str() != "name" &&
        !set(weight, weight_keys, key.str(), weight.name + ".", node, line_of(origin, node))) {
      std::vector<std::string_view> names = names_of(weight_keys);
      names.insert(names.begin(), "name");
      refuse_unknown(line_of(origin, node), fmt::format("{}.{}", weight.name, key.str()), key.str(), names);
    }
  for (const Key<Weight>& key : weight_keys)
    if (key.needed && !table.contains(key.name))
      refuse(line_of(origin, table), weight.name, fmt::format("'{}' is missing", key.name),
             fmt::format("{} = \"... {}\"", key.name, find_own_unit(key.unit)->example));
  return weight;
}

Body read_section(const toml::node& section, const std::string& origin) {
  const toml::table* table = section.as_table();
  if (!table) refuse(line_of(origin, section), "", "is no section", "[hoop] above its keys");
  Body body;
  for (const auto& [key, node] : *table) {
    if (set(body, ring_keys, key.str(), "", node, line_of(origin, node))) continue;
    if (key.str() != "weight") {
      std::vector<std::string_view> names = names_of(ring_keys);
      names.push_back("weight");
      refuse_unknown(line_of(origin, node), std::string(key.str()), key.str(), names);
    }
    const toml::array* weights = node.as_array();
    if (!weights || (!weights->empty() && !weights->is_array_of_tables()))
      refuse(line_of(origin, node), "weight", "is no list of weights",
             "[[hoop.weight]] above the keys of each");
    for (const toml::node& one : *weights) body.weights.push_back(read_weight(*one.as_table(), origin));
  }
  for (const Key<Body>& key : ring_keys)
    if (key.needed && !table->contains(key.name))
      refuse(line_of(origin, section), std::string(key.name), "is missing",
             fmt::format("{} = \"... {}\"", key.name, find_own_unit(key.unit)->example));
  return body;
}

void override_with(Body& body, const HoopOverride& given) {
  const std::string place = "command line";
  const std::size_t dot = given.key.find('.');
  if (dot == std::string::npos) {
    if (!set(body, ring_keys, given.key, "", *given.value, place))
      refuse_unknown(place, given.key, given.key, names_of(ring_keys));
    return;
  }
  const std::string name = given.key.substr(0, dot), key = given.key.substr(dot + 1);
  const auto weight = std::ranges::find(body.weights, name, &Weight::name);
  if (weight == body.weights.end()) {
    std::vector<std::string_view> names;
    for (const Weight& each : body.weights) names.push_back(each.name);
    refuse(
        place, given.key, fmt::format("no weight has the name '{}'{}", name, did_you_mean(name, names)),
        names.empty() ? "weights, by [[hoop.weight]] in a spec" : fmt::format("{}", fmt::join(names, ", ")));
  }
  if (!set(*weight, weight_keys, key, name + ".", *given.value, place))
    refuse_unknown(place, given.key, key, names_of(weight_keys));
}

}  // namespace

std::optional<Body> read_hoop(const toml::node* hoop, const std::string& origin,
                              std::span<const HoopOverride> overrides) {
  if (!hoop && overrides.empty()) return {};
  if (!hoop)
    refuse("command line", overrides[0].key, "there is no [hoop]",
           "with [hoop] in the spec, which gives the rest");
  Body body = read_section(*hoop, origin);
  for (const HoopOverride& one : overrides) override_with(body, one);
  try {
    static_cast<void>(reduce_body(body));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", origin, error.what()));
  }
  return body;
}

std::string hoop_help() {
  constexpr std::size_t column = 24;
  std::string help =
      "\n[hoop], instead of mass_ratio, offset_ratio, inertia_factor, radius and mass; angles count from the "
      "weights' common centre of mass\n";
  const auto add = [&](const auto& keys) {
    for (const auto& key : keys)
      help += list_entry(
          fmt::format("  {}", key.name),
          fmt::format("{} [{}], for example in {}.", key.meaning, key.unit, find_own_unit(key.unit)->example),
          column);
  };
  add(ring_keys);
  help += "[[hoop.weight]], any number of them; with --set: hoop.NAME.mass=VALUE\n";
  help += list_entry("  name", "a name of its own.", column);
  add(weight_keys);
  return help;
}

}  // namespace leapmap
