// SPDX-License-Identifier: GPL-3.0-or-later
/// The commands of the program, one file each. Each adds itself to the command line and puts the exit status
/// of its run into `status`; errors are exceptions, which main turns into a line and a status.
#pragma once

#include <CLI/CLI.hpp>

#include "map/journaled_file.hpp"
#include "sweep/options.hpp"

namespace leapmap::cli {

void add_sweep(CLI::App& app, int& status);
void add_hop(CLI::App& app, int& status);
void add_info(CLI::App& app, int& status);
void add_precision(CLI::App& app, int& status);
void add_stability(CLI::App& app, int& status);
void add_boundaries(CLI::App& app, int& status);
void add_design(CLI::App& app, int& status);
void add_fit(CLI::App& app, int& status);
void add_gait(CLI::App& app, int& status);
void add_join(CLI::App& app, int& status);
void add_check(CLI::App& app, int& status);

/// Refuses an empty file name.
CLI::Validator named_file();

/// Takes a number in a range, or a whole one; whatever else is written is refused, NaN among it. To be used
/// with transform(): CLI11's own conversion sees the number as leapmap read it.
CLI::Validator number(const Range& range);
CLI::Validator whole_number(double least, double most);
inline constexpr double most_seed = 1e15;

/// --no-lock, of every command that opens files of ours.
void add_no_lock(CLI::App& command, Locking& locking);

/// --set KEY=VALUE, which adds to overrides; example: what --help adds of one.
void add_set(CLI::App& command, std::vector<std::string>& overrides, const std::string& example = {});

/// read_spec, which says of a key that is given twice on the command line which value is used: the last.
Spec read_given_spec(const std::string& path, const std::vector<std::string>& overrides);

/// Throws InputError if one of the overrides is of a spec's [scatter] or [goal]; why: what is to be told.
void refuse_scatter(const std::vector<std::string>& overrides, const std::string& why);

/// The flag of a spec's key, which adds KEY=VALUE to overrides.
void add_flag_of(CLI::App& command, const Option& option, std::vector<std::string>& overrides);

}  // namespace leapmap::cli
