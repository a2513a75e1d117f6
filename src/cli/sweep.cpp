// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap sweep: solves the designs of a spec into a map.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "map/writer.hpp"
#include "support/errors.hpp"
#include "sweep/audit.hpp"
#include "sweep/designs.hpp"
#include "sweep/engine.hpp"
#include "sweep/options.hpp"
#include "sweep/parallel.hpp"

namespace leapmap::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct SweepArguments {
  std::string spec, map;
  std::vector<std::string> overrides;
  int threads = 0;
  bool overwrite = false, dry_run = false, quiet = false;
};

MapAxis describe(const Option& option, std::vector<double> values) {
  return {std::string(option.key), std::string(option.unit == "sqrt(g/R)" ? "1" : option.unit),
          fmt::format("{}{}", option.meaning, option.unit == "sqrt(g/R)" ? ", in sqrt(g/R)" : ""),
          std::move(values)};
}

MapLayout layout_of(const Spec& spec) {
  MapLayout layout;
  for (const Axis& axis : spec.axes)
    layout.axes.push_back(describe(*find_option("design", axis.key), axis.values));
  if (spec.axes.empty()) {
    for (const Option* parameter : design_parameters()) {
      const double constant = value_of(*parameter, spec.design);
      layout.columns.push_back(describe(*parameter, std::vector(spec.list.count, constant)));
      for (const Axis& column : spec.list.columns)
        if (column.key == parameter->key) layout.columns.back().values = column.values;
    }
  }
  for (const Field& field : map_fields())
    if (stores(spec.output, field.name)) layout.fields.push_back(&field);
  layout.time_unit = time_unit(spec.scene);
  layout.single = spec.output.precision == "f4";
  return layout;
}

std::string title_of(const Spec& spec) {
  std::vector<std::string_view> names;
  for (const Axis& axis : spec.axes) names.push_back(axis.key);
  return spec.axes.empty() ? fmt::format("Jumps of {} hoop designs", spec.list.count)
                           : fmt::format("Jumps of passive hoops over {}", fmt::join(names, " x "));
}

/// "61,696"
std::string grouped(std::uint64_t number) {
  const std::string digits = fmt::format("{}", number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string spoken_bytes(double bytes) {
  const std::array units{"B", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; bytes >= 1000.0 && unit + 1 < units.size(); ++unit) bytes /= 1000.0;
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

void plan(const Spec& spec, const std::string& map, const MapLayout& layout, const Tiling& tiling,
          int threads) {
  fmt::print("map      {}\n", map.empty() ? "(none: give -o or output.file)" : map);
  if (spec.axes.empty()) fmt::print("list     {} designs {}\n", grouped(spec.list.count), spec.list.path);
  for (const Axis& axis : spec.axes)
    fmt::print("axis     {} from {:.6g} to {:.6g}, {} values\n", axis.key, axis.values.front(),
               axis.values.back(), axis.values.size());
  fmt::print("designs  {} in {} tiles of {}\n", grouped(tiling.designs()), grouped(tiling.size()),
             fmt::join(tiling.tile_shape(), " x "));
  fmt::print("method   {}, tolerance {:g}\n", resolved_method(spec.numerics), spec.numerics.tolerance);
  const double tile_bytes = static_cast<double>(tiling.tile(0).count) * (sizeof(Outcome) + sizeof(Design));
  double axis_values = 0.0;
  for (const Axis& axis : spec.axes) axis_values += static_cast<double>(axis.values.size());
  // Each thread holds one tile, and four more each may wait to be written; HDF5 caches a megabyte a dataset.
  const double memory = 5.0 * threads * tile_bytes + 1e6 * static_cast<double>(layout.fields.size()) + 2e7 +
                        40.0 * axis_values +
                        (spec.axes.empty() ? 64.0 * static_cast<double>(spec.list.count) : 0.0);
  fmt::print("memory   about {}\n", spoken_bytes(memory));
  fmt::print("file     about {}\n", spoken_bytes(static_cast<double>(map_bytes(layout, tiling)) + 5e4));
  const double seconds = seconds_per_design(spec, 0.5) * static_cast<double>(tiling.designs()) / threads;
  fmt::print("time     about {} on {} threads\n", spoken_duration(seconds), threads);
}

/// Runs the audit; its result as attributes. A disagreement sets status and is told with the command to see
/// it.
std::vector<hdf5::Attribute> run_audit(const Spec& spec, const AuditDraw& draw,
                                       const SweepArguments& arguments, int& status) {
  if (spec.numerics.audit <= 0.0) return {};
  const AuditReport report =
      audit(spec, draw.samples(), arguments.threads, [] { return noted_signal() != 0; });
  if (!arguments.quiet)
    fmt::print(
        "audit    {} designs again by {}: height within {:.1e} diameters, time within {:.1e}, {} flags "
        "differ{}\n",
        grouped(report.designs), report.method, report.max_abs_height_error, report.max_rel_time_error,
        report.flag_mismatches,
        report.undecided > 0 ? fmt::format("; {} nobody can decide", report.undecided) : "");
  const auto tell = [&](const std::optional<std::size_t>& design, const std::string& what) {
    if (!design) return;
    status = 1;
    fmt::print(stderr, "leapmap: audit: {} on design {}; see it by: {}\n", what, *design,
               hop_command(spec, DesignSpace(spec).at(*design)));
  };
  const std::string both = fmt::format("{} and {}", resolved_method(spec.numerics), report.method);
  tell(report.first_mismatch, both + " disagree on status, flag or candidates");
  tell(report.first_inaccurate, fmt::format("{} differ by more than {:.1e}", both, report.allowed_error));
  return {{"audit_designs", static_cast<std::int64_t>(report.designs)},
          {"audit_method", report.method},
          {"audit_max_abs_height_error", report.max_abs_height_error},
          {"audit_max_rel_time_error", report.max_rel_time_error},
          {"audit_flag_mismatches", static_cast<std::int64_t>(report.flag_mismatches)},
          {"audit_undecided", static_cast<std::int64_t>(report.undecided)},
          {"audit_beyond_tolerance", static_cast<std::int64_t>(report.beyond_tolerance)}};
}

int run(const SweepArguments& arguments) {
  const Spec spec = read_spec(arguments.spec, arguments.overrides);
  const std::string map = arguments.map.empty() ? spec.output.file : arguments.map;
  const Tiling tiling(shape_of(spec));
  const MapLayout layout = layout_of(spec);
  const int threads = thread_count(arguments.threads);
  if (arguments.dry_run) {
    plan(spec, map, layout, tiling, threads);
    return 0;
  }
  if (map.empty())
    throw InputError(
        fmt::format("{}: output.file is not set; allowed: a file's name there or with -o", arguments.spec));

  int status = 0;
  const auto begin = Clock::now();
  std::vector<hdf5::Attribute> opening = provenance(spec, map_filetype, title_of(spec));
  opening.emplace_back("threads", std::int64_t{threads});
  AuditDraw draw(spec, tiling);
  MapWriter writer(map, layout, tiling, opening, arguments.overwrite);
  note_signals();
  std::array<std::size_t, status_count> totals{};
  std::size_t done = 0;
  {
    Progress progress(tiling.designs(), arguments.quiet);
    EngineOptions options;
    options.threads = arguments.threads;
    options.stop_requested = [] { return noted_signal() != 0; };
    options.progress = [&](std::size_t designs) { progress.update(designs); };
    done = run_sweep(spec, tiling, options, [&](const Tile& tile, std::span<const Outcome> outcomes) {
      for (const Outcome& outcome : outcomes) ++totals[static_cast<std::size_t>(outcome.status)];
      if (spec.numerics.audit > 0.0) draw.take(tile, outcomes);
      writer.write(tile, outcomes);
    });
  }
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const double solving = seconds();
  std::vector<hdf5::Attribute> closing;
  if (noted_signal() == 0) {
    writer.flush();  // a full disk is told before the audit takes its time
    closing = run_audit(spec, draw, arguments, status);
  }
  if (noted_signal() != 0) {
    const std::string part = writer.keep_part();
    fmt::print(stderr, "leapmap: interrupted after {} of {} designs; {} holds them\n", grouped(done),
               grouped(tiling.designs()), part);
    return 128 + noted_signal();
  }
  closing.emplace_back("wall_time", seconds());
  writer.finish(closing);
  if (arguments.quiet) return status;
  fmt::print("solved   {} designs in {}, {:.4g} designs/s on {} threads by {}\n", grouped(done),
             spoken_duration(solving), static_cast<double>(done) / solving, threads,
             resolved_method(spec.numerics));
  for (std::size_t i = 0; i < totals.size(); ++i)
    if (totals[i] > 0)
      fmt::print("         {:>12} {}\n", grouped(totals[i]), name_of(static_cast<Status>(i)));
  fmt::print("map      {}\n", map);
  return status;
}

}  // namespace

void add_sweep(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("sweep", "solve the designs of a spec into a map (HDF5)");
  auto arguments = std::make_shared<SweepArguments>();
  command->add_option("SPEC", arguments->spec, "the sweep's spec, TOML")->required();
  command->add_option("-o,--output", arguments->map, "the map to write; default: output.file of the spec");
  command
      ->add_option("--set", arguments->overrides,
                   "KEY=VALUE: override a key of the spec, for example --set tolerance=1e-12")
      ->expected(1)
      ->take_all();
  command->add_option("--threads", arguments->threads, "threads to use; default: all")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing map");
  command->add_flag("--dry-run", arguments->dry_run,
                    "tell designs, memory, file size and time, and compute nothing else");
  command->add_flag("--quiet", arguments->quiet, "print nothing but errors");
  command->footer(options_help());
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
