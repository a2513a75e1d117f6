// SPDX-License-Identifier: GPL-3.0-or-later
/// The section [hoop] of a spec: a hoop as a drawing has it.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "leapmap/body.hpp"

namespace leapmap {

/// hoop.KEY=VALUE of the command line; KEY: "diameter", "slug.mass" and the like.
struct HoopOverride {
  std::string key;
  const toml::node* value;
};

/// The body of the section, with what the command line sets of it. hoop: the section, or nullptr. Nothing:
/// there is neither. Throws InputError naming place, key, value and what is allowed.
std::optional<Body> read_hoop(const toml::node* hoop, const std::string& origin,
                              std::span<const HoopOverride> overrides);

/// The keys, for --help.
std::string hoop_help();

}  // namespace leapmap
