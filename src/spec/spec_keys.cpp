// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spec_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <utility>

#include "leapmap/errors.hpp"
#include "spec/quantity.hpp"
#include "spec/spec_hoop.hpp"
#include "support/closest.hpp"
#include "support/number.hpp"

namespace leapmap {
namespace {

[[noreturn]] void refuse_key(const std::string& place, std::string_view section, std::string_view key) {
  if (const Option* parameter = find_option("design", key); section == "goal" && parameter)
    throw InputError(
        fmt::format("{}: goal.{}: is a parameter; allowed: its bounds in [design], {} = {{ from, to }}",
                    place, key, key));
  if (!section.empty() && std::ranges::find(spec_sections, section) == spec_sections.end())
    throw InputError(fmt::format("{}: {}.{}: unknown section{}; allowed: {}; of a weight hoop.{}.{}", place,
                                 section, key, did_you_mean(section, spec_sections),
                                 fmt::join(spec_sections, ", "), section, key));
  std::vector<std::string_view> keys;
  for (const Option& option : spec_options())
    if ((section.empty() || option.section == section) && std::ranges::find(keys, option.key) == keys.end())
      keys.push_back(option.key);
  throw InputError(fmt::format("{}: {}{}{}: unknown key{}; allowed: {}", place, section,
                               section.empty() ? "" : ".", key, did_you_mean(key, keys),
                               fmt::join(keys, ", ")));
}

/// The keys of a section. In [scatter] hoop.slug.mass = ... is a table of tables; before: "hoop.slug.".
void add_entries(const toml::table& table, const std::string& section, const std::string& before,
                 const std::string& origin, std::vector<Entry>& entries) {
  for (const auto& [name, value] : table) {
    const std::string key = before + std::string(name.str());
    const auto position = value.source().begin;
    const std::string place = fmt::format("{}:{}", origin, position.line);
    const Option* option = find_option(section, key);
    if (!option && section == "scatter" && (key + ".").starts_with("hoop.") && value.is_table()) {
      add_entries(*value.as_table(), section, key + ".", origin, entries);
      continue;
    }
    if (!option) refuse_key(place, section, key);
    const auto twice = std::ranges::find_if(
        entries, [&](const Entry& entry) { return entry.option == option && entry.key == key; });
    if (twice != entries.end())
      throw InputError(
          fmt::format("{}: {} appears twice, also at {}; allowed: once", place, key, twice->place));
    entries.push_back({.option = option, .place = place, .position = position, .node = &value, .key = key});
  }
}

/// A section by its name of today; [tolerances] is [scatter].
std::string section_of(std::string_view name) { return std::string(name == "tolerances" ? "scatter" : name); }

}  // namespace

std::vector<Entry> entries_of(const toml::table& file, const std::string& origin, Spec& spec) {
  std::vector<Entry> entries;
  for (const auto& [written, node] : file) {
    if (written.str() == "hoop") {
      spec.hoop = read_hoop(node, origin, entries);
      continue;
    }
    const std::string section = section_of(written.str());
    const std::string place = fmt::format("{}:{}", origin, node.source().begin.line);
    const toml::table* table = node.as_table();
    const bool known =
        std::ranges::any_of(spec_options(), [&](const Option& o) { return o.section == section; });
    if (const Option* option = find_option("", section); option && !known)
      throw InputError(fmt::format("{}: {}: a key stands below its section; allowed: [{}] above it", place,
                                   section, option->section));
    if (!known || !table)
      throw InputError(fmt::format("{}: [{}]: unknown section{}; allowed: [{}]", place, section,
                                   did_you_mean(section, spec_sections), fmt::join(spec_sections, "], [")));
    add_entries(*table, section, "", origin, entries);
  }
  std::ranges::stable_sort(entries, {},
                           [](const Entry& e) { return std::pair(e.position.line, e.position.column); });
  return entries;
}

std::string_view hint_of_quotes(std::string_view text) {
  const auto skip = [&](std::size_t characters) { text.remove_prefix(std::min(characters, text.size())); };
  const auto skip_blanks = [&] { skip(text.find_first_not_of(" \t")); };
  for (std::size_t sign = text.find('='); sign != std::string_view::npos; sign = text.find('=')) {
    skip(sign + 1), skip_blanks();
    const std::size_t number = length_of_number(text);
    skip(number), skip_blanks();
    if (number > 0 && !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0)
      return "; a number with a unit needs quotes: \"12 deg\"";
  }
  return "";
}

namespace {

/// KEY=VALUE as a table { v = VALUE }; numbers as every flag takes them, a bare word is a string.
toml::table parse_override(const std::string& text, std::string_view value) {
  if (const auto number = number_in(value)) {
    const auto whole = static_cast<std::int64_t>(std::clamp(*number, -1e15, 1e15));
    if (static_cast<double>(whole) == *number) return toml::table{{"v", whole}};
    return toml::table{{"v", *number}};
  }
  try {
    toml::table table = toml::parse(fmt::format("v = {}", value));
    if (table.size() != 1) throw InputError(fmt::format("--set {}: allowed: one KEY=VALUE", text));
    return table;
  } catch (const toml::parse_error&) {
    if (value.find_first_of("{}[]\"'\n") != std::string_view::npos)
      throw InputError(
          fmt::format("--set {}: the value is not TOML; allowed: a number, a word, [..] or {{..}}{}", text,
                      hint_of_quotes(text)));
    return toml::table{{"v", std::string(value)}};
  }
}

/// The same key set twice: the later one holds, at the place of the first, so that overriding an axis keeps
/// its turn.
void override_with(std::vector<Entry>& entries, const Entry& entry) {
  const auto found = std::ranges::find_if(
      entries, [&](const Entry& other) { return other.option == entry.option && other.key == entry.key; });
  found == entries.end() ? entries.push_back(entry) : void(*found = entry);
}

}  // namespace

void add_overrides(const std::vector<std::string>& overrides, const Spec& spec,
                   std::vector<toml::table>& values, std::vector<Entry>& entries) {
  values.reserve(overrides.size());
  for (const std::string& set : overrides) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos) throw InputError(fmt::format("--set {}: allowed: KEY=VALUE", set));
    const std::string name = set.substr(0, set.find_last_not_of(" \t", equals == 0 ? 0 : equals - 1) + 1);
    const std::size_t dot = name.find('.');
    const std::string section = section_of(dot == std::string::npos ? "" : name.substr(0, dot));
    const std::string key = dot == std::string::npos ? name : name.substr(dot + 1);
    const Option* option = section == "hoop" ? nullptr : find_option(section, key);
    if (!option && section != "hoop") refuse_key("--set " + set, section, key);
    if (!option && !spec.hoop)
      throw InputError(
          fmt::format("{}: {}: there is no [hoop]; allowed: with [hoop] in the spec, as in "
                      "sweeps/drawing.toml",
                      command_line, name));
    values.push_back(parse_override(set, std::string_view(set).substr(equals + 1)));
    const toml::node& value = *values.back().get("v");
    override_with(entries, option ? Entry{option, command_line, {}, &value, key}
                                  : hoop_override(*spec.hoop, name, value));
  }
}

}  // namespace leapmap
