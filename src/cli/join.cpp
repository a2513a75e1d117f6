// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap join: one map of all its shards.
#include "leapmap/join.hpp"

#include <fmt/format.h>

#include <optional>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "sweep/shard.hpp"

namespace leapmap::cli {
namespace {

struct JoinArguments {
  std::string map;
  JoinOptions options;
  Locking locking = Locking::required;
  bool quiet = false;
};

int run(JoinArguments& arguments) {
  JoinOptions& options = arguments.options;
  options.lock = arguments.locking == Locking::required;
  options.stop_requested = [] { return noted_signal() != 0; };
  std::optional<Progress> progress;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(total, 0, arguments.quiet);
    progress->update(done);
  };
  note_signals();
  const std::optional<JoinReport> report = join(arguments.map, options);
  progress.reset();
  if (!report) {
    tell("interrupted; nothing is kept, and the shards are as they were");
    return 128 + noted_signal();
  }
  if (!report->durable) tell_of_folder(arguments.map);
  if (!arguments.quiet)
    say("joined   {} shards: {} designs in {} tiles\n", report->shards, grouped(report->designs),
        grouped(report->tiles));
  SweepArguments told;
  told.quiet = arguments.quiet;
  const int status = report->audit ? tell_audit(told, report->spec, *report->audit) : 0;
  if (arguments.quiet) return status;
  print_totals(report->statuses);
  say("map      {}{}\n", arguments.map,
      options.as_virtual ? ", whose values stay in the shards beside it" : "");
  return status;
}

}  // namespace

void add_join(CommandLine& line, int& status) {
  Command command =
      line.command("join", "make one map of the shards that sweeps with --shard I/N left beside it");
  auto arguments = std::make_shared<JoinArguments>();
  command.value("MAP", arguments->map, "the map to make; its shards are MAP.1-of-N.h5 and so on, and stay")
      .required()
      .check(named_file());
  command
      .value("--shards", arguments->options.shards,
             "how many shards it has; default: as many as their names say")
      .check(whole_number(1, most_shards));
  command.flag(
      "--virtual", arguments->options.as_virtual,
      "leave the values in the shards and look them up there: for a map too large to copy; it needs the "
      "shards beside it");
  command.flag("--overwrite", arguments->options.overwrite, "replace an existing map");
  add_no_lock(command, arguments->locking);
  command.flag("--quiet", arguments->quiet, "print nothing but errors");
  command.footer(
      "Examples:\n"
      "  for i in 1 2 3; do leapmap sweep s.toml -o m.h5 --shard $i/3; done     on one machine or many\n"
      "  leapmap join m.h5                                                      the map of one sweep, bit "
      "for bit\n"
      "On a cluster: sweeps/cluster/README.md.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
