// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap sweep --dry-run: what a sweep would take.
#pragma once

#include <string>

#include "map/tile.hpp"
#include "sweep/spec.hpp"

namespace leapmap::cli {

/// Prints designs, fields, memory, file size and time; times a sample of designs for half a second.
void print_plan(const Spec& spec, const std::string& map, const Tiling& tiling, int threads);

}  // namespace leapmap::cli
