// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap boundaries: where outcomes jump, to rounding.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>

#include "cli/commands.hpp"
#include "cli/info_place.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "engine/parallel.hpp"
#include "engine/provenance.hpp"
#include "leapmap/boundaries.hpp"
#include "map/hdf5_driver.hpp"
#include "map/schema.hpp"
#include "map/table_file.hpp"
#include "model/model.hpp"
#include "spec/map_spec.hpp"
#include "spec/options.hpp"
#include "support/output_file.hpp"

namespace leapmap::cli {
namespace {

struct BoundariesArguments {
  std::string input, output, csv;
  std::vector<std::string> overrides;
  BoundaryOptions options;
  bool quiet = false, overwrite = false;
  Locking locking = Locking::required;
};

/// "0 threshold, 1 fold, ..."
std::string numbered(const std::vector<std::string>& names) {
  std::vector<std::string> told;
  for (std::size_t i = 0; i < names.size(); ++i) told.push_back(fmt::format("{} {}", i, names[i]));
  return fmt::format("{}", fmt::join(told, ", "));
}

std::string kinds_told() {
  std::vector<std::string> names;
  for (int kind = 0; kind < cliff_kinds; ++kind) names.emplace_back(name_of(static_cast<CliffKind>(kind)));
  return numbered(names);
}

TableColumn axis_column(const Axis& axis, const std::string& prefix, std::vector<double> values) {
  const Option& option = *find_option("", axis.key);
  const OwnUnit* unit = find_own_unit(option.unit);
  const BodyNumber* of_body = find_body_number(axis.key);
  return {prefix + axis.key, std::string(unit && unit->name != unit->si ? "1" : option.unit),
          of_body ? of_body->meaning_of(weight_of(axis.key)) : std::string(option.meaning),
          std::move(values)};
}

using Places = std::vector<std::vector<double>>;

/// Every cliff a row. places: of each.
Table cliffs_table(const Boundaries& found, const Places& places) {
  Table cliffs{numbered_rows(found.cliffs.size())};
  cliffs[0].name = "cliff";
  std::vector<std::string> axis_names;
  for (const Axis& axis : found.axes) axis_names.push_back(axis.key);
  const auto add_numbers = [&](const std::string& name, const std::string& meaning, const auto& number) {
    std::vector<double> numbers;
    for (const Cliff& cliff : found.cliffs) numbers.push_back(static_cast<double>(number(cliff)));
    cliffs.push_back({name, "1", meaning, numbers});
  };
  for (std::size_t k = 0; k < found.axes.size(); ++k) {
    std::vector<double> values;
    for (const std::vector<double>& place : places) values.push_back(place[k]);
    cliffs.push_back(axis_column(found.axes[k], "", std::move(values)));
  }
  add_numbers("along",
              fmt::format("axis along which it was bisected; its value is the largest one below; {}",
                          numbered(axis_names)),
              [](const Cliff& cliff) { return cliff.axis; });
  add_numbers("kind", "cause: " + kinds_told(), [](const Cliff& cliff) { return cliff.kind; });
  for (const auto& [side, which] :
       {std::pair{std::string("below"), &Cliff::below}, {"above", &Cliff::above}}) {
    add_numbers(side + "_status", "status " + side + ", as in maps",
                [which = which](const Cliff& cliff) { return (cliff.*which).status; });
    add_numbers(side + "_jumps_on", "number of the lift-off that is the jump " + side + "; 0: none",
                [which = which](const Cliff& cliff) { return (cliff.*which).jumps_on; });
    add_numbers(side + "_spurious_first_jump", "as in maps, " + side + "; 255: no lift-off",
                [which = which](const Cliff& cliff) { return (cliff.*which).spurious_first_jump; });
  }
  if (std::ranges::any_of(found.cliffs, [](const Cliff& cliff) {
        return cliff.below.phase_sequence != cliff.above.phase_sequence;
      }))
    for (const auto& [side, which] : {std::pair{"below", &Cliff::below}, {"above", &Cliff::above}}) {
      std::vector<std::string> letters;
      for (const Cliff& cliff : found.cliffs) letters.push_back(phase_letters((cliff.*which).phase_sequence));
      cliffs.push_back({std::string(side) + "_phases", "1", fmt::format("phases {}", side), letters});
    }
  return cliffs;
}

/// Every place of every curve a row.
Table curves_table(const Boundaries& found, const Places& places) {
  std::vector<double> curve, number, kinds;
  std::vector<std::vector<double>> at(found.axes.size());
  const auto add = [&](std::size_t i, double cliff, const std::vector<double>& place) {
    curve.push_back(static_cast<double>(i)), number.push_back(cliff);
    kinds.push_back(static_cast<double>(found.curves[i].kind));
    for (std::size_t k = 0; k < at.size(); ++k) at[k].push_back(place[k]);
  };
  const auto meeting = [&](std::size_t i, const std::vector<double>& there, std::size_t beside) {
    std::vector<double> place = places[beside];
    for (std::size_t k = 0; k < 2; ++k) place[found.plane[k]] = there[k];
    add(i, -1.0, place);
  };
  for (std::size_t i = 0; i < found.curves.size(); ++i) {
    const CliffCurve& one = found.curves[i];
    if (!one.meeting_from.empty()) meeting(i, one.meeting_from, one.cliffs.front());
    for (const std::size_t cliff : one.cliffs) add(i, static_cast<double>(cliff), places[cliff]);
    if (!one.meeting_to.empty()) meeting(i, one.meeting_to, one.cliffs.back());
  }
  Table curves{numbered_rows(curve.size())};
  curves[0].name = "vertex";
  curves.push_back({"curve", "1", "number of the curve; its points are in order", curve});
  curves.push_back({"curve_kind", "1", "cause: " + kinds_told(), kinds});
  curves.push_back({"curve_cliff", "1",
                    "row of the discontinuity; -1: three outcomes meet, known only to a cell of the grid",
                    number});
  for (std::size_t k = 0; k < at.size(); ++k)
    curves.push_back(axis_column(found.axes[k], "curve_", std::move(at[k])));
  return curves;
}

std::vector<Table> tables_of(const Boundaries& found) {
  Places places;
  for (const Cliff& cliff : found.cliffs) places.push_back(place_of(found, cliff));
  if (found.curves.empty()) return {cliffs_table(found, places)};
  return {cliffs_table(found, places), curves_table(found, places)};
}

constexpr std::string_view csv_head = "curve,kind,along";

/// Curve after curve, place after place, and then the cliffs that are on none.
std::string csv_of(const Boundaries& found) {
  std::string text(csv_head);
  for (const Axis& axis : found.axes) text += fmt::format(",{}", axis.key);
  text += ",below,above\n";
  std::vector<bool> on_curve(found.cliffs.size(), false);
  const auto line = [&](const std::string& curve, std::size_t i) {
    const Cliff& cliff = found.cliffs[i];
    on_curve[i] = true;
    text += fmt::format("{},{},{},{},\"{}\",\"{}\"\n", curve, name_of(cliff.kind), found.axes[cliff.axis].key,
                        fmt::join(place_of(found, cliff), ","), outcome_text(cliff.below),
                        outcome_text(cliff.above));
  };
  for (std::size_t k = 0; k < found.curves.size(); ++k)
    for (const std::size_t cliff : found.curves[k].cliffs) line(fmt::format("{}", k), cliff);
  for (std::size_t i = 0; i < found.cliffs.size(); ++i)
    if (!on_curve[i]) line("", i);
  return text;
}

void print_counts(const Boundaries& found) {
  for (int kind = 0; kind < cliff_kinds; ++kind) {
    const auto is_kind = [&](const auto& one) { return one.kind == static_cast<CliffKind>(kind); };
    const auto cliffs = std::ranges::count_if(found.cliffs, is_kind);
    if (cliffs == 0) continue;
    const auto curves = std::ranges::count_if(found.curves, is_kind);
    say("{:<10} {} places{}\n", name_of(static_cast<CliffKind>(kind)),
        grouped(static_cast<std::uint64_t>(cliffs)),
        curves > 0 ? fmt::format(" on {} curves", grouped(static_cast<std::uint64_t>(curves))) : "");
  }
  if (found.cliffs.empty()) say("no discontinuities: all neighbours have the same outcome\n");
}

Spec spec_of_input(const BoundariesArguments& arguments) {
  if (!hdf5::is_hdf5(arguments.input, arguments.locking))
    return read_given_spec(arguments.input, arguments.overrides);
  if (!arguments.overrides.empty())
    throw InputError(
        "--set: has no effect with a map; allowed: with a spec, for example the map's: leapmap info --spec");
  return spec_of(MapReader(arguments.input, arguments.locking), arguments.input);
}

int run(const BoundariesArguments& arguments) {
  const Spec spec = spec_of_input(arguments);
  refuse_scatter(arguments.overrides, "discontinuities are those of nominal hoops");
  const std::array inputs{NamedPath{"SPEC|MAP", arguments.input}, NamedPath{"design.points", spec.points}};
  const std::array outputs{NamedPath{"-o", arguments.output, true}, NamedPath{"--csv", arguments.csv}};
  refuse_same_files(inputs, outputs);
  if (arguments.options.phases && !model_of(spec.scene).slips)
    throw InputError(
        "--phases: has no effect because the contact never slips; allowed: with friction = \"coulomb\"");
  if (!arguments.output.empty()) refuse_taken(arguments.output, cliffs_filetype, arguments.locking);
  note_signals();
  TextOutput csv("--csv", arguments.csv, csv_head, arguments.overwrite);
  const auto begin = std::chrono::steady_clock::now();
  BoundaryOptions options = arguments.options;
  options.stop_requested = [] { return noted_signal() != 0; };
  // The grid's designs first; how many edges there are to bisect is known once they are solved.
  std::unique_ptr<Progress> progress;
  std::size_t shown = 0;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (total != shown) {
      progress.reset();
      progress = std::make_unique<Progress>(total, shown, arguments.quiet);
      shown = total;
    }
    progress->update(done);
  };
  Boundaries found;
  try {
    found = find_boundaries(spec, options);
  } catch (const Stopped&) {
    progress.reset();
    tell("interrupted; nothing was written");
    return 128 + noted_signal();
  }
  progress.reset();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!arguments.quiet) {
    say("found    {} discontinuities in {}\n", grouped(found.cliffs.size()), spoken_duration(seconds));
    print_counts(found);
  }
  if (!arguments.output.empty()) {
    std::vector<hdf5::Attribute> attributes =
        provenance(spec, cliffs_filetype, "Discontinuities of the outcomes of passive hoops");
    attributes.emplace_back("phases", std::int64_t{options.phases});
    attributes.emplace_back("wall_time", seconds);
    if (!write_tables(behind_links(arguments.output), std::string(cliffs_filetype), tables_of(found),
                      attributes, arguments.locking))
      tell_of_folder(arguments.output);
    if (!arguments.quiet) say("file     {}\n", arguments.output);
  }
  if (!arguments.csv.empty()) csv.commit(csv_of(found));
  if (arguments.output.empty() && arguments.csv.empty() && !arguments.quiet)
    say("nothing was written; -o FILE.h5 or --csv FILE.csv keeps them\n");
  return 0;
}

}  // namespace

void add_boundaries(CommandLine& line, int& status) {
  Command command =
      line.command("boundaries", "find the discontinuities of a map's outcome, to machine precision");
  command.examples(
      {{"leapmap boundaries maps/slope_mass_ratio.h5 -o maps/slope_mass_ratio.cliffs.h5",
        "charts and page of that map draw the curves"},
       {"leapmap boundaries sweeps/slope_mass_ratio.toml --csv cliffs.csv", "without a map; a table"}});
  auto arguments = std::make_shared<BoundariesArguments>();
  command.value("SPEC|MAP", arguments->input, "a sweep's spec (TOML), or the map that it made (HDF5)")
      .required()
      .check(named_file());
  command.group("Output");
  command.value("-o,--output", arguments->output, "write discontinuities and curves to this HDF5 file")
      .check(named_file());
  command
      .value(
          "--csv", arguments->csv,
          "write the discontinuities to this CSV file, curve after curve; one on two curves is there twice")
      .check(named_file());
  command.flag("--overwrite", arguments->overwrite, "allow --csv to replace any file");
  command.flag("--quiet", arguments->quiet, "print errors only");
  command.group("Options");
  add_set(command, arguments->overrides, ", for example tolerance=1e-12; not with a map");
  command.flag("--phases", arguments->options.phases, "with friction: phase sequences count as outcomes too");
  add_threads(command, arguments->options.threads);
  add_no_lock(command, arguments->locking);
  command.footer(
      "Neighbours of the grid with different outcomes (status, sub-threshold first lift-off, number of the "
      "lift-off that jumps) have a discontinuity between them. It is bisected until no number is left "
      "between.\n"
      "\n"
      "Kinds of discontinuities:\n"
      "  threshold    a lift-off's height crosses hop_height\n"
      "  fold         a lift-off appears: the normal force touches zero\n"
      "  runway       a lift-off crosses the rolling limit\n"
      "  turn         the hoop barely reverses its direction\n"
      "  release      the normal force at the release is zero\n"
      "  phase        with friction: a phase appears\n"
      "  painleve     with friction: Painleve's paradox\n"
      "  unresolved   the method fails on one side\n"
      "\n"
      "Along the two axes with the most values the discontinuities are joined to curves, for every value of "
      "the other axes.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
