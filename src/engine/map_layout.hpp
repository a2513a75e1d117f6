// SPDX-License-Identifier: GPL-3.0-or-later
/// What of a spec the map shows: its axes or designs, and the fields asked for.
#pragma once

#include <string>

#include "map/layout.hpp"
#include "spec/spec.hpp"

namespace leapmap {

MapLayout layout_of(const Spec& spec);

/// How large the map's file is at most: as large as without compression.
double map_file_bytes(const MapLayout& layout, const Tiling& tiling);

/// The map's title, for example "Jumps of passive hoops over slope x mass_ratio".
std::string title_of(const Spec& spec);

}  // namespace leapmap
