// SPDX-License-Identifier: GPL-3.0-or-later
/// Which leapmap this is.
#pragma once

#include <string_view>

namespace leapmap {

std::string_view program_version();  ///< for example "0.1.0"
std::string_view git_revision();     ///< of the sources when they were configured, or "unknown"

}  // namespace leapmap
