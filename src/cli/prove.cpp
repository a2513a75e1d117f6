// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap prove: enclosures that hold, of designs, of cells of a map, and of all hoops within tolerances.
#include "leapmap/prove.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/proof_lines.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/sweep.hpp"
#include "leapmap/worst_case.hpp"
#include "map/writer.hpp"
#include "proof/cells.hpp"
#include "spec/map_spec.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"
#include "sweep/judged_map.hpp"

namespace leapmap::cli {
namespace {

struct ProveArguments {
  std::string input, output;
  std::vector<std::string> overrides;
  double share = 0.0;
  int threads = 0;
  bool quiet = false, overwrite = false, resume = false;
  Locking locking = Locking::required;
};

void refuse_goals(const Spec& spec) {
  if (!spec.goals.empty())
    throw InputError(fmt::format("{}: goal.{} has no effect here; allowed: with [tolerances], of one design",
                                 origin_of(spec), spec.goals.front().field));
}

std::function<bool()> on_signal() {
  return [] { return noted_signal() != 0; };
}

/// The designs of a map that is there.
int prove_map(const ProveArguments& arguments) {
  constexpr double usual = 20'000.0;  // designs
  if (!arguments.output.empty())
    throw InputError("-o: a map's designs are judged, and nothing is written; allowed: with a spec");
  const MapReader map(arguments.input, arguments.locking);
  const Spec spec = spec_of(map, arguments.input);
  const auto designs = static_cast<double>(designs_of(map.shape()));
  JudgeOptions options{.share = arguments.share > 0.0 ? arguments.share : std::min(1.0, usual / designs),
                       .threads = arguments.threads,
                       .stop_requested = on_signal()};
  std::optional<Progress> progress;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(total, 0, arguments.quiet);
    progress->update(done);
  };
  note_signals();
  const JudgedMap judged = judge_map(map, spec, options);
  progress.reset();
  for (const std::string& finding : judged.findings) say("WRONG    {}\n", printable(finding));
  if (judged.wrong > judged.findings.size())
    say("WRONG    {} designs more\n", grouped(judged.wrong - judged.findings.size()));
  if (arguments.quiet && judged.wrong == 0) return noted_signal() != 0 ? 128 + noted_signal() : 0;
  say("proved   {} of {} designs, of {} in the map: {}\n", grouped(judged.proved), grouped(judged.looked_at),
      grouped(static_cast<std::size_t>(designs)),
      judged.wrong == 0 ? "what the map stores lies within each enclosure"
                        : fmt::format("{} are not what is proved", grouped(judged.wrong)));
  say("widest   height {:.1e} diameters, time {:.1e} of it\n", judged.widest_height, judged.widest_time);
  for (const auto& [event, count] : judged.undecided) say("open     {}: {}\n", grouped(count), event);
  if (judged.failed > 0) say("failed   {} in the map, of which nothing is judged\n", grouped(judged.failed));
  if (noted_signal() != 0) return 128 + noted_signal();
  return judged.wrong > 0 ? 1 : 0;
}

/// The cells of a spec's grid, or the designs of its list, into a map.
int prove_cells(const ProveArguments& arguments, Spec spec) {
  if (spec.output.fields.empty())
    spec.output.fields = {"status", "spurious_first_jump", "candidates", "jump_height", "jump_time"};
  for (const Field& field : proof_fields()) {
    if (std::ranges::find(spec.output.fields, field.name) == spec.output.fields.end())
      spec.output.fields.emplace_back(field.name);
  }
  refuse_goals(spec);
  if (!spec.scatter.spreads.empty())
    throw InputError(
        fmt::format("{}: tolerances.{} has no effect on the cells of a grid; allowed: with one design",
                    origin_of(spec), spec.scatter.spreads.front().parameter));
  const std::string map = behind_links(arguments.output);
  if (map.empty())
    throw InputError("-o: is not set; allowed: a file for what is proved, for example proof.h5");
  SweepOptions options{
      .resume = arguments.resume, .overwrite = arguments.overwrite, .threads = arguments.threads};
  options.lock = arguments.locking == Locking::required;
  options.stop_requested = on_signal();
  std::optional<Progress> progress;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (!progress) note_signals(), progress.emplace(total, done, arguments.quiet);
    progress->update(done);
  };
  const Report report = sweep(spec, map, options);
  progress.reset();
  if (!report.whole) {
    tell(fmt::format(
        "interrupted after {} of {} designs, which {} keeps; resume: the same command with --resume",
        grouped(report.done), grouped(report.designs), part_of(map)));
    return 128 + noted_signal();
  }
  if (!arguments.quiet)
    say_findings(MapReader(map, arguments.locking), spec.axes.empty() ? "designs" : "cells");
  say("map      {}\n", map);
  return 0;
}

/// How many boxes are done, on stderr: once in ten seconds, as nobody knows how many there will be.
std::function<void(long, long)> boxes_teller(bool quiet) {
  using Clock = std::chrono::steady_clock;
  return [quiet, last = Clock::now()](long boxes, long open) mutable {
    if (quiet || Clock::now() - last < std::chrono::seconds(10)) return;
    last = Clock::now();
    tell(fmt::format("{} boxes evaluated, {} in hand", grouped(static_cast<std::size_t>(boxes)),
                     grouped(static_cast<std::size_t>(open))));
  };
}

/// One design, or all hoops within the spec's tolerances.
int prove_hoops(const ProveArguments& arguments, const Spec& spec) {
  if (!arguments.output.empty())
    throw InputError("-o: nothing is written of one design; allowed: with a spec of axes or a list");
  if (arguments.resume)
    throw InputError("--resume: has no effect here; allowed: with a spec of axes or a list");
  if (spec.scatter.spreads.empty()) {
    refuse_goals(spec);
    say("{}{}", proof_lines(prove(spec.design, spec.scene), spec), never_slips);
    return 0;
  }
  WorstCaseOptions options{.threads = arguments.threads, .stop_requested = on_signal()};
  options.progress = boxes_teller(arguments.quiet);
  note_signals();
  const WorstCase found = worst_case(spec, options);
  say("{}{}", worst_case_lines(found, spec), never_slips);
  if (noted_signal() != 0) return 128 + noted_signal();
  return found.answer == WorstCase::Answer::counterexample ? 1 : 0;
}

/// What lies between bounds, { from, to } without a count, is a tolerance about their middle.
Spec without_bounds(Spec spec) {
  for (const Axis& axis : spec.axes) {
    if (!axis.free) continue;
    const Option* option = find_option("design", axis.key);
    if (!option || !member_of(*option))
      throw InputError(fmt::format("{}: {}: is between bounds; allowed: parameters of a design",
                                   origin_of(spec), axis.key));
    const auto [from, to] = std::ranges::minmax(axis.values);
    spec.design.*member_of(*option) = from + 0.5 * (to - from);
    spec.scatter.spreads.push_back({axis.key, Spread::Law::uniform, 0.5 * (to - from)});
  }
  std::erase_if(spec.axes, [](const Axis& axis) { return axis.free; });
  return spec;
}

int run(const ProveArguments& arguments) {
  if (arguments.input.ends_with(".h5")) {
    if (!arguments.overrides.empty()) throw InputError("--set: a map has its own spec; allowed: with a spec");
    return prove_map(arguments);
  }
  if (arguments.share > 0.0) throw InputError("--share: has no effect with a spec; allowed: with a map");
  const Spec spec = without_bounds(read_given_spec(arguments.input, arguments.overrides));
  if (spec.axes.empty() && spec.points.empty()) return prove_hoops(arguments, spec);
  return prove_cells(arguments, spec);
}

}  // namespace

void add_prove(CommandLine& line, int& status) {
  Command command = line.command("prove", "prove what becomes of designs, cells and hoops within tolerances");
  command.examples({{"leapmap prove maps/slope_mass_ratio.h5", "whether its designs are what is proved"},
                    {"leapmap prove sweeps/slope_mass_ratio.toml -o proof.h5", "each cell of the chart"},
                    {"leapmap prove --set 'tolerances.slope={uniform=\"1 deg\"}'",
                     "whether every hoop within the tolerance jumps"}});
  auto arguments = std::make_shared<ProveArguments>();
  command.value("SPEC|MAP", arguments->input, "a spec (TOML), or a map (.h5); default: the paper's hoop");
  command.value("-o,--output", arguments->output, "the map of what is proved of each cell")
      .check(named_file());
  command.value("--share", arguments->share, "fraction of a map's designs; default: 20,000 designs")
      .check(number({0.0, 1.0, false, true}));
  add_set(command, arguments->overrides);
  add_threads(command, arguments->threads);
  command.flag("--overwrite", arguments->overwrite, "replace the output");
  command.flag("--resume", arguments->resume, "continue an interrupted proof");
  command.flag("-q,--quiet", arguments->quiet, "print errors and the map's name only");
  add_no_lock(command, arguments->locking);
  command.footer(
      "By ball arithmetic (Arb), whose enclosures hold of every design, of the model without slip up to its "
      "first jump.\n"
      "Each cell of a grid is proved (all its designs have one outcome, and jump between two heights), "
      "crossed "
      "(two designs in it have different outcomes), or open.\n"
      "Exit status 1: the map stores what is proved wrong, or a hoop within the tolerances misses a goal.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
