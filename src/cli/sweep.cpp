// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap sweep: solves the designs of a spec into a map.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <optional>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "map/schema.hpp"
#include "support/errors.hpp"
#include "sweep/audit.hpp"
#include "sweep/designs.hpp"
#include "sweep/engine.hpp"
#include "sweep/map_layout.hpp"
#include "sweep/options.hpp"
#include "sweep/parallel.hpp"

namespace leapmap::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// What a tile adds to the map and to what is known of it.
struct FinishedTile {
  EncodedTile encoded;
  AuditReport audit;
  double audit_seconds = 0.0;
};

/// A tile's share of the audit; unset if a stop was requested meanwhile.
std::optional<AuditReport> audit_tile(const Auditor& auditor, const Spec& spec, const Tiling& tiling,
                                      const Tile& tile, std::span<const Outcome> outcomes) {
  AuditReport report = auditor.begin();
  for (const AuditSample& sample : audit_samples(spec, tiling, tile, outcomes)) {
    if (noted_signal() != 0) return std::nullopt;
    auditor.look_at(sample, report);
  }
  return report;
}

/// What a sweep has found so far besides the map, and how long it took in this session.
struct Course {
  AuditReport audit;
  double audit_seconds = 0.0;  ///< summed over threads
  double seconds = 0.0;
};

/// Solves and audits what is missing in the map, committing now and then.
Course solve_rest(const SweepArguments& arguments, const Spec& spec, const MapLayout& layout,
                  const Tiling& tiling, MapWriter& writer) {
  const bool audited = spec.numerics.audit > 0.0;
  Course course;
  if (audited)
    course.audit = writer.progress().tiles > 0 ? read_audit(writer.reader()) : Auditor(spec).begin();
  Progress progress(tiling.designs(), writer.progress().designs(), arguments.quiet);
  EngineOptions options;
  options.threads = arguments.threads;
  options.first_tile = writer.progress().tiles;
  options.stop_requested = [] { return noted_signal() != 0; };
  auto last_commit = Clock::now();
  const double seconds_before = writer.progress().seconds;
  const auto begin = Clock::now();
  const auto commit = [&] {
    course.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    writer.set_seconds(seconds_before + course.seconds);
    writer.commit(audited ? audit_attributes(course.audit) : std::vector<hdf5::Attribute>{});
    last_commit = Clock::now();
  };
  const auto store = [&](const FinishedTile& tile) {
    writer.write(tile.encoded);
    merge(course.audit, tile.audit);
    course.audit_seconds += tile.audit_seconds;
    progress.update(writer.progress().designs());
    if (std::chrono::duration<double>(Clock::now() - last_commit).count() >= arguments.commit_interval)
      commit();
  };
  run_sweep(spec, tiling, options, [&] {
    const auto encoder = std::make_shared<TileEncoder>(layout, tiling);
    const auto auditor = audited ? std::make_shared<Auditor>(spec) : nullptr;
    return [&, encoder, auditor](std::size_t number, const Tile& tile,
                                 std::span<const Outcome> outcomes) -> Prepared {
      const auto finished = std::make_shared<FinishedTile>();
      finished->encoded = encoder->encode(number, outcomes);
      if (auditor) {
        const auto audit_begin = Clock::now();
        const auto report = audit_tile(*auditor, spec, tiling, tile, outcomes);
        if (!report) return {};
        finished->audit = *report;
        finished->audit_seconds = std::chrono::duration<double>(Clock::now() - audit_begin).count();
      }
      return {[&store, finished] { store(*finished); }, finished->encoded.bytes() + sizeof(FinishedTile)};
    };
  });
  commit();
  return course;
}

/// All of a sweep between the map's opening and its end. Returns the exit status.
int fill(const SweepArguments& arguments, const Spec& spec, const MapLayout& layout, const Tiling& tiling,
         const std::string& map, MapWriter& writer) {
  const std::size_t already = writer.progress().designs();
  const Course course = solve_rest(arguments, spec, layout, tiling, writer);
  const std::size_t done = writer.progress().designs();
  if (noted_signal() != 0) {
    writer.keep();
    tell(fmt::format("interrupted after {} of {} designs, which {} keeps; go on by: {}", grouped(done),
                     grouped(tiling.designs()), part_of(map), sweep_command(arguments, map, "--resume")));
    return 128 + noted_signal();
  }
  const StatusCounts statuses = writer.progress().statuses;
  if (!writer.finish({})) tell_of_folder(map);
  const int threads = thread_count(arguments.threads);
  const auto team =
      static_cast<double>(std::min<std::size_t>(static_cast<std::size_t>(threads), tiling.size()));
  const double solving = course.seconds - course.audit_seconds / team;
  if (!arguments.quiet)
    say("solved   {} designs in {}, {:.4g} designs/s on {} threads by {}\n", grouped(done - already),
        spoken_duration(solving), static_cast<double>(done - already) / solving, threads,
        resolved_method(spec.numerics));
  const int status = spec.numerics.audit > 0.0 ? tell_audit(arguments, spec, course.audit) : 0;
  if (arguments.quiet) return status;
  print_totals(statuses);
  if (statuses[static_cast<std::size_t>(Status::failed)] > 0)
    say("failed   see them by: leapmap info {} --failed; solve them again by: {}\n", shell_quoted(map),
        sweep_command(arguments, map, "--retry-failed"));
  say("map      {}\n", map);
  return status;
}

int run(const SweepArguments& arguments) {
  const Spec spec = read_spec(arguments.spec, arguments.overrides);
  const std::string map = behind_links(arguments.map.empty() ? spec.output.file : arguments.map);
  const Tiling tiling(shape_of(spec));
  const MapLayout layout = layout_of(spec);
  if (arguments.dry_run) {
    print_plan(arguments, spec, map, tiling);
    return 0;
  }
  if (map.empty())
    throw InputError(
        fmt::format("{}: output.file is not set; allowed: a file's name there or with -o", arguments.spec));
  if (arguments.retry_failed) return retry_sweep(arguments, spec, map);
  refuse_own_input(arguments, spec, map);
  if (is_done(arguments, map, spec)) {
    if (!arguments.quiet) say("map      {} is whole already\n", map);
    const MapReader whole(map, arguments.locking);
    return hdf5::has_attribute(whole.file(), "audit_first_mismatch")
               ? tell_audit(arguments, spec, read_audit(whole))
               : 0;
  }

  std::vector<hdf5::Attribute> opening = provenance(spec, map_filetype, title_of(spec));
  opening.emplace_back("threads", std::int64_t{thread_count(arguments.threads)});
  if (spec.numerics.audit > 0.0) opening.emplace_back("audit_method", audit_method(spec.numerics));
  MapWriter writer = open_map(arguments, map, spec, layout, tiling, opening);
  note_signals();
  if (arguments.resume && !arguments.quiet) {
    const std::size_t there = writer.progress().designs();
    say("resumed  {}\n", there > 0 ? fmt::format("{} of {} designs were there already", grouped(there),
                                                 grouped(tiling.designs()))
                                   : fmt::format("nothing to go on with in {}: begun anew", part_of(map)));
    flush_out();
  }
  try {
    return fill(arguments, spec, layout, tiling, map, writer);
  } catch (const BrokenFile& error) {
    throw IoError(
        fmt::format("{}; the disk or its driver loses what it is given; begin anew by --overwrite, on "
                    "another disk",
                    error.what()));
  } catch (const IoError& error) {
    if (writer.committed() == 0) throw IoError(fmt::format("{}; nothing is kept", error.what()));
    throw IoError(fmt::format("{}; {} of {} designs are kept: once it can be written, go on by: {}",
                              error.what(), grouped(writer.committed()), grouped(tiling.designs()),
                              sweep_command(arguments, map, "--resume")));
  }
}

}  // namespace

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
  const auto complain = [&](const std::optional<std::size_t>& design, const std::string& what) {
    if (design)
      tell(fmt::format("audit: {} on design {}; see it by: {}", what, *design,
                       hop_command(spec, DesignSpace(spec).at(*design))));
  };
  const std::string both = fmt::format("{} and {}", resolved_method(spec.numerics), report.method);
  complain(report.first_mismatch, both + " disagree on status, flag or candidates");
  complain(report.first_inaccurate, fmt::format("{} differ by more than {:.1e}", both, report.allowed_error));
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

void add_sweep(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("sweep", "solve the designs of a spec into a map (HDF5)");
  auto arguments = std::make_shared<SweepArguments>();
  command->add_option("SPEC", arguments->spec, "the sweep's spec, TOML")->required();
  command
      ->add_option("-o,--output", arguments->map,
                   "the map to write, in a folder made if need be; default: output.file of the spec")
      ->check(named_file());
  command
      ->add_option("--set", arguments->overrides,
                   "KEY=VALUE: override a key of the spec, for example --set tolerance=1e-12")
      ->expected(1)
      ->take_all();
  for (const Option* option : hop_options()) {
    if (option->section != "scene") continue;
    command->add_option_function<std::string>(
        flag_of(*option),
        [arguments, option](const std::string& value) {
          arguments->overrides.push_back(fmt::format("scene.{}={}", option->key, value));
        },
        fmt::format("{}; {}", option->meaning, allowed_values(*option)));
  }
  command->add_option("--threads", arguments->threads, "threads to use; default: all")
      ->check(CLI::Range(1, most_threads));
  auto* resume = command->add_flag("--resume", arguments->resume,
                                   "go on with the MAP.part that an interrupted sweep left, if there is one");
  command->add_flag("--overwrite", arguments->overwrite,
                    "replace an existing map; without --resume its .part as well");
  command
      ->add_flag(
          "--retry-failed", arguments->retry_failed,
          "solve the failed designs of an existing map again: by exact if it was made by a stepper, by "
          "gsl-rk8pd if it was made by exact, at tolerance 1e-12; or as --set says, if that is another way "
          "than "
          "the map's (method, tolerance, max_steps, ...)")
      ->excludes(resume);
  command
      ->add_option("--commit-interval", arguments->commit_interval,
                   "seconds between commits: kill -9 or a power cut loses no more than that and the tiles in "
                   "hand; default: 1")
      ->check(CLI::Range(0.0, 86400.0));
  add_no_lock(*command, arguments->locking);
  command->add_flag("--dry-run", arguments->dry_run,
                    "tell designs, memory, file size and time, and compute nothing else");
  command->add_flag("--quiet", arguments->quiet, "print nothing but errors");
  command->footer(
      "Examples:\n"
      "  leapmap sweep s.toml -o m.h5 --dry-run                  what it would take\n"
      "  leapmap sweep s.toml -o m.h5                            Ctrl-C stops it and keeps m.h5.part\n"
      "  leapmap sweep s.toml -o m.h5 --resume                   goes on with m.h5.part\n"
      "  leapmap sweep s.toml -o m.h5 --retry-failed             solves failed designs again\n"
      "  leapmap sweep s.toml -o n.h5 --set 'slope={from=0.1,to=0.8,count=99}' --set "
      "output.precision=f4\n\n" +
      options_help());
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
