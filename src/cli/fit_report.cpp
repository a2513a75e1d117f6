// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/fit_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cli/output.hpp"
#include "cli/spoken.hpp"
#include "film/film_model.hpp"
#include "film/observations.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "support/csv.hpp"

namespace leapmap::cli {
namespace {

/// What hop needs of it.
Spec spec_of(const ModelFit& fit) {
  Spec spec;
  spec.scene = fit.scene;
  return spec;
}

/// With two digits of its error.
std::string told(const FittedParameter& parameter, ShownUnits& units) {
  const CameraNumber* camera = find_camera_number(parameter.name);
  const std::string_view own = camera ? camera->unit : find_option("", parameter.name)->unit;
  const bool angle = own == "rad";
  const double unit = angle ? 180.0 / std::numbers::pi : 1.0;
  const std::string_view name = angle ? " deg" : camera && own == "s" ? " s" : camera ? " m per unit" : "";
  if (!parameter.identified)
    return fmt::format("{:>12.6g} not identified: from {:.4g} to {:.4g}{} all fit equally well",
                       parameter.value * unit, parameter.low * unit, parameter.high * unit, name);
  const double error = parameter.error * unit;
  if (error > 0.0 && error < 1e-12)
    return fmt::format("{:>12.6g} +- {:.2g}{}", parameter.value * unit, error, name);
  const int digits = error > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12) : 6;
  return fmt::format("{:>12.{}f} +- {:.{}f}{}{}{}", parameter.value * unit, digits, error, digits, name,
                     angle ? "" : units.beside(parameter.value, parameter.name),
                     parameter.at_bound ? "; at its bound: wider bounds may fit better" : "");
}

/// What was not free.
void print_held(const ModelFit& fit) {
  std::vector<std::string> held;
  for (const Parameter& parameter : parameters()) {
    const auto* member = std::get_if<double Design::*>(&parameter.member);
    if (!member || !has(fit.scene, parameter.only_of) || std::isnan(fit.design.**member) ||
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

/// What would measure a parameter alone.
struct Remedy {
  std::string_view parameter, measurement;
};
constexpr std::array remedies{
    Remedy{"slope", "a spirit level on the plane"},
    Remedy{"resisting_torque", "a film of the hoop as it rolls to rest on level ground"},
    Remedy{"drive_torque", "a torque wrench on the locked motor"},
    Remedy{"mass_ratio", "a balance"},
    Remedy{"offset_ratio", "a ruler from the axis to the mass"},
    Remedy{"inertia_factor", "the period of the hoop as a pendulum"},
    Remedy{"mu_static", "the slope on which the locked hoop begins to slide"},
    Remedy{"mu_kinetic", "a film in which the hoop slides for longer"},
    Remedy{"restitution", "a drop of the hoop on the plane"},
    Remedy{"release_angle", "a picture of the hoop before the release"},
    Remedy{"release_spin", "a film that begins before the release"},
    Remedy{"time_offset", "a film that shows the release"},
    Remedy{"angle_offset", "the reading with the mass at the bottom"},
    Remedy{"scale", "a ruler in the picture"},
    Remedy{"tilt", "a plumb line in the picture"}};

std::string_view remedy_of(std::string_view parameter) {
  const auto found = std::ranges::find(remedies, parameter, &Remedy::parameter);
  return found == remedies.end() ? "another measurement of it" : found->measurement;
}

/// Pairs of parameters of which the data determine little more than one combination.
void print_indistinguishable(const ModelFit& fit) {
  constexpr double alike = 0.98;
  const std::size_t count = fit.parameters.size();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) {
      const double correlation = fit.correlations[i * count + j];
      if (!(std::abs(correlation) > alike)) continue;
      const std::string &one = fit.parameters[i].name, &other = fit.parameters[j].name;
      say("  {} and {} cannot be distinguished: their correlation is {:.4f}. Measure one of them: {}, or "
          "{}.\n",
          one, other, correlation, remedy_of(one), remedy_of(other));
    }
  for (const FittedParameter& parameter : fit.parameters)
    if (!parameter.identified)
      say("  {} is not determined by these data. Measure it: {}.\n", parameter.name,
          remedy_of(parameter.name));
}

/// The bad points of a fit with a robust loss.
void print_outliers(const Measurements& measured, const ModelFit& fit) {
  if (fit.outliers.empty()) return;
  constexpr std::size_t most = 20;
  const std::vector<Observation> observations = observations_of(measured.film);
  say("  {} bad points, which hardly count:", fit.outliers.size());
  for (std::size_t k = 0; k < std::min(most, fit.outliers.size()); ++k) {
    const Observation& one = observations[fit.outliers[k]];
    say("{} {} at {:.6g} s", k > 0 ? "," : "", name_of(one, measured.film), one.t);
  }
  say("{}\n", fit.outliers.size() > most ? ", ..." : "");
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

std::string_view unit_of(Measured kind, const Film& film) {
  return is_position(kind) ? std::string_view(film.unit) : kind == Measured::angle ? "rad" : "rad s-1";
}

/// The number of different times of a film.
std::size_t lines_of(const Film& film) {
  const std::vector<Observation> observations = observations_of(film);
  std::size_t lines = 0;
  for (std::size_t i = 0; i < observations.size(); ++i)
    lines += i == 0 || observations[i].t > observations[i - 1].t;
  return lines;
}

}  // namespace

void print_fit(const Measurements& measured, const ModelFit& fit, ShownUnits& units) {
  say("\nfriction \"{}\": ", model_of(fit.scene).name);
  if (!fit.found) {
    say("{}\n", fit.why.empty() ? "no design within the bounds shows all that was measured" : fit.why);
    return;
  }
  say("{} numbers, {} free parameters, {} starts, {} evaluations\n", fit.residuals.size(),
      fit.parameters.size(), fit.starts, grouped(fit.evaluations));
  for (const FittedParameter& parameter : fit.parameters)
    say("  {:<16} {}\n", parameter.name, told(parameter, units));
  print_held(fit);
  print_correlations(fit);
  const bool film = measured.events.empty();
  if (!film || !std::isnan(measured.film.error))
    say("  chi-square {:.4g} for {} degrees of freedom{}\n", fit.chi_square, fit.degrees,
        fit.degrees == 0
            ? ": each free parameter uses up one number, so a true model passes within their errors"
        : fit.probability > 0.9995
            ? std::string("; a true model nearly always exceeds it: the errors may be too large")
            : fmt::format("; a true model exceeds it in {:.2g} of 100 cases", 100.0 * fit.probability));
  if (film)
    say("  residuals {:.3g} {} rms{}\n", fit.error,
        unit_of(measured.film.tracks.empty() ? Measured::angle : Measured::x, measured.film),
        std::isnan(measured.film.error) ? "; the errors above follow from them" : "");
  if (film && fit.correlation > 1.0 && explains(fit))
    say("  residuals are correlated over {:.3g} lines, as in a smoothed film: {:.3g} of {} lines are "
        "independent, and the errors are widened to match\n",
        fit.correlation, fit.independent, grouped(lines_of(measured.film)));
  if (!fit.judged)
    say("  Too few lines to accept or reject this model; allowed: more lines, or --error.\n");
  else if (!explains(fit))
    say("  This model does not explain the measurements{}. Check slope, radius, masses, L/R{}; or free "
        "them.\n",
        !film || !std::isnan(fit.probability) ? ""
        : runs(fit) ? fmt::format(": neighbouring residuals are alike, as if there were {:.3g} independent "
                                  "lines; another motion would fit better",
                                  fit.independent)
                    : fmt::format(": residuals are {:.3g} times their scatter from line to line", fit.misfit),
        !film ? ""
        : measured.film.tracks.empty()
            ? ", the zero of the angle (--free angle_offset) and of the time (--free time_offset)"
            : ", --marker, --scale, and the time of the release (--free time_offset)");
  print_indistinguishable(fit);
  print_outliers(measured, fit);
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
    say("  the fitted hoop does not jump: {}\n", name_of(fit.outcome.status));
  if (units.are_asked_for()) say("{}", units.lines_of(fit.outcome, fit.scene));
  say("  {}\n", hop_command(spec_of(fit), fit.design));
}

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

void print_as_read(const Measurements& measured) {
  constexpr std::size_t rows = 5;
  for (const std::string& note : measured.notes) say("{}\n", note);
  const Film& film = measured.film;
  for (const Track& track : film.tracks) {
    say("\n'{}'\n{:>12} {:>12} {:>12}\n", track.name, "t [s]", fmt::format("x [{}]", film.unit),
        fmt::format("y [{}]", film.unit));
    for (std::size_t i = 0; i < std::min(rows, track.t.size()); ++i)
      say("{:>12.6g} {:>12.6g} {:>12.6g}\n", track.t[i], track.x[i], track.y[i]);
  }
  if (!film.t.empty())
    say("\n{:>12} {:>12} {:>12}\n", "t [s]", "phi [rad]", film.spin.empty() ? "" : "spin [rad/s]");
  for (std::size_t i = 0; i < std::min(rows, film.t.size()); ++i)
    say("{:>12.6g} {:>12.6g} {:>12}\n", film.t[i], film.phi[i],
        film.spin.empty() ? "" : fmt::format("{:.6g}", film.spin[i]));
  for (std::size_t i = 0; i < std::min(rows, measured.events.size()); ++i)
    say("{}: {} = {} +- {}\n", measured.origin, measured.events[i].field, measured.events[i].value,
        measured.events[i].error);
}

Json fit_json(const ModelFit& fit) {
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
          {"outliers", fit.outliers},
          {"probability", fit.probability},
          {"misfit", fit.misfit},
          {"after_landing", fit.after_landing},
          {"why", fit.why},
          {"hop", fit.found ? hop_command(spec_of(fit), fit.design) : ""}};
}

std::string fit_csv(const Measurements& measured, const FitReport& report) {
  std::string text(fit_csv_head);
  for (const ModelFit& fit : report.models)
    if (fit.found) text += fmt::format(",model_{0},residual_{0}", model_of(fit.scene).name);
  text += "\n";
  const std::vector<Observation> observations = observations_of(measured.film);
  const std::size_t numbers = measured.events.size() + observations.size();
  for (std::size_t i = 0; i < numbers; ++i) {
    if (!measured.events.empty())
      text += fmt::format(",{},{},{}", measured.events[i].field, find_field(measured.events[i].field)->unit,
                          measured.events[i].value);
    else
      text +=
          fmt::format("{},{},{},{}", observations[i].t, csv_quoted(name_of(observations[i], measured.film)),
                      unit_of(observations[i].kind, measured.film), observations[i].value);
    for (const ModelFit& fit : report.models)
      if (fit.found) text += fmt::format(",{},{}", fit.model[i], fit.residuals[i]);
    text += "\n";
  }
  return text;
}

}  // namespace leapmap::cli
