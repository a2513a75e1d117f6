// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap sweep: solves the designs of a spec into a map.
#include "leapmap/sweep.hpp"

#include <fmt/format.h>

#include <filesystem>

#include <optional>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "cli/told_sequences.hpp"
#include "leapmap/version.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"
#include "sweep/designs.hpp"
#include "sweep/options.hpp"
#include "sweep/parallel.hpp"
#include "sweep/shard.hpp"

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
  say("resumed  {}\n", done > 0
                           ? fmt::format("{} of {} designs were there already", grouped(done), grouped(total))
                           : fmt::format("nothing to go on with in {}: begun anew", part_of(map)));
  flush_out();
}

/// Says what a sweep came to. file: the map, or the shard's. Returns the exit status.
int tell_report(const SweepArguments& arguments, const Spec& spec, const std::string& map,
                const std::string& file, const Report& report) {
  if (!report.whole) {
    tell(fmt::format("interrupted after {} of {} designs, which {} keeps; go on by: {}", grouped(report.done),
                     grouped(report.designs), part_of(file), sweep_command(arguments, map, "--resume")));
    return 128 + noted_signal();
  }
  if (!report.durable) tell_of_folder(file);
  if (report.was_whole && !arguments.quiet) say("map      {} is whole already\n", file);
  if (arguments.shard && report.designs == 0 && !arguments.quiet) {
    say("solved   nothing: there are fewer tiles than shards, and shard {} has none\n",
        text_of(*arguments.shard));
  } else if (!report.was_whole && !arguments.quiet) {
    say("solved   {} designs in {}, {:.4g} designs/s on {} threads by {}\n", grouped(report.solved),
        spoken_duration(report.seconds), static_cast<double>(report.solved) / report.seconds,
        thread_count(arguments.threads), resolved_method(spec.numerics));
  }
  const int status = report.audit ? tell_audit(arguments, spec, *report.audit) : 0;
  if (arguments.quiet || report.was_whole) return status;
  print_totals(report.statuses);
  if (const bool failed = report.statuses[static_cast<std::size_t>(Status::failed)] > 0;
      failed && arguments.shard)
    say("failed   they are told, and solved again by --retry-failed, once the shards are joined\n");
  else if (failed)
    say("failed   see them by: leapmap info {} --failed; solve them again by: {}\n", shell_quoted(map),
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
    throw IoError(fmt::format("{}; {} of {} designs are kept: once it can be written, go on by: {}",
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
  if (!arguments.quiet)
    say("audit    {} designs again by {}: height within {:.1e} diameters, time within {:.1e}, motion within "
        "{:.1e}, {} flags differ{}{}\n",
        grouped(report.designs), report.method, report.max_abs_height_error, report.max_rel_time_error,
        report.max_rel_motion_error, report.flag_mismatches,
        report.undecided > 0 ? fmt::format("; {} nobody can decide", report.undecided) : "",
        report.failed > 0 ? fmt::format("; {} failed, not compared", report.failed) : "");
  if (!arguments.quiet && report.refereed > 0)
    say("referee  {} of them from the paper's (7) to (9), in SI units: {} wrong, largest error {:.1e}{}\n",
        grouped(report.refereed), report.overruled, report.referee_max_error,
        report.referee_undecided > 0 ? fmt::format("; {} it cannot decide", report.referee_undecided) : "");
  if (!arguments.quiet && report.gradient_designs > 0)
    say("gradient {} of them by differences in long double: {} wrong, largest error {:.1e}{}\n",
        grouped(report.gradient_designs), report.gradients_wrong, report.gradient_max_error,
        report.gradient_undecided > 0 ? fmt::format("; {} it cannot decide", report.gradient_undecided) : "");
  if (!arguments.quiet) say_sequences(report);
  const auto complain = [&](const std::optional<std::size_t>& design, const std::string& what) {
    if (design)
      tell(fmt::format("audit: {} on design {}; see it by: {}", what, told_design(spec, *design),
                       hop_command(spec, DesignSpace(spec).at(*design))));
  };
  const std::string both = fmt::format("{} and {}", resolved_method(spec.numerics), report.method);
  complain(report.first_mismatch, both + " disagree on status, flag or candidates");
  complain(report.first_inaccurate, fmt::format("{} differ by more than {:.1e}", both, report.allowed_error));
  complain(report.first_wrong_gradient,
           "a derivative differs by more than 1e-6 from differences in long double");
  complain(report.first_wrong_sequence, both + " disagree on later jumps by more than errors grow");
  complain(report.first_wrong_gait, "integration does not find the gait that is stored");
  complain(report.first_overruled,
           resolved_method(spec.numerics) + " and an integration of the paper's (7) to (9) disagree");
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
  auto arguments = std::make_shared<SweepArguments>();
  command
      .value("SPEC", arguments->spec,
             "the sweep's spec, TOML; default: every key at its default, the paper's hoop")
      .check(named_file());
  command
      .value("-o,--output", arguments->map,
             "the map to write, in a folder made if need be; default: output.file of the spec")
      .check(named_file());
  add_set(command, arguments->overrides, ", for example --set tolerance=1e-12");
  command
      .value(
          "--points",
          [arguments](const std::string& file) {
            arguments->overrides.push_back(fmt::format("design.points={}", file));
          },
          "solve the designs of this CSV file in place of axes, one a line, as leapmap design --csv writes "
          "them")
      .check(named_file());

  for (const Option* option : hop_options())
    if (option->section == "scene") add_flag_of(command, *option, arguments->overrides);
  command.value("--threads", arguments->threads, "threads to use; default: all")
      .check(whole_number(1, most_threads));
  command.flag("--resume", arguments->resume,
               "go on with the MAP.part that an interrupted sweep left, if there is one");
  command.flag("--overwrite", arguments->overwrite,
               "replace an existing map; without --resume its .part as well");
  command
      .flag("--retry-failed", arguments->retry_failed,
            "solve the failed designs of an existing map again: by exact if it was made by a stepper, by "
            "gsl-rk8pd if it was made by exact, at tolerance 1e-12; or as --set says, if that is another way "
            "than "
            "the map's (method, tolerance, max_steps, ...)")
      .excludes("--resume")
      .excludes("--overwrite");
  command
      .value("--commit-interval", arguments->commit_interval,
             "seconds between commits: kill -9 or a power cut loses no more than that and the tiles in "
             "hand; default: 1")
      .check(number({0.0, 86400.0}));
  command
      .value(
          "--shard", [arguments](const std::string& text) { arguments->shard = parse_shard(text); },
          "I/N: solve part I of N of the map only, into a file of its own beside it, MAP.I-of-N.h5; leapmap "
          "join "
          "MAP makes one of all. Parts are whole tiles, each as much work as the others")
      .excludes("--retry-failed");
  add_no_lock(command, arguments->locking);
  command.flag("--dry-run", arguments->dry_run,
               "tell designs, memory, file size and time, and compute nothing else");
  command.value("--shards", arguments->shards, "of --dry-run: how each of so many parts would fare")
      .needs("--dry-run")
      .excludes("--shard")
      .excludes("--retry-failed")
      .check(whole_number(1, most_shards));
  command
      .value("--time-limit", arguments->time_limit,
             "of --dry-run: hours that a job may take, which tells how many parts there must be")
      .needs("--dry-run")
      .excludes("--shard")
      .excludes("--retry-failed")
      .check(number({1e-3, 1e4}));
  command.flag("--quiet", arguments->quiet, "print nothing but errors");
  command.footer(
      "Examples:\n"
      "  leapmap sweep s.toml -o m.h5 --dry-run                  what it would take\n"
      "  leapmap sweep s.toml -o m.h5                            Ctrl-C stops it and keeps m.h5.part\n"
      "  leapmap sweep s.toml -o m.h5 --resume                   goes on with m.h5.part\n"
      "  leapmap sweep s.toml -o m.h5 --retry-failed             solves failed designs again\n"
      "  leapmap sweep s.toml -o n.h5 --set 'slope={from=0.1,to=0.8,count=99}' --set "
      "output.precision=f4\n\n" +
      options_help());
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
