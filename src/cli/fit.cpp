// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap fit: the release, friction and torque that explain a measured motion.
#include "leapmap/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "engine/parallel.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "support/output_file.hpp"

namespace leapmap::cli {
namespace {

struct FitArguments {
  std::string data, spec, csv, units, model = "both";
  std::vector<std::string> overrides;
  MeasurementOptions reading;
  FitOptions options;
  bool json = false, overwrite = false;
};

/// What hop needs of it.
Spec spec_of(const ModelFit& fit) {
  Spec spec;
  spec.scene = fit.scene;
  return spec;
}

/// With two digits of its error.
std::string told(const FittedParameter& parameter) {
  const bool angle = find_option("", parameter.name)->unit == "rad";
  const double unit = angle ? 180.0 / std::numbers::pi : 1.0;
  const std::string_view name = angle ? " deg" : "";
  if (!parameter.identified)
    return fmt::format("{:>12.6g} not identified: from {:.4g} to {:.4g}{} all fit equally well",
                       parameter.value * unit, parameter.low * unit, parameter.high * unit, name);
  const double error = parameter.error * unit;
  const int digits = error > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12) : 6;
  return fmt::format("{:>12.{}f} +- {:.{}f}{}{}", parameter.value * unit, digits, error, digits, name,
                     parameter.at_bound ? "; at its bound: wider bounds may fit better" : "");
}

/// What was not free.
void print_held(const ModelFit& fit) {
  std::vector<std::string> held;
  for (const Parameter& parameter : parameters()) {
    const auto* member = std::get_if<double Design::*>(&parameter.member);
    if (!member || !has(fit.scene.friction, parameter.only_of) || std::isnan(fit.design.**member) ||
        std::ranges::find(fit.parameters, parameter.name, &FittedParameter::name) != fit.parameters.end())
      continue;
    const bool angle = parameter.unit == "rad";
    held.push_back(fmt::format("{} {:.6g}{}", parameter.name,
                               fit.design.**member * (angle ? 180.0 / std::numbers::pi : 1.0),
                               angle ? " deg" : ""));
  }
  say("  fixed: {}\n", fmt::join(held, ", "));
}

void print_correlations(const ModelFit& fit) {
  const std::size_t count = fit.parameters.size();
  if (count < 2) return;
  say("  correlations{:>4}", "");
  for (const FittedParameter& parameter : fit.parameters) say(" {:>14}", parameter.name);
  say("\n");
  for (std::size_t i = 0; i < count; ++i) {
    say("    {:<14}", fit.parameters[i].name);
    for (std::size_t j = 0; j < count; ++j) say(" {:>14.3f}", fit.correlations[i * count + j]);
    say("\n");
  }
}

void print_events(const Measurements& measured, const ModelFit& fit) {
  for (std::size_t i = 0; i < measured.events.size(); ++i) {
    const MeasuredEvent& event = measured.events[i];
    const std::string_view unit = find_field(event.field)->unit;
    say("    {:<16} measured {:.6g} +- {:.2g}{}{}, model {:.6g}, {:+.2f} errors off\n", event.field,
        event.value, event.error, unit == "1" ? "" : " ", unit == "1" ? "" : unit, fit.model[i],
        fit.residuals[i]);
  }
}

void print_fit(const Measurements& measured, const ModelFit& fit, ShownUnits& units) {
  say("\nfriction \"{}\": ", model_of(fit.scene).name);
  if (!fit.found) {
    say("{}\n", fit.why.empty() ? "no design within the bounds shows all that was measured" : fit.why);
    return;
  }
  say("{} numbers, {} free parameters, {} starts, {} evaluations\n", fit.residuals.size(),
      fit.parameters.size(), fit.starts, grouped(fit.evaluations));
  for (const FittedParameter& parameter : fit.parameters)
    say("  {:<16} {}\n", parameter.name, told(parameter));
  print_held(fit);
  print_correlations(fit);
  const bool film = measured.events.empty();
  if (!film || !std::isnan(measured.film.error))
    say("  chi-square {:.4g} for {} degrees of freedom{}\n", fit.chi_square, fit.degrees,
        fit.degrees == 0
            ? ": each free parameter uses up one number, so a true model passes within their errors"
            : fmt::format("; a true model exceeds it in {:.2g} of 100 cases", 100.0 * fit.probability));
  if (film)
    say("  residuals {:.3g} {} rms{}\n", fit.error, measured.film.phi.empty() ? "m" : "rad",
        std::isnan(measured.film.error) ? "; the errors above follow from them" : "");
  if (film && fit.correlation > 1.0 && explains(fit))
    say("  residuals are correlated over {:.3g} lines, as in a smoothed film: {:.3g} of {} lines are "
        "independent, and the errors are widened to match\n",
        fit.correlation, fit.independent, grouped(measured.film.t.size()));
  if (!fit.judged)
    say("  Too few lines to accept or reject this model; allowed: more lines, or --error.\n");
  else if (!explains(fit))
    say("  This model does not explain the measurements{}. Check slope, radius, masses, L/R{}; or free "
        "them.\n",
        !film || !std::isnan(fit.probability) ? ""
        : runs(fit) ? fmt::format(": the residuals are systematic, only {:.3g} lines are independent",
                                  fit.independent)
                    : fmt::format(": residuals are {:.3g} times their scatter from line to line", fit.misfit),
        film && measured.film.phi.empty() ? ", --scale, --y-down and the sign of x" : "");
  print_events(measured, fit);
  if (fit.after_landing > 0)
    say("  {} lines of the film are after the model's last landing and are not used: leave them out, or "
        "--set jumps=...{}\n",
        grouped(fit.after_landing),
        fit.scene.jumps > 1 && fit.outcome.sequence_end != Status::jumped
            ? fmt::format("; the sequence ended early, {}, with runway = {}",
                          name_of(fit.outcome.sequence_end), fit.scene.runway)
            : "");
  if (fit.outcome.status == Status::jumped)
    say("  jumps {:.4g} diameters ({:.4g} mm) high, at {:.4g} s\n", fit.outcome.jump_height,
        2000.0 * fit.scene.radius * fit.outcome.jump_height, fit.outcome.jump_time);
  else
    say("  status: {}\n", name_of(fit.outcome.status));
  if (units.are_asked_for()) say("{}", units.lines_of(fit.outcome, fit.scene));
  say("  {}\n", hop_command(spec_of(fit), fit.design));
}

/// Which model the data prefer, by Akaike's weights.
void print_preference(const FitReport& report) {
  if (report.models.size() < 2 || !report.models[1].found || !report.models[0].judged) return;
  if (!explains(report.models[0])) {
    say("\nNeither model explains the data.\n");
    return;
  }
  const double less = report.models[1].information - report.models[0].information;
  say("\nThe data {} \"{}\": Akaike's criterion is {:.4g} less.\n",
      less > 10.0  ? "clearly prefer"
      : less > 2.0 ? "prefer"
                   : "hardly distinguish the models, and slightly prefer",
      model_of(report.models[0].scene).name, less);
}

Json json_of(const ModelFit& fit) {
  Json parameters = Json::object();
  for (const FittedParameter& parameter : fit.parameters)
    parameters[parameter.name] = {
        {"value", parameter.value}, {"error", parameter.error},           {"low", parameter.low},
        {"high", parameter.high},   {"identified", parameter.identified}, {"at_bound", parameter.at_bound}};
  return {{"friction", model_of(fit.scene).name},
          {"found", fit.found},
          {"judged", fit.judged},
          {"explains", explains(fit)},
          {"parameters", parameters},
          {"correlations", fit.correlations},
          {"chi_square", fit.chi_square},
          {"degrees", fit.degrees},
          {"error", fit.error},
          {"information", fit.information},
          {"correlation", fit.correlation},
          {"independent", fit.independent},
          {"model", fit.model},
          {"residuals", fit.residuals},
          {"hop", fit.found ? hop_command(spec_of(fit), fit.design) : ""}};
}

constexpr std::string_view csv_head = "t,quantity,measured";

/// A line of each number measured: what it is, what each model has in its place.
std::string csv_of(const Measurements& measured, const FitReport& report) {
  std::string text(csv_head);
  for (const ModelFit& fit : report.models)
    if (fit.found) text += fmt::format(",model_{0},residual_{0}", model_of(fit.scene).name);
  text += "\n";
  const bool markers = !measured.film.markers[0].empty();
  constexpr std::array<std::string_view, 4> names{"x_P", "y_P", "x_O", "y_O"};
  const std::size_t a_line = markers ? 4 : 1;
  const std::size_t numbers = measured.events.size() + measured.film.t.size() * a_line;
  for (std::size_t i = 0; i < numbers; ++i) {
    if (!measured.events.empty())
      text += fmt::format(",{},{}", measured.events[i].field, measured.events[i].value);
    else if (markers)
      text +=
          fmt::format("{},{},{}", measured.film.t[i / 4], names[i % 4], measured.film.markers[i % 4][i / 4]);
    else
      text += fmt::format("{},phi,{}", measured.film.t[i], measured.film.phi[i]);
    for (const ModelFit& fit : report.models)
      if (fit.found) text += fmt::format(",{},{}", fit.model[i], fit.residuals[i]);
    text += "\n";
  }
  return text;
}

/// Says which of the spec's own values are fitted anew, as it has no free parameters of its own.
void tell_fitted_anew(const Spec& spec) {
  if (!spec.axes.empty()) return;
  for (const char* name : {"release_angle", "release_spin", "mu_static"})
    if (const double given = spec.design.*member_of(name); given != Design{}.*member_of(name))
      tell(
          fmt::format("{0} is fitted, so its value {1} is ignored; to fix it, choose the free parameters, "
                      "each {{ from, to }}",
                      name, given));
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
  const Spec spec = read_given_spec(arguments.spec, overrides);
  ShownUnits units(arguments.units, scales_of(spec.scene));
  units.refuse_unusable(spec.scene);
  if (arguments.json && !arguments.units.empty())
    throw InputError("--units has no effect with --json; allowed: one of them");
  tell_fitted_anew(spec);
  const std::array inputs{NamedPath{"DATA", arguments.data}, NamedPath{"SPEC", arguments.spec}};
  const std::array outputs{NamedPath{"--csv", arguments.csv}};
  refuse_same_files(inputs, outputs);
  const Measurements measured = read_measurements(arguments.data, arguments.reading);
  FitOptions options = arguments.options;
  if (only) options.models = {only->friction};
  note_signals();
  TextOutput csv("--csv", arguments.csv, csv_head, arguments.overwrite);
  options.stop_requested = [] { return noted_signal() != 0; };
  FitReport report;
  try {
    report = fit(measured, spec, options);
  } catch (const Stopped&) {
    tell("interrupted; nothing was written");
    return 128 + noted_signal();
  }
  if (arguments.json) {
    Json json{{"seconds", report.seconds}, {"models", Json::array()}};
    for (const ModelFit& one : report.models) json["models"].push_back(json_of(one));
    say_json(json);
  } else {
    say("{} in {}\n", arguments.data, spoken_duration(report.seconds));
    for (const ModelFit& one : report.models) print_fit(measured, one, units);
    print_preference(report);
  }
  if (!report.models[0].found) return 1;
  if (!arguments.csv.empty()) csv.commit(csv_of(measured, report));
  return 0;
}

}  // namespace

void add_fit(CommandLine& line, int& status) {
  Command command = line.command("fit", "identify release, friction and torque from a measured motion");
  command.examples({{"leapmap fit sweeps/paper_events.csv", "the four numbers that the paper published"},
                    {"leapmap fit film.csv hoop.toml --set 'mass_ratio={from=1,to=4}' --csv fit.csv",
                     "a film, with a free mass ratio; residuals as a table"}});
  auto arguments = std::make_shared<FitArguments>();
  command
      .value(
          "DATA", arguments->data,
          "measurements (CSV); columns t [s since the release], phi [rad]; or t, x_P, y_P, x_O, y_O [m]; or "
          "event, value, error in the unit of the field")
      .required()
      .check(named_file());
  command
      .value("SPEC", arguments->spec,
             "a spec (TOML) with the hoop, and free parameters { from, to }; default: the paper's hoop")
      .check(named_file());
  std::vector<std::string> names{"both"};
  for (const std::string_view name : model_names()) names.emplace_back(name);
  command.group("Model");
  command.value("--model", arguments->model, "model to fit; default: both, and report which one is preferred")
      .check(one_of(names));
  add_set(command, arguments->overrides, ", for example radius=0.05 or 'slope={from=0.3,to=0.5}'");
  command.value("--seed", arguments->options.seed, "seed of the initial sample; default: 1")
      .check(whole_number(0, most_seed));
  add_threads(command, arguments->options.threads);
  command.group("Film");
  command
      .value("--error", arguments->reading.error,
             "standard error of angles [rad] or positions [m]; default: from the residuals")
      .check(number({0.0, 1e300, false}));
  command.value("--scale", arguments->reading.scale, "metres per unit of marker positions, for pixels")
      .check(number({0.0, 1e300, false}));
  command.flag("--y-down", arguments->reading.y_down,
               "marker positions y grow towards the plane, as rows of a picture do");
  command.flag("--allow-gaps", arguments->reading.allow_gaps, "accept films with missing lines");
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
