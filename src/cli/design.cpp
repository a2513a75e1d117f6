// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap design: the designs within given bounds that reach their goals best.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "cli/commands.hpp"
#include "cli/info_place.hpp"
#include "cli/json.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/proof_lines.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "design/question.hpp"
#include "engine/parallel.hpp"
#include "leapmap/find_designs.hpp"
#include "leapmap/sweep.hpp"
#include "leapmap/trace.hpp"
#include "map/hdf5_driver.hpp"
#include "map/reader.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "spec/map_spec.hpp"
#include "spec/spec_hoop.hpp"
#include "support/output_file.hpp"

namespace leapmap::cli {
namespace {

struct DesignArguments {
  std::string spec, output, csv, units;
  std::vector<std::string> overrides;
  FindOptions options;
  bool json = false, quiet = false, overwrite = false;
  Locking locking = Locking::required;
};

/// The units of a report, for the hoop that each design is.
struct Report {
  const Question& question;
  ShownUnits units;

  /// Before the search, not after it.
  void refuse_unusable() {
    scale_to(question.values(std::vector<double>(question.dimensions(), 0.5)));
    std::vector<std::string> names;
    for (const FreeParameter& one : question.free) names.push_back(one.name);
    units.refuse_unusable(question.one.scene, names);
  }
  /// free: the values of the free parameters.
  void scale_to(std::span<const double> free) {
    units.scale(scales_of(question.one, question.designs.at(free)));
  }
  /// The same, for a parameter, which may be in the units of the nominal hoop.
  void scale_for(const std::string& parameter, std::span<const double> free) {
    if (!is_held(question.one, parameter)) return scale_to(free);
    units.scale(nominal_scales(question.one));
  }
};

std::string told_parameters(Report& report, const FoundDesign& found) {
  const std::vector<FreeParameter>& free = report.question.free;
  std::vector<std::string> told;
  for (std::size_t k = 0; k < free.size(); ++k) {
    report.scale_for(free[k].name, found.free);
    told.push_back(fmt::format("{} {}", free[k].name, report.units.told(found.free[k], free[k].name)));
  }
  report.scale_to(found.free);
  return fmt::format("{}", fmt::join(told, ", "));
}

/// Objectives that are fields, and the usual quantities.
std::string told_fields(Report& report, const FoundDesign& found) {
  const Question& question = report.question;
  std::vector<std::string> told, names;
  for (std::size_t k = 0; k < question.objectives.size(); ++k)
    if (const Field* field = question.objectives[k].field) {
      told.push_back(fmt::format("{} {}", field->name, report.units.told(found.objectives[k], *field)));
      names.emplace_back(field->name);
    }
  for (const Field& field : map_fields()) {
    const bool asked =
        field.name == "jump_height" || field.name == "jump_time" ||
        std::ranges::find(question.one.goals, field.name, &Goal::field) != question.one.goals.end();
    const double value = stored_number(field, found.outcome);
    if (asked && !std::isnan(value) && std::ranges::find(names, field.name) == names.end())
      told.push_back(fmt::format("{} {}", field.name, report.units.told(value, field)));
  }
  return fmt::format("{}", fmt::join(told, ", "));
}

/// In which steps people think of a parameter: the step, in its own unit, and its name.
std::pair<double, std::string_view> step_of(const Variable& variable) {
  if (variable.unit == "rad") return {std::numbers::pi / 180.0, "a degree"};
  if (variable.unit == "kg") return {1e-3, "a gram"};
  if (variable.unit == "m") return {1e-3, "a millimetre"};
  return {1.0, "a unit"};
}

/// Whether a field's unit changes with a number of [hoop], so that its derivative is one of the pure number.
bool changes_unit(const std::string& parameter, const Field& field) {
  const OwnUnit* own = find_own_unit(own_unit(field));
  const Scales one{.radius = 1.0, .gravity = 1.0, .mass = 1.0};
  const Scales other{.radius = parameter == "hoop.diameter" ? 2.0 : 1.0,
                     .gravity = 1.0,
                     .mass = is_body_mass(parameter) ? 2.0 : 1.0};
  return own && own->size(other) != own->size(one);
}

void print_gradients(Report& report, const FoundDesign& found) {
  for (const FieldGradient& gradient : found.gradients) {
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < report.question.free.size(); ++k) {
      const FreeParameter& parameter = report.question.free[k];
      const auto [step, name] = step_of(parameter.variable);
      const double change = gradient.by_free[k] * step;
      const Field& field = *find_field(gradient.of);
      if (!std::isnan(change))
        parts.push_back(fmt::format("{}{} {} of {}", change < 0.0 ? "" : "+",
                                    changes_unit(parameter.name, field)
                                        ? fmt::format("{:.6g} {}", change, own_unit(field))
                                        : report.units.told(change, field),
                                    name, parameter.name));
    }
    if (!parts.empty()) say("     {} changes by {}\n", gradient.of, fmt::join(parts, ", "));
  }
}

/// What tells it again, as made too where hoops are.
std::string command_of(const Question& question, const FoundDesign& found) {
  std::string command = hop_command(question.one, found.design);
  const Scatter scatter = fresh_samples(question.one.scatter);
  const auto is_of_body = [](const Spread& spread) { return find_body_number(spread.parameter) != nullptr; };
  // Tolerances of [hoop] need the spec's file; the nominal hoop follows from its ratios.
  if (scatter.spreads.empty() || std::ranges::any_of(scatter.spreads, is_of_body)) return command;
  command += fmt::format(" --scatter --set samples={} --set scatter.seed={}", scatter.samples, scatter.seed);
  const std::vector<SameInSi> held = held_in_si(question.one);
  for (Spread spread : scatter.spreads) {
    // The found hoop's own units are not those of the nominal one.
    if (!spread.percent) spread.width *= held_unit(held, member_of(spread.parameter), found.design);
    command += fmt::format(" --set 'scatter.{}={}'", spread.parameter, text_of(spread));
  }
  for (const Goal& goal : question.one.goals)
    command += fmt::format(" --set 'goal.{}={}'", goal.field, text_of(goal));
  return command;
}

void print_design(Report& report, const FoundDesign& found, std::size_t number) {
  const Question& question = report.question;
  report.scale_to(found.free);
  say("\n{:>3}  {}\n     {}\n", number, told_parameters(report, found), told_fields(report, found));
  if (report.units.are_asked_for()) say("{}", report.units.lines_of(found.outcome, question.one.scene));
  if (!std::isnan(found.yield.value))
    say("     yield {:.4f} +- {:.4f}, from {} fresh manufactured hoops\n", found.yield.value,
        found.yield.error, question.one.scatter.samples);
  if (found.worst) say("     {}\n", worst_case_line(*found.worst));
  std::string binds = fmt::format("{}", fmt::join(found.binds, "; "));
  if (const std::size_t at = binds.find("cliff ("); at != std::string::npos)
    binds.replace(at, 5, "discontinuity");
  if (!binds.empty()) say("     active constraints: {}\n", binds);
  if (!found.cliff.empty())
    say("     nearest discontinuity: at {:.2g} of the bounds' range, {}; beyond: {}\n",
        found.cliff[0].distance, name_of(found.cliff[0].kind), outcome_text(found.cliff[0].beyond));
  print_gradients(report, found);
  say("     {}\n", command_of(question, found));
}

/// The ends of a front and the designs between them that turn the most.
std::vector<std::size_t> called_out(const FoundDesigns& found) {
  const std::size_t last = found.designs.size() - 1;
  const auto at = [&](std::size_t i, std::size_t k) {
    const double from = found.designs.front().objectives[k], to = found.designs.back().objectives[k];
    return to == from ? 0.0 : (found.designs[i].objectives[k] - from) / (to - from);
  };
  std::size_t knee = 0;
  double most = 0.0;
  for (std::size_t i = 0; i <= last; ++i)
    if (const double off = std::abs(at(i, 0) - at(i, 1)); off > most) most = off, knee = i;
  std::vector<std::size_t> out{0};
  if (knee != 0 && knee != last) out.push_back(knee);
  if (last != 0) out.push_back(last);
  return out;
}

void print_found(Report& report, const FoundDesigns& found) {
  const Question& question = report.question;
  say("{} designs solved in {}\n", grouped(found.evaluations), spoken_duration(found.seconds));
  if (!model_of(question.one.scene).slips) say("{}", never_slips);
  if (question.objectives.size() == 2 && found.reached) {
    say("front: {} designs; improving {} or {} makes the other worse", grouped(found.designs.size()),
        question.objectives[0].name, question.objectives[1].name);
    say("{}\n", std::isnan(found.hypervolume)
                    ? ""
                    : fmt::format("; it dominates {:.2f} % of the rectangle between its ends",
                                  100.0 * found.hypervolume));
    for (const std::size_t i : called_out(found)) print_design(report, found.designs[i], i + 1);
    return;
  }
  for (std::size_t i = 0; i < found.designs.size(); ++i) print_design(report, found.designs[i], i + 1);
}

/// How near a hoop came to a jump.
std::string how_near(const FoundDesign& found, const Spec& spec) {
  const Outcome& outcome = found.outcome;
  if (outcome.candidates == 0) {
    double least = std::numeric_limits<double>::infinity();
    const double interval = 0.02 * time_unit(spec.scene);
    for (const MotionPoint& point : trace(found.design, spec.scene, {.interval = interval}).points)
      if (point.phase != Phase::flight) least = std::min(least, point.normal_force);
    return std::isfinite(least)
               ? fmt::format("it never lifts off; the normal force falls to {:.3g} weights", least)
               : "it never lifts off";
  }
  return fmt::format("its {} to {:.4g} diameters; a jump is {:g} or more",
                     outcome.candidates == 1 ? "lift-off rises" : "first lift-off rises",
                     outcome.first_jump_height, spec.scene.hop_height);
}

/// What a goal asks for and what became of it, in the units shown.
std::string told_miss(Report& report, const Goal& goal, double value) {
  const Field& field = *find_field(goal.field);
  const bool is_number = goal.unit_of_nominal == 0.0 && !std::holds_alternative<Code>(field.source);
  std::vector<std::string> limits;
  if (!is_number) limits.push_back(text_of(goal));
  if (is_number && std::isfinite(goal.at_least))
    limits.push_back("at least " + report.units.told(goal.at_least, field));
  if (is_number && std::isfinite(goal.at_most))
    limits.push_back("at most " + report.units.told(goal.at_most, field));
  const std::string told = std::isnan(value) ? "does not apply"
                           : is_number       ? report.units.told(value, field)
                           : goal.unit_of_nominal > 0.0
                               ? fmt::format("{:.6g} {}", value, find_own_unit(own_unit(field))->si)
                               : fmt::format("{:.10g}", value);
  return fmt::format("{} {}: {}", goal.field, fmt::join(limits, ", "), told);
}

/// The best that there is where no design does it.
void print_miss(const Spec& spec, Report& report, const FoundDesigns& found) {
  const Question& question = report.question;
  say("No design within the bounds meets all goals; {} were evaluated. The nearest miss:\n",
      grouped(found.evaluations));
  const FoundDesign& nearest = found.designs[0];
  report.scale_to(nearest.free);
  say("     {}\n     {}\n", told_parameters(report, nearest), name_of(nearest.outcome.status));
  if (nearest.outcome.status != Status::jumped) say("     {}\n", how_near(nearest, question.one));
  for (std::size_t k = 0; k < spec.goals.size(); ++k)
    say("     {}\n", told_miss(report, spec.goals[k], found.missed[k]));
  say("     {}\n", command_of(question, nearest));
}

/// The value of a free parameter, in the SI if the hoops share it there.
double in_si(const Question& question, std::size_t k, double value) {
  const std::optional<SiUnit> si = si_unit(question.one, question.free[k].name);
  return si ? value * si->size : value;
}

Json json_of(const Question& question, const FoundDesign& found) {
  const bool near = !found.cliff.empty();
  Json json{
      {"yield", {{"value", found.yield.value}, {"error", found.yield.error}}},
      {"parameters", Json::object()},
      {"objectives", Json::object()},
      {"fields", Json::object()},
      {"gradients", Json::object()},
      {"worst_case", found.worst ? worst_case_json(*found.worst) : Json()},
      {"binds", found.binds},
      {"cliff",
       near ? Json{{"distance", found.cliff[0].distance}, {"kind", name_of(found.cliff[0].kind)}} : Json()},
      {"hop", command_of(question, found)}};
  for (std::size_t k = 0; k < question.free.size(); ++k)
    json["parameters"][question.free[k].name] = in_si(question, k, found.free[k]);
  for (std::size_t k = 0; k < question.objectives.size(); ++k)
    json["objectives"][question.objectives[k].name] = found.objectives[k];
  for (const Field* field : fields_of(question.one.scene))
    if (!std::holds_alternative<Word>(field->source))
      json["fields"][std::string(field->name)] = number_json(*field, found.outcome);
  for (const FieldGradient& gradient : found.gradients)
    for (std::size_t k = 0; k < question.free.size(); ++k)
      json["gradients"][gradient.of][question.free[k].name] = gradient.by_free[k] / in_si(question, k, 1.0);
  return json;
}

Json json_of(const Spec& spec, const Question& question, const FoundDesigns& found) {
  Json json{{"reached", found.reached}, {"evaluations", found.evaluations},
            {"seconds", found.seconds}, {"hypervolume", found.hypervolume},
            {"missed", Json::object()}, {"units", Json::object()},
            {"designs", Json::array()}};
  for (std::size_t k = 0; k < found.missed.size(); ++k) {
    const Goal& goal = spec.goals[k];
    json["missed"][goal.field] = found.missed[k];
    if (goal.unit_of_nominal > 0.0)
      json["units"][goal.field] = find_own_unit(own_unit(*find_field(goal.field)))->si;
  }
  for (const FreeParameter& free : question.free)
    if (const std::optional<SiUnit> si = si_unit(spec, free.name)) json["units"][free.name] = si->name;
  for (const FoundDesign& one : found.designs) json["designs"].push_back(json_of(question, one));
  return json;
}

/// The columns that design.points takes: what the hoops share in the SI, in the SI.
std::string csv_of(const Question& question, const FoundDesigns& found) {
  std::vector<std::string> names;
  for (const FreeParameter& parameter : question.free) {
    const std::optional<SiUnit> si = si_unit(question.one, parameter.name);
    names.push_back(si ? fmt::format("{} [{}]", parameter.name, si->name) : parameter.name);
  }
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (const FoundDesign& one : found.designs) {
    std::vector<std::string> cells;
    for (std::size_t k = 0; k < one.free.size(); ++k)
      cells.push_back(fmt::format("{}", in_si(question, k, one.free[k])));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

/// Whether a file is a list that a search wrote, which another one may replace: it took seconds.
bool is_found_list(const std::string& path, Locking locking) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) || !hdf5::is_hdf5(path, locking)) return false;
  const Spec spec = spec_of(MapReader(path, locking), path);
  return !spec.maximize.empty() || !spec.minimize.empty();
}

int run(const DesignArguments& arguments) {
  const Spec spec = read_given_spec(arguments.spec, arguments.overrides);
  const Question question = question_of(spec);
  Report report{question, ShownUnits(arguments.units, scales_of(spec.scene))};
  report.refuse_unusable();
  if (arguments.json && !arguments.units.empty())
    throw InputError("--units has no effect with --json; allowed: one of them");
  const std::string map = behind_links(arguments.output.empty() ? spec.output.file : arguments.output);
  const std::array inputs{NamedPath{"SPEC", arguments.spec}, NamedPath{"design.points", spec.points}};
  const std::array outputs{NamedPath{"-o", map, true}, NamedPath{"--csv", arguments.csv}};
  refuse_same_files(inputs, outputs);
  std::error_code ignored;
  const bool replaces = !map.empty() && std::filesystem::exists(map, ignored);
  if (replaces && !arguments.overwrite && !is_found_list(map, arguments.locking))
    throw InputError(fmt::format(
        "{}: exists and is not a list of leapmap design; allowed: another name by -o, or --overwrite", map));
  note_signals();
  if (!map.empty()) refuse_unwritable(map);
  TextOutput csv("--csv", arguments.csv, {}, arguments.overwrite);  // any list of designs begins like ours
  FindOptions options = arguments.options;
  options.stop_requested = [] { return noted_signal() != 0; };
  std::optional<Progress> progress;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(total, 0, arguments.quiet || arguments.json);
    progress->update(done);
  };
  FoundDesigns found;
  try {
    found = find_designs(spec, options);
  } catch (const Stopped&) {
    progress.reset();
    tell("interrupted; nothing was written");
    return 128 + noted_signal();
  }
  progress.reset();
  if (arguments.json)
    say_json(json_of(spec, question, found));
  else if (!found.reached)
    print_miss(spec, report, found);
  else if (!arguments.quiet)
    print_found(report, found);
  if (!found.reached) return 1;
  if (!map.empty()) {
    sweep(list_of(spec, found), map,
          {.overwrite = true,
           .threads = arguments.options.threads,
           .lock = arguments.locking == Locking::required});
    if (!arguments.quiet && !arguments.json) say("\nlist     {}\n", map);
  }
  if (!arguments.csv.empty()) csv.commit(csv_of(question, found));
  return 0;
}

}  // namespace

void add_design(CommandLine& line, int& status) {
  Command command = line.command("design", "find the designs that reach given goals best, or a Pareto front");
  command.examples(
      {{"leapmap design sweeps/questions/highest.toml -o maps/best.h5", "the highest jump"},
       {"leapmap design sweeps/questions/height_against_mass.toml -o maps/front.h5", "a Pareto front"}});
  auto arguments = std::make_shared<DesignArguments>();
  command.value("SPEC", arguments->spec, "a spec (TOML) whose axes { from, to } are the free parameters")
      .required()
      .check(named_file());
  command.group("Output");
  command
      .value("-o,--output", arguments->output,
             "write the designs to this map, best first; default: output.file of the spec")
      .check(named_file());
  command
      .value("--csv", arguments->csv,
             "write the designs to this CSV file, as leapmap sweep --points reads it")
      .check(named_file());
  command.flag("--json", arguments->json, "print JSON only");
  command.value("--units", arguments->units,
                "report free parameters and every quantity in these units, for example \"mm g deg J\"");
  command.flag("--overwrite", arguments->overwrite, "replace any file, not only an earlier search's list");
  command.flag("--quiet", arguments->quiet, "print errors, and whether no design meets the goals");
  command.group("Search");
  command.value("--seed", arguments->options.seed, "seed of random numbers; default: 1")
      .check(whole_number(0, most_seed));
  command
      .value("--most", arguments->options.most,
             "largest number of designs to report; default: 8, or 2,048 for a front")
      .check(whole_number(1, 1e5));
  command
      .value("--sample", arguments->options.sample,
             "designs in the initial sample; default: 2,097,152, with friction 262,144, and fewer with "
             "tolerances")
      .check(whole_number(16, 1 << 27));
  add_threads(command, arguments->options.threads);
  add_flags_of_the_scene(command, arguments->overrides);
  command.group("Options");
  add_set(command, arguments->overrides, ", for example 'goal.jump_height={at_least=0.8}'");
  add_no_lock(command, arguments->locking);
  command.footer(
      "A design problem:\n"
      "  [design]\n"
      "  slope = { from = \"2 deg\", to = \"20 deg\" }\n"
      "  mass_ratio = { from = 0.1, to = 20, scale = \"log\" }\n"
      "  [goal]\n"
      "  jump_height = { at_least = 1.0 }\n"
      "  spurious_first_jump = { is = 0 }\n"
      "  minimize = [\"mass_ratio\"]\n"
      "Two objectives give a Pareto front. With [scatter], yield may be a goal or an objective: the fraction "
      "of manufactured hoops that reach all the other goals; and worst_case, the least jump height within "
      "uniform tolerances, which is proved of the designs found.\n"
      "Exit status 1: no design meets all goals; the nearest miss is reported and no file is written.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
