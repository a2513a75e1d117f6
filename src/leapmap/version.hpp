// SPDX-License-Identifier: GPL-3.0-or-later
/// Which leapmap this is, and which of its instruction sets is in use.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace leapmap {

std::string_view program_version();  ///< for example "0.1.0"
std::string_view git_revision();     ///< of the sources when they were configured, or "unknown"

/// The instruction set in use and how many doubles it works on at once, for example "x86-64-v3, 4 lanes".
/// The last bits of numbers depend on it.
std::string instruction_set();

/// The names of those that leapmap was built with and this machine has, lowest first. The last one is used
/// unless another is asked for.
std::vector<std::string> instruction_sets();

/// Whether that is the best there is.
bool uses_best_instruction_set();

/// Uses that one from now on, so that machines of different age run the same instructions. Not while anything
/// is being solved. Throws InputError if it was not built in or the machine has not got it.
void use_instruction_set(std::string_view name);

}  // namespace leapmap
