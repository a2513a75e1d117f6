// SPDX-License-Identifier: GPL-3.0-or-later
/// The parts of leapmap sweep.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "audit/audit.hpp"
#include "leapmap/sweep.hpp"
#include "map/writer.hpp"
#include "spec/spec.hpp"

namespace leapmap::cli {

struct SweepArguments {
  std::string spec, map;
  std::optional<Shard> shard{};
  std::size_t shards = 0;   ///< of --dry-run: how many are planned; 0: none
  double time_limit = 0.0;  ///< of a job [h]; 0: none
  std::vector<std::string> overrides;
  int threads = 0;
  double commit_interval = 1.0;  ///< [s]
  bool resume = false, overwrite = false, retry_failed = false, dry_run = false, quiet = false;
  Locking locking = Locking::required;
};

/// --dry-run: prints what is there, designs, fields, memory, file size and time; times a sample of designs
/// for half a second.
void print_plan(const SweepArguments& arguments, const Spec& spec, const std::string& map,
                const Tiling& tiling);

/// Tells what the audit found; where it disagrees, with the command to see it. Returns the exit status.
int tell_audit(const SweepArguments& arguments, const Spec& spec, const AuditReport& report);

/// What the user types to sweep into that map again, with `how`: "--resume" or "--retry-failed".
std::string sweep_command(const SweepArguments& arguments, const std::string& map, std::string_view how);

/// --retry-failed: solves an existing map's failed designs again. Returns the exit status.
int retry_sweep(const SweepArguments& arguments, const Spec& spec, const std::string& map);

/// Designs by how they ended.
void print_totals(const StatusCounts& totals);

}  // namespace leapmap::cli
