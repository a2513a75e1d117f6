// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Version of leapmap, and the instruction set that its solvers use.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace leapmap {

/// Version number, for example "0.6.0".
std::string_view program_version();
/// Git revision of the sources when they were configured, or "unknown".
std::string_view git_revision();

/// Instruction set in use and its number of SIMD lanes, for example "x86-64-v3, 4 lanes". The last bits of
/// results depend on it.
std::string instruction_set();

/// Instruction sets that were built in and that this machine supports, lowest first. The last one is the
/// default.
std::vector<std::string> instruction_sets();

/// Whether the best of them is in use.
bool uses_best_instruction_set();

/// Selects an instruction set, so that different machines return equal bits. Not thread-safe: call it before
/// anything is solved.
/// @throws InputError if it was not built in or the machine does not support it
void use_instruction_set(std::string_view name);

}  // namespace leapmap
