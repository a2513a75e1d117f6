// SPDX-License-Identifier: GPL-3.0-or-later
/// Projects of the program Tracker: .trk, and .trz, a zip archive with a .trk in it.
#pragma once

#include <string>
#include <string_view>

#include "leapmap/film.hpp"

namespace leapmap {

bool is_tracker_project(std::string_view path);

/// Adds a project's point masses to a recording, in metres along the project's own axes, y upwards, and a
/// line on how they were read. Throws InputError if it is no project or has no points; IoError.
void add_tracker_project(const std::string& path, Recording& recording);

}  // namespace leapmap
