// SPDX-License-Identifier: GPL-3.0-or-later
/// From a map back to its spec, and whether another spec is the same.
#pragma once

#include <optional>
#include <string>

#include "map/reader.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// The spec that made a map; of a list, with the designs that the map holds. origin is for messages. Throws
/// IoError or InputError if the map does not hold one.
Spec spec_of(const MapReader& map, const std::string& origin);

/// In words, the first key in which `here` differs from `there`; none if both give the same map. output.file
/// does not count; with only_designs, nothing but [scene] and [design] does.
std::optional<std::string> first_difference(const Spec& there, const Spec& here, bool only_designs = false);

}  // namespace leapmap
