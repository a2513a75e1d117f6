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
#include "shards/shard.hpp"

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
    tell("interrupted; no map was written, and the shards are unchanged");
    return 128 + noted_signal();
  }
  if (!report->durable) tell_of_folder(arguments.map);
  if (!arguments.quiet)
    say("joined   {} shards: {} designs in {} chunks\n", report->shards, grouped(report->designs),
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
  Command command = line.command("join", "join the shards of a map, made by sweep --shard");
  command.examples(
      {{"for i in 1 2 3; do leapmap sweep s.toml -o m.h5 --shard $i/3; done", "on one machine or several"},
       {"leapmap join m.h5", "bit for bit the map of one sweep"}});
  auto arguments = std::make_shared<JoinArguments>();
  command.value("MAP", arguments->map, "the map to make; its shards are MAP.1-of-N.h5 and so on, and remain")
      .required()
      .check(named_file());
  command.value("--shards", arguments->options.shards, "number of shards; default: from their file names")
      .check(whole_number(1, most_shards));
  command.flag("--virtual", arguments->options.as_virtual,
               "leave the values in the shards, which must then stay beside the map");
  command.flag("--overwrite", arguments->options.overwrite, "replace an existing map");
  command.flag("--quiet", arguments->quiet, "print errors only");
  add_no_lock(command, arguments->locking);
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
