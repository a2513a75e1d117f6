// SPDX-License-Identifier: GPL-3.0-or-later
/// Studies that show a first table after some ten seconds, and a finer one to whoever waits for it.
#pragma once

#include <functional>
#include <string>

#include "cli/command_line.hpp"

namespace leapmap::cli {

/// Adds --quick and --thorough, which exclude each other; fewer: of what a quick run has fewer.
void add_quick_and_thorough(Command& command, bool& thorough, const std::string& fewer);

/// Runs quickly, then, if asked, once more thoroughly. run(quick) writes the table; false: a signal came
/// first. Returns the exit status; what was written stays.
int run_quick_first(bool thorough, const std::string& table, const std::function<bool(bool quick)>& run);

}  // namespace leapmap::cli
