// SPDX-License-Identifier: GPL-3.0-or-later
/// The commands of the program, one file each. Each adds itself to the command line and puts the exit status
/// of its run into `status`; errors are exceptions, which main turns into a line and a status.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "map/journaled_file.hpp"
#include "spec/options.hpp"

namespace leapmap::cli {

void add_sweep(CommandLine& line, int& status);
void add_hop(CommandLine& line, int& status);
void add_info(CommandLine& line, int& status);
void add_precision(CommandLine& line, int& status);
void add_stability(CommandLine& line, int& status);
void add_boundaries(CommandLine& line, int& status);
void add_design(CommandLine& line, int& status);
void add_fit(CommandLine& line, int& status);
void add_gait(CommandLine& line, int& status);
void add_join(CommandLine& line, int& status);
void add_check(CommandLine& line, int& status);
void add_prove(CommandLine& line, int& status);
void add_export(CommandLine& line, int& status);

/// --no-lock, of every command that opens files of ours.
void add_no_lock(Command& command, Locking& locking);

/// --set KEY=VALUE, which adds to overrides; example: what --help adds of one.
void add_set(Command& command, std::vector<std::string>& overrides, const std::string& example = {});

/// read_spec, which says what is noted of the spec, and of a key that is given twice on the command line
/// which value is used: the last. check: throws InputError for what the command refuses, before anything is
/// said.
Spec read_given_spec(const std::string& path, const std::vector<std::string>& overrides,
                     const std::function<void(const Spec&)>& check = {});

/// Throws InputError if one of the overrides is of a spec's [scatter] or [goal]; why: what is to be told.
void refuse_scatter(const std::vector<std::string>& overrides, const std::string& why);

/// Flags of a scene's keys, or of a hoop's too, which add KEY=VALUE to overrides; without: a key that has
/// none.
void add_flags_of_the_scene(Command& command, std::vector<std::string>& overrides,
                            std::string_view without = {});
void add_flags_of_a_hoop(Command& command, std::vector<std::string>& overrides,
                         std::string_view without = {});

/// --threads.
void add_threads(Command& command, int& threads);

}  // namespace leapmap::cli
