// SPDX-License-Identifier: GPL-3.0-or-later
/// A key of a spec as it is written, and what its value comes to.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "spec/options.hpp"

namespace leapmap {

inline constexpr const char* command_line = "command line";  ///< as an Entry's place

/// One key: where it stands, and its value.
struct Entry {
  const Option* option;
  std::string place;  // "file:line" or "--set"
  toml::source_position position;
  const toml::node* node;
  std::string key{};  // "slope"; of [hoop] and its tolerances "hoop.slug.mass"
  Scales scales{};    // of all hoops, for numbers with units; radius NaN, mass 0: each hoop has its own
  Scales nominal{};   // of the nominal hoop
};

/// The key with its section, for messages.
std::string name_of(const Entry& entry);

/// Throws InputError with the entry's place, key and value.
[[noreturn]] void refuse(const Entry& entry, std::string_view what, std::string_view allowed);

/// A number in the option's unit and range; `part` of the value, for messages.
double to_number(const Entry& entry, const toml::node& node, std::string_view part = "");

/// A text with a unit, in the SI unit of the option's own, if each hoop has its own; else nothing.
std::optional<double> to_si(const Entry& entry, const toml::node& node);

/// Whether its numbers are given with a unit of the SI. Throws InputError if only some are.
bool has_unit(const Entry& entry);

/// A whole number, also one written as 1e6.
std::optional<std::int64_t> to_whole(const toml::node& node);

/// { values }, { from, to, count, scale } or { from, to, step }; { from, to, scale }: a free one.
Axis to_axis(const Entry& entry, const toml::table& table);

/// { normal } or { uniform }: a width in the parameter's unit, or in per cent of its value.
Spread to_spread(const Entry& entry);

/// { at_least }, { at_most }, both, or { is }.
Goal to_goal(const Entry& entry);

}  // namespace leapmap
