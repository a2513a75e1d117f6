// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap sweep: solves the designs of a spec into a map.
#include "leapmap/sweep.hpp"

#include <fmt/format.h>

#include <filesystem>

#include <optional>

#include "cli/audit_lines.hpp"
#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "engine/parallel.hpp"
#include "leapmap/version.hpp"
#include "shards/shard.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {
namespace {

SweepOptions options_of(const SweepArguments& arguments) {
  SweepOptions options;
  options.resume = arguments.resume, options.overwrite = arguments.overwrite;
  options.threads = arguments.threads;
  options.commit_interval = arguments.commit_interval;
  options.shard = arguments.shard;
  options.lock = arguments.locking == Locking::required;
  options.stop_requested = [] { return noted_signal() != 0; };
  return options;
}

void tell_resumed(const std::string& map, std::size_t done, std::size_t total) {
  say("resumed  {}\n",
      done > 0 ? fmt::format("{} of {} designs were complete", grouped(done), grouped(total))
               : fmt::format("nothing to resume in {}: starting from the beginning", part_of(map)));
  flush_out();
}

/// Says what a sweep came to. file: the map, or the shard's. Returns the exit status.
int tell_report(const SweepArguments& arguments, const Spec& spec, const std::string& map,
                const std::string& file, const Report& report) {
  if (!report.whole) {
    tell(fmt::format("interrupted after {} of {} designs, which {} keeps; resume: {}", grouped(report.done),
                     grouped(report.designs), part_of(file), sweep_command(arguments, map, "--resume")));
    return 128 + noted_signal();
  }
  if (!report.durable) tell_of_folder(file);
  if (report.was_whole && !arguments.quiet) say("map      {} is complete already\n", file);
  if (arguments.shard && report.designs == 0 && !arguments.quiet) {
    say("solved   nothing: there are fewer chunks than shards, and shard {} has none\n",
        text_of(*arguments.shard));
  } else if (!report.was_whole && !arguments.quiet) {
    say("solved   {} designs in {}, {:.4g} designs/s on {} threads by {}\n", grouped(report.solved),
        spoken_duration(report.seconds), static_cast<double>(report.solved) / report.seconds,
        thread_count(arguments.threads), resolved_method(spec));
  }
  const int status = report.audit ? tell_audit(arguments, spec, *report.audit) : 0;
  if (arguments.quiet || report.was_whole) return status;
  print_totals(report.statuses);
  if (const bool failed = report.statuses[static_cast<std::size_t>(Status::failed)] > 0;
      failed && arguments.shard)
    say("failed   solve them again by --retry-failed after joining the shards\n");
  else if (failed)
    say("failed   list them: leapmap info {} --failed; solve them again: {}\n", shell_quoted(map),
        sweep_command(arguments, map, "--retry-failed"));
  say("map      {}\n", file);
  return status;
}

int run(const SweepArguments& arguments) {
  const Spec spec = read_given_spec(arguments.spec, arguments.overrides);
  const std::string map = behind_links(arguments.map.empty() ? spec.output.file : arguments.map);
  if (arguments.dry_run) {
    check_spec(spec);
    const Tiling whole = tiling_of(spec);
    if (arguments.shard)
      print_plan(arguments, spec, map.empty() ? map : shard_path(map, *arguments.shard),
                 shard_of(spec, whole, *arguments.shard, arguments.threads));
    else
      print_plan(arguments, spec, map, whole);
    return 0;
  }
  if (arguments.retry_failed && !map.empty()) return retry_sweep(arguments, spec, map);
  const std::string file = arguments.shard && !map.empty() ? shard_path(map, *arguments.shard) : map;
  SweepOptions options = options_of(arguments);
  std::optional<Progress> progress;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (!progress) {  // the map is open, and the first design not yet solved
      note_signals();
      if (arguments.resume && !arguments.quiet) tell_resumed(file, done, total);
      progress.emplace(total, done, arguments.quiet);
    }
    progress->update(done);
  };
  try {
    const Report report = sweep(spec, map, options);
    progress.reset();
    return tell_report(arguments, spec, map, file, report);
  } catch (const KeptError& error) {
    throw IoError(fmt::format("{}; {} of {} designs are kept; when it can be written again, resume: {}",
                              error.what(), grouped(error.kept), grouped(error.designs),
                              sweep_command(arguments, map, "--resume")));
  }
}

}  // namespace

std::string sweep_command(const SweepArguments& arguments, const std::string& map, std::string_view how) {
  std::string command = "leapmap sweep";
  if (!arguments.spec.empty()) command += " " + shell_quoted(arguments.spec);
  command += fmt::format(" -o {} {}", shell_quoted(map), how);
  if (arguments.shard) command += " --shard " + text_of(*arguments.shard);
  for (const std::string& set : arguments.overrides) command += " --set " + shell_quoted(set);
  if (arguments.threads > 0) command += fmt::format(" --threads {}", arguments.threads);
  if (how == "--resume" && arguments.commit_interval != SweepArguments{}.commit_interval)
    command += fmt::format(" --commit-interval {}", arguments.commit_interval);
  if (arguments.locking != Locking::required) command += " --no-lock";
  if (!uses_best_instruction_set()) {
    const std::string set = instruction_set();
    command += " --instruction-set " + set.substr(0, set.find(','));
  }
  std::error_code ignored;
  if (how == "--resume" &&
      std::filesystem::exists(arguments.shard ? shard_path(map, *arguments.shard) : map, ignored))
    command += " --overwrite";  // the older map, once the new one is whole
  return command;
}

int tell_audit(const SweepArguments& arguments, const Spec& spec, const AuditReport& report) {
  if (!arguments.quiet) say_audit(report);
  for (const std::string& disagreement : disagreements(spec, report)) tell("cross-check: " + disagreement);
  return disagree(report) ? 1 : 0;
}

void print_totals(const StatusCounts& totals) {
  for (std::size_t i = 0; i < totals.size(); ++i)
    if (totals[i] > 0)
      say("         {:>12} {}\n", grouped(static_cast<std::uint64_t>(totals[i])),
          name_of(static_cast<Status>(i)));
}

void add_sweep(CommandLine& line, int& status) {
  Command command = line.command("sweep", "solve the designs of a spec into a map (HDF5)");
  command.examples({{"leapmap sweep s.toml -o m.h5 --dry-run", "predict time, memory and file size"},
                    {"leapmap sweep s.toml -o m.h5", "solve; Ctrl-C stops and keeps m.h5.part"},
                    {"leapmap sweep s.toml -o m.h5 --resume", "continue with m.h5.part"},
                    {"leapmap sweep s.toml -o m.h5 --retry-failed", "solve failed designs again"},
                    {"leapmap sweep s.toml -o n.h5 --set 'slope={from=0.1,to=0.8,count=99}'",
                     "change a key of the spec"}});
  auto arguments = std::make_shared<SweepArguments>();
  command.value("SPEC", arguments->spec, "a spec (TOML); default: every key at its default, the paper's hoop")
      .check(named_file());
  command.group("Output");
  command.value("-o,--output", arguments->map, "the map to write; default: output.file of the spec")
      .check(named_file());
  command.flag("--overwrite", arguments->overwrite,
               "replace an existing map and, without --resume, its .part");
  command.flag("--quiet", arguments->quiet, "print errors only");
  command.group("Designs");
  add_set(command, arguments->overrides, ", for example tolerance=1e-12");
  command
      .value(
          "--points",
          [arguments](const std::string& file) {
            arguments->overrides.push_back(fmt::format("design.points={}", file));
          },
          "solve the designs of this CSV file, one in a row, instead of axes")
      .check(named_file());
  add_flags_of_the_scene(command, arguments->overrides);
  command.group("Work");
  add_threads(command, arguments->threads);
  command.flag("--resume", arguments->resume,
               "continue the MAP.part that an interrupted sweep left, if there is one");
  command
      .flag("--retry-failed", arguments->retry_failed,
            "solve the failed designs of an existing map again, by the method that cross-checks its own, at "
            "tolerance 1e-12; or by the method, tolerance or max_steps of --set")
      .excludes("--resume")
      .excludes("--overwrite");
  command
      .value("--commit-interval", arguments->commit_interval,
             "time between commits [s]; kill -9 or a power failure loses at most that much work; default: 1")
      .check(number({0.0, 86400.0}));
  add_no_lock(command, arguments->locking);
  command.group("Planning and shards");
  command.flag("--dry-run", arguments->dry_run, "predict number of designs, memory, file size and time only");
  command
      .value(
          "--shard", [arguments](const std::string& text) { arguments->shard = parse_shard(text); },
          "solve part I of N of the map into MAP.I-of-N.h5; leapmap join MAP joins them")
      .excludes("--retry-failed")
      .shown_as("I/N");
  command.value("--shards", arguments->shards, "with --dry-run: predict this number of shards")
      .needs("--dry-run")
      .excludes("--shard")
      .excludes("--retry-failed")
      .check(whole_number(1, most_shards));
  command
      .value("--time-limit", arguments->time_limit,
             "with --dry-run: hours that a job may take, which determines the number of shards")
      .needs("--dry-run")
      .excludes("--shard")
      .excludes("--retry-failed")
      .check(number({1e-3, 1e4}));
  command.footer([] { return options_help(); });
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
