// SPDX-License-Identifier: GPL-3.0-or-later
/// The keys that a spec's file and the command line give, each with its option and its value.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "spec/spec.hpp"
#include "spec/spec_entry.hpp"

namespace leapmap {

/// Every key of a file's tables, in the order they were written; [hoop] goes into the spec as well. Throws
/// InputError where a section or key is unknown or given twice.
std::vector<Entry> entries_of(const toml::table& file, const std::string& origin, Spec& spec);

/// Adds KEY=VALUE of the command line to the entries, which point into `values`. A key that is there already
/// keeps its place. Throws InputError.
void add_overrides(const std::vector<std::string>& overrides, const Spec& spec,
                   std::vector<toml::table>& values, std::vector<Entry>& entries);

/// What to add to the refusal of a text that is not TOML: that a number with a unit needs quotes, if one
/// lacks them.
std::string_view hint_of_quotes(std::string_view text);

}  // namespace leapmap
