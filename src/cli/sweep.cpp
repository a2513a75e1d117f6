// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap sweep: solves the designs of a spec into a map.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
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

/// Runs the audit; its result as attributes. A disagreement sets status and is told with the command to see
/// it.
std::vector<hdf5::Attribute> run_audit(const Spec& spec, std::span<const AuditSample> samples,
                                       const SweepArguments& arguments, int& status) {
  if (spec.numerics.audit <= 0.0) return {};
  const AuditReport report = audit(spec, samples, arguments.threads, [] { return noted_signal() != 0; });
  if (!arguments.quiet)
    fmt::print(
        "audit    {} designs again by {}: height within {:.1e} diameters, time within {:.1e}, {} flags "
        "differ{}{}\n",
        grouped(report.designs), report.method, report.max_abs_height_error, report.max_rel_time_error,
        report.flag_mismatches,
        report.undecided > 0 ? fmt::format("; {} nobody can decide", report.undecided) : "",
        report.failed > 0 ? fmt::format("; {} failed, not compared", report.failed) : "");
  const auto complain = [&](const std::optional<std::size_t>& design, const std::string& what) {
    if (!design) return;
    status = 1;
    tell(fmt::format("audit: {} on design {}; see it by: {}", what, *design,
                     hop_command(spec, DesignSpace(spec).at(*design))));
  };
  const std::string both = fmt::format("{} and {}", resolved_method(spec.numerics), report.method);
  complain(report.first_mismatch, both + " disagree on status, flag or candidates");
  complain(report.first_inaccurate, fmt::format("{} differ by more than {:.1e}", both, report.allowed_error));
  return {{"audit_designs", static_cast<std::int64_t>(report.designs)},
          {"audit_method", report.method},
          {"audit_max_abs_height_error", report.max_abs_height_error},
          {"audit_max_rel_time_error", report.max_rel_time_error},
          {"audit_flag_mismatches", static_cast<std::int64_t>(report.flag_mismatches)},
          {"audit_undecided", static_cast<std::int64_t>(report.undecided)},
          {"audit_beyond_tolerance", static_cast<std::int64_t>(report.beyond_tolerance)}};
}

/// The samples of the tiles that are in the map already.
std::vector<AuditSample> samples_of(const SweepArguments& arguments, const Spec& spec, const Tiling& tiling,
                                    const MapWriter& writer) {
  std::vector<AuditSample> samples;
  if (spec.numerics.audit <= 0.0 || writer.progress().tiles == 0) return samples;
  std::vector<std::vector<AuditSample>> by_tile(writer.progress().tiles);
  parallel_for_each(by_tile.size(), arguments.threads, [&] {
    return [&, solve = make_solver(spec)](std::size_t t) {
      by_tile[t] = audit_samples(spec, tiling, tiling.tile(t), solve);
      return noted_signal() == 0;
    };
  });
  const MapReader map = writer.reader();
  for (std::size_t t = 0; t < by_tile.size() && noted_signal() == 0; ++t) {
    take_quantities(map, spec, tiling, tiling.tile(t), by_tile[t]);
    std::ranges::move(by_tile[t], std::back_inserter(samples));
  }
  return samples;
}

/// Solves what is missing in the map, committing now and then.
void solve_rest(const SweepArguments& arguments, const Spec& spec, const MapLayout& layout,
                const Tiling& tiling, MapWriter& writer, std::vector<AuditSample>& samples) {
  Progress progress(tiling.designs(), writer.progress().designs(), arguments.quiet);
  EngineOptions options;
  options.threads = arguments.threads;
  options.first_tile = writer.progress().tiles;
  options.stop_requested = [] { return noted_signal() != 0; };
  auto last_commit = Clock::now();
  const double seconds_before = writer.progress().seconds;
  const auto begin = Clock::now();
  const auto store = [&](const EncodedTile& tile, const std::vector<AuditSample>& drawn) {
    writer.write(tile);
    samples.insert(samples.end(), drawn.begin(), drawn.end());
    progress.update(writer.progress().designs());
    const auto now = Clock::now();
    if (std::chrono::duration<double>(now - last_commit).count() < arguments.commit_interval) return;
    writer.set_seconds(seconds_before + std::chrono::duration<double>(now - begin).count());
    writer.commit();
    last_commit = Clock::now();
  };
  run_sweep(spec, tiling, options, [&] {
    const auto encoder = std::make_shared<TileEncoder>(layout, tiling);
    return [&, encoder](std::size_t number, const Tile& tile, std::span<const Outcome> outcomes) -> Prepared {
      const auto encoded = std::make_shared<EncodedTile>(encoder->encode(number, outcomes));
      auto drawn = audit_samples(spec, tiling, tile, outcomes);
      const std::size_t bytes = encoded->bytes() + drawn.size() * sizeof(AuditSample);
      return {[&store, encoded, drawn = std::move(drawn)] { store(*encoded, drawn); }, bytes};
    };
  });
}

/// All of a sweep between the map's opening and its end. Returns the exit status.
int fill(const SweepArguments& arguments, const Spec& spec, const MapLayout& layout, const Tiling& tiling,
         const std::string& map, MapWriter& writer) {
  int status = 0;
  const auto begin = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const double seconds_before = writer.progress().seconds;
  const std::size_t already = writer.progress().designs();
  std::vector<AuditSample> samples = samples_of(arguments, spec, tiling, writer);
  if (noted_signal() == 0) solve_rest(arguments, spec, layout, tiling, writer, samples);
  const double solving = seconds();
  const std::size_t done = writer.progress().designs();
  writer.set_seconds(seconds_before + solving);
  writer.commit();  // a full disk is told before the audit takes its time
  std::vector<hdf5::Attribute> closing;
  if (noted_signal() == 0) closing = run_audit(spec, samples, arguments, status);
  writer.set_seconds(seconds_before + seconds());
  if (noted_signal() != 0) {
    writer.keep();
    tell(fmt::format("interrupted after {} of {} designs, which {} keeps; go on by: {}", grouped(done),
                     grouped(tiling.designs()), part_of(map), sweep_command(arguments, map, "--resume")));
    return 128 + noted_signal();
  }
  writer.finish(closing);
  if (arguments.quiet) return status;
  fmt::print("solved   {} designs in {}, {:.4g} designs/s on {} threads by {}\n", grouped(done - already),
             spoken_duration(solving), static_cast<double>(done - already) / solving,
             thread_count(arguments.threads), resolved_method(spec.numerics));
  print_totals(writer.progress().statuses);
  if (writer.progress().statuses[static_cast<std::size_t>(Status::failed)] > 0)
    fmt::print("failed   see them by: leapmap info {} --failed; solve them again by: {}\n", shell_quoted(map),
               sweep_command(arguments, map, "--retry-failed"));
  fmt::print("map      {}\n", map);
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
  if (is_done(arguments, map, spec)) {
    if (!arguments.quiet) fmt::print("map      {} is whole already\n", map);
    return 0;
  }

  std::vector<hdf5::Attribute> opening = provenance(spec, map_filetype, title_of(spec));
  opening.emplace_back("threads", std::int64_t{thread_count(arguments.threads)});
  MapWriter writer = open_map(arguments, map, spec, layout, tiling, opening);
  note_signals();
  if (arguments.resume && !arguments.quiet) {
    const std::size_t there = writer.progress().designs();
    fmt::print("resumed  {}\n", there > 0
                                    ? fmt::format("{} of {} designs were there already", grouped(there),
                                                  grouped(tiling.designs()))
                                    : fmt::format("nothing to go on with in {}: begun anew", part_of(map)));
    std::fflush(stdout);
  }
  try {
    return fill(arguments, spec, layout, tiling, map, writer);
  } catch (const IoError& error) {
    if (writer.committed() == 0) throw IoError(fmt::format("{}; nothing is kept", error.what()));
    throw IoError(fmt::format("{}; {} of {} designs are kept: once it can be written, go on by: {}",
                              error.what(), grouped(writer.committed()), grouped(tiling.designs()),
                              sweep_command(arguments, map, "--resume")));
  }
}

}  // namespace

void print_totals(const StatusCounts& totals) {
  for (std::size_t i = 0; i < totals.size(); ++i)
    if (totals[i] > 0)
      fmt::print("         {:>12} {}\n", grouped(static_cast<std::uint64_t>(totals[i])),
                 name_of(static_cast<Status>(i)));
}

void add_sweep(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("sweep", "solve the designs of a spec into a map (HDF5)");
  auto arguments = std::make_shared<SweepArguments>();
  command->add_option("SPEC", arguments->spec, "the sweep's spec, TOML")->required();
  command->add_option("-o,--output", arguments->map,
                      "the map to write, in a folder made if need be; default: output.file of the spec");
  command
      ->add_option("--set", arguments->overrides,
                   "KEY=VALUE: override a key of the spec, for example --set tolerance=1e-12")
      ->expected(1)
      ->take_all();
  command->add_option("--threads", arguments->threads, "threads to use; default: all")
      ->check(CLI::Range(1, 4096));
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
