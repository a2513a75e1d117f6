// SPDX-License-Identifier: GPL-3.0-or-later
/// Which leapmap this is.
#pragma once

#include <string>
#include <string_view>

namespace leapmap {

std::string_view program_version();  ///< for example "0.1.0"
std::string_view git_revision();     ///< of the sources when they were configured, or "unknown"

/// The instruction set this was compiled for and its lanes, for example "AVX-512, 8 lanes".
std::string instruction_set();

}  // namespace leapmap
