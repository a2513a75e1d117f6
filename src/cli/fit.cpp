// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap fit: the release, friction and torque that explain a measured motion.
#include "leapmap/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/fit_report.hpp"
#include "cli/json.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"
#include "support/output_file.hpp"

namespace leapmap::cli {
namespace {

struct FitArguments {
  std::vector<std::string> inputs;  // films or a table of events, and a spec
  std::string csv, units, model = "both", loss = "squares";
  std::vector<std::string> overrides, free, markers;
  MeasurementOptions reading;
  FitOptions options;
  bool json = false, overwrite = false, dry_run = false;
};

/// Warns of values of the spec that are ignored, because their parameters are fitted by default.
void warn_of_fitted_values(const Spec& spec, const FitReport& report, const std::vector<std::string>& asked) {
  if (!spec.axes.empty()) return;
  for (const char* name : {"release_angle", "release_spin", "mu_static"}) {
    const bool fitted = std::ranges::any_of(report.models, [&](const ModelFit& fit) {
      return std::ranges::find(fit.parameters, name, &FittedParameter::name) != fit.parameters.end();
    });
    const double given = spec.design.*member_of(name);
    if (fitted && given != Design{}.*member_of(name) && std::ranges::find(asked, name) == asked.end())
      tell(fmt::format(
          "{0} is fitted, so its value {1} is ignored; to fix it, choose the free parameters by --free, or "
          "each {{ from, to }}",
          name, given));
  }
}

/// "rim: at=47 mm, angle=0 deg", with or without the track's name.
Marker marker_of(const std::string& text) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(
        fmt::format("--marker '{}': {}; allowed: \"at=47 mm\", \"at=47 mm, angle=0 deg\", and before it "
                    "a track's name with a colon",
                    text, what));
  };
  Marker marker;
  std::string_view rest = text;
  if (const std::size_t colon = rest.find(':'); colon != rest.npos) {
    marker.track = rest.substr(0, colon);
    rest.remove_prefix(colon + 1);
  }
  bool has_place = false;
  while (!rest.empty()) {
    std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
    const std::size_t equals = part.find('=');
    if (equals == part.npos) refuse("a part without '='");
    const std::string_view key = part.substr(0, equals), value = part.substr(equals + 1);
    try {
      if (key == "at")
        marker.at = number_in_own_unit(value, "m", {}), has_place = true;
      else if (key == "angle")
        marker.angle = number_in_own_unit(value, "rad", {});
      else
        refuse(fmt::format("'{}' is unknown", key));
    } catch (const InputError& error) {
      if (std::string_view(error.what()).starts_with("--marker")) throw;
      refuse(error.what());
    }
  }
  if (!has_place) refuse("no place");
  return marker;
}

MeasurementOptions reading_of(const FitArguments& arguments) {
  MeasurementOptions reading = arguments.reading;
  for (const std::string& marker : arguments.markers) reading.markers.push_back(marker_of(marker));
  reading.free = arguments.free;
  return reading;
}

int run(const FitArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  const Model* only = find_model(arguments.model);
  if (only) {
    for (const std::string& set : overrides)
      if (set.starts_with("friction=") || set.starts_with("scene.friction="))
        throw InputError(fmt::format("--model {} and --set {}: both set the friction; allowed: one of them",
                                     arguments.model, set));
    if (only->slips) overrides.insert(overrides.begin(), "scene.friction=" + arguments.model);
  }
  std::vector<std::string> films;
  std::string spec_path;
  for (const std::string& input : arguments.inputs) {
    if (!input.ends_with(".toml")) {
      films.push_back(input);
      continue;
    }
    if (!spec_path.empty())
      throw InputError(fmt::format("{} and {}: two specs; allowed: one", spec_path, input));
    spec_path = input;
  }
  if (films.empty())
    throw InputError(fmt::format(
        "{}: no film or table of events; allowed: leapmap fit FILM [FILM ...] [SPEC.toml]", spec_path));
  const Spec spec = read_given_spec(spec_path, overrides);
  ShownUnits units(arguments.units, scales_of(spec.scene));
  units.refuse_unusable(spec.scene);
  if (arguments.json && !arguments.units.empty())
    throw InputError("--units has no effect with --json; allowed: one of them");
  std::vector<NamedPath> inputs{{"SPEC", spec_path}};
  for (const std::string& film : films) inputs.push_back({"FILM", film});
  const std::array outputs{NamedPath{"--csv", arguments.csv}};
  refuse_same_files(inputs, outputs);
  const Measurements measured = read_measurements(films, spec, reading_of(arguments));
  if (arguments.dry_run) {
    print_as_read(measured);
    return 0;
  }
  FitOptions options = arguments.options;
  if (only) options.models = {only->friction};
  options.free = parameters_among(arguments.free);
  if (arguments.loss == "huber") options.loss = Loss::huber;
  note_signals();
  TextOutput csv("--csv", arguments.csv, fit_csv_head, arguments.overwrite);
  options.stop_requested = [] { return noted_signal() != 0; };
  if (!arguments.json)
    for (const std::string& note : measured.notes) say("{}\n", note);
  FitReport report;
  try {
    report = fit(measured, spec, options);
  } catch (const Stopped&) {
    tell("interrupted; nothing was written");
    return 128 + noted_signal();
  }
  warn_of_fitted_values(spec, report, arguments.free);
  if (arguments.json) {
    Json json{{"seconds", report.seconds}, {"notes", measured.notes}, {"models", Json::array()}};
    for (const ModelFit& one : report.models) json["models"].push_back(fit_json(one));
    say_json(json);
  } else {
    say("{} in {}\n", measured.origin, spoken_duration(report.seconds));
    for (const ModelFit& one : report.models) print_fit(measured, one, units);
    print_preference(report);
  }
  if (!report.models[0].found) return 1;
  if (!arguments.csv.empty()) csv.commit(fit_csv(measured, report));
  return 0;
}

/// How films are read.
void add_film(Command& command, FitArguments& arguments) {
  command.group("Film");
  command.value("--marker", arguments.markers,
                "place of a track on the hoop: \"at=47 mm, angle=0 deg\", or \"NAME: at=47 mm\" for one of "
                "several; may be given again");
  command.value("--fps", arguments.reading.recording.fps, "frames per second, for tables without times")
      .check(number({0.0, 1e300, false}));
  command.value("--loss", arguments.loss, "squares, or huber for films with bad points, which are listed")
      .check(one_of({"squares", "huber"}));
  command.flag("--dry-run", arguments.dry_run, "print how the film was read, with its first rows, and stop");
  command
      .value("--error", arguments.reading.error,
             "standard error of angles [rad], or of positions in the unit of the report, m or px; default: "
             "from the residuals")
      .check(number({0.0, 1e300, false}));
  command
      .value("--scale", arguments.reading.scale,
             "metres per unit of positions; default: found from the size of the hoop")
      .check(number({0.0, 1e300, false}));
  command.flag("--y-down", arguments.reading.y_down,
               "y is downwards, as rows of a picture are; default: found from two tracks");
  command.flag("--allow-gaps", arguments.reading.allow_gaps, "accept films with missing lines");
}

}  // namespace

void add_fit(CommandLine& line, int& status) {
  Command command = line.command("fit", "identify release, friction and torque from a measured motion");
  command.examples({{"leapmap fit sweeps/paper_events.csv", "the four numbers that the paper published"},
                    {"leapmap fit film.csv hoop.toml --set 'mass_ratio={from=1,to=4}' --csv fit.csv",
                     "a film, with a free mass ratio; residuals as a table"}});
  auto arguments = std::make_shared<FitArguments>();
  command
      .value("FILM", arguments->inputs,
             "films of one motion: Tracker .trk, .trz and text, DLTdv, DeepLabCut, Kinovea, an encoder's "
             "log, CSV; or a CSV table with columns event, value, error; and a spec, SPEC.toml, with the "
             "hoop and free parameters { from, to }; default: the paper's hoop")
      .check(named_file())
      .several()
      .required();
  std::vector<std::string> names{"both"};
  for (const std::string_view name : model_names()) names.emplace_back(name);
  command.group("Model");
  command.value("--model", arguments->model, "model to fit; default: both, and report which one is preferred")
      .check(one_of(names));
  add_set(command, arguments->overrides, ", for example radius=0.05 or 'slope={from=0.3,to=0.5}'");
  command.value("--seed", arguments->options.seed, "seed of the initial sample; default: 1")
      .check(whole_number(0, most_seed));
  add_threads(command, arguments->options.threads);
  command.value(
      "--free",
      [arguments](const std::string& text) {
        for (std::size_t from = 0; from <= text.size();) {
          const std::size_t end = std::min(text.find(',', from), text.size());
          if (end > from) arguments->free.push_back(text.substr(from, end - from));
          from = end + 1;
        }
      },
      "what is free, separated by commas: parameters within usual bounds, and of a film time_offset, "
      "angle_offset, scale, tilt");
  add_film(command, *arguments);
  command.group("Output");
  command
      .value("--csv", arguments->csv,
             "write measurements, models and residuals to this CSV file; draw it by python3 -m "
             "leapmap.charts fit")
      .check(named_file());
  command.flag("--overwrite", arguments->overwrite, "allow --csv to replace any file");
  command.flag("--json", arguments->json, "print JSON only");
  command.value("--units", arguments->units,
                "report every quantity of the jump in these units, for example \"mm ms rpm\"");
  command.footer(
      "Free parameters are those of the spec and of --set. Without any these are release_angle, "
      "release_spin and, with friction, mu_static.\n"
      "The angle phi is 0 if the mass touches the plane, and grows downhill. x is along the plane, downhill; "
      "y is away from it. P is the mass, O the hoop's centre.\n"
      "Events are fields of a map, for example jump_time, apex_time, flight_time, jump_height.\n"
      "Exit status 1: no design within the bounds shows all that was measured.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
