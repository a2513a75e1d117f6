// SPDX-License-Identifier: GPL-3.0-or-later
/// Reading measurements, and telling wrong ones before they are fitted.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "film/film_angles.hpp"
#include "film/film_model.hpp"
#include "film/observations.hpp"
#include "film/place_film.hpp"
#include "film/tracker_project.hpp"
#include "hoop/units.hpp"
#include "leapmap/fit.hpp"
#include "model/fields.hpp"
#include "numerics/median.hpp"
#include "support/closest.hpp"
#include "support/csv.hpp"
#include "support/number.hpp"
#include "support/posix.hpp"

namespace leapmap {
namespace {

constexpr std::string_view forms =
    "a film with times and angles, or the positions of points; or a table with the columns event, value, "
    "error";

double to_number(const std::string& cell, const std::string& place, std::string_view column) {
  const auto value = number_in(cell);
  if (!value)
    throw InputError(fmt::format("{}: {} = '{}' is not a number; allowed: a finite number in every line",
                                 place, column, cell));
  return *value;
}

/// Where an event came from.
std::string place_of(const Measurements& measured, std::size_t row) {
  return measured.lines.empty() ? fmt::format("{}: row {}", measured.origin, row + 1)
                                : fmt::format("{}:{}", measured.origin, measured.lines[row]);
}

/// How large a quantity of a hoop may be before it must be in another unit.
struct Size {
  double least, most;
  std::string_view unit;
};

Size size_of(const Field& field, const Spec& spec) {
  constexpr double longest = 60.0, highest = 50.0, fastest = 100.0;
  double release = std::abs(spec.design.release_angle), torque = std::abs(spec.design.drive_torque);
  for (const Axis& axis : spec.axes)
    for (const double value : axis.values) {
      if (axis.key == "release_angle") release = std::max(release, std::abs(value));
      if (axis.key == "drive_torque") torque = std::max(torque, std::abs(value));
    }
  const double farthest = 2.0 * std::numbers::pi * (spec.scene.runway + 1.0);
  const auto& quantity = std::get<Quantity>(field.source);
  if (quantity.measure == Measure::time) return {0.0, longest, "seconds"};
  if (quantity.measure == Measure::height)
    return {field.name == "dip" ? -highest : 0.0, field.name == "dip" ? 0.0 : highest, "hoop diameters"};
  if (field.unit == "rad") return {-release - farthest, release + farthest, "radians"};
  if (field.name.ends_with("_spin")) return {-fastest, fastest, "sqrt(g/R)"};
  if (field.name.ends_with("_distance") || field.name == "jump_range")
    return {-farthest, farthest, "hoop radii"};
  return {-farthest * (1.0 + torque) - fastest, farthest * (1.0 + torque) + fastest, field.unit};
}

void check_event(const Measurements& measured, std::size_t row, const Spec& spec) {
  const auto& [name, value, error] = measured.events[row];
  const std::string place = place_of(measured, row);
  const Field* field = find_field(name);
  const auto* quantity = field ? std::get_if<Quantity>(&field->source) : nullptr;
  if (!quantity) {
    std::vector<std::string_view> names;
    for (const Field& each : map_fields())
      if (std::holds_alternative<Quantity>(each.source)) names.push_back(each.name);
    throw InputError(fmt::format("{}: event '{}' is not a quantity of a map{}; allowed: {}", place, name,
                                 did_you_mean(name, names), fmt::join(names, ", ")));
  }
  if (!(error > 0.0 && std::isfinite(error)))
    throw InputError(
        fmt::format("{}: error = {} of {}; allowed: a standard error above 0", place, error, name));
  Scene scene = spec.scene;
  scene.friction = field->only_of.friction.value_or(scene.friction);  // whichever models are fitted
  if (!has(scene, *field))
    throw InputError(
        fmt::format("{}: {} describes later jumps or gaits; allowed: with "
                    "scene.jumps or [gait]",
                    place, name));
  if (!std::isfinite(value))
    throw InputError(fmt::format("{}: {} = {}; allowed: a finite number", place, name, value));
  const Size size = size_of(*field, spec);
  const double largest = std::max(std::abs(size.least), std::abs(size.most));
  if (!(error <= largest && error >= 1e-12 * largest))
    throw InputError(
        fmt::format("{}: error = {} of {} is not a plausible error; allowed: {}, from {:.4g} to {:.4g}",
                    place, error, name, size.unit, 1e-12 * largest, largest));
  constexpr double errors = 5.0;  // that a measured number may be beyond what there is
  if (!(value >= size.least - errors * error && value <= size.most + errors * error))
    throw InputError(fmt::format("{}: {} = {} looks like {}; allowed: {}, from {:.4g} to {:.4g}", place, name,
                                 value, size.unit == "radians" ? "degrees" : "another unit", size.unit,
                                 size.least, size.most));
}

/// The span of a film, against that of a hoop's motion.
void check_span(const Measurements& measured, const Spec& spec) {
  const std::vector<Observation> observations = observations_of(measured.film);
  const double second = time_unit(spec.scene);
  const bool free = is_free(measured.film, "time_offset");
  const double release = free ? 0.0 : measured.film.camera.time_offset;
  const double first = observations.front().t - release, last = observations.back().t - release;
  if (first < 0.0 && !free)
    throw InputError(
        fmt::format("{}: t = {}; allowed: times since release, at least 0; or --free time_offset",
                    measured.origin, first));
  constexpr double longest = 300.0;  // in sqrt(R/g): a hoop that rolls so long has left any picture
  if (last - (free ? first : 0.0) > longest * second)
    throw InputError(fmt::format(
        "{}: t = {} looks like another unit: {:.3g} s for a hoop that jumps after about {:.2g} s; "
        "allowed: seconds since release",
        measured.origin, last, last, 8.0 * second));
}

void check_gaps(const Measurements& measured, const std::vector<double>& t) {
  if (measured.film.allow_gaps || t.size() < 3) return;
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  const double usual = median(steps);
  constexpr double gap = 5.0;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i] > gap * usual)
      throw InputError(fmt::format(
          "{}: {:.6g} s from t = {} to {}, {:.3g} times the usual: the data have a gap; allowed: even "
          "times, or --allow-gaps",
          measured.origin, steps[i], t[i], t[i + 1], steps[i] / usual));
}

void check_angles(const Measurements& measured, double second) {
  const FilmAngles angles = angles_of(measured.film, 0.0);
  if (angles.t.empty()) return;
  constexpr double fastest = 12.0;  // sqrt(g/R): a spin that no hoop has on the way to a jump
  for (std::size_t i = 1; i < angles.t.size(); ++i)
    if (const double turned = angles.phi[i] - angles.phi[i - 1], passed = angles.t[i] - angles.t[i - 1];
        std::abs(turned) > std::max(fastest / second * passed, 0.5))
      throw InputError(
          fmt::format("{}: phi changes by {:.4g} in {:.4g} s at t = {}, which is faster than any hoop; it "
                      "may be in degrees, or an angle cut off at a turn; allowed: radians that continue over "
                      "revolutions, or a header with a unit, phi [deg]",
                      measured.origin, turned, passed, angles.t[i]));
  constexpr double turns = 2.0 * std::numbers::pi;
  if (std::abs(angles.phi.front()) > 2.0 * turns)
    throw InputError(
        fmt::format("{}: phi = {:.6g} at the beginning looks like degrees; allowed: radians, from "
                    "{:.4g} to {:.4g} there, or a header with a unit, phi [deg]",
                    measured.origin, angles.phi.front(), -2.0 * turns, 2.0 * turns));
  // Degrees of a slow hoop change slowly, too.
  const auto [low, high] = std::ranges::minmax(angles.phi);
  const double passed = angles.t.back() - angles.t.front();
  if (high - low > turns * 4.0 * (1.0 + passed / second / 8.0))
    throw InputError(
        fmt::format("{}: phi goes from {:.4g} to {:.4g} in {:.4g} s: it looks like degrees; allowed: "
                    "radians, or a header with a unit, phi [deg]",
                    measured.origin, low, high, passed));
}

void check_film(const Measurements& measured, const Spec& spec) {
  const Film& film = measured.film;
  if (film.tracks.empty() == film.t.empty())
    throw InputError(fmt::format("{}: has {}; allowed: {}", measured.origin,
                                 film.t.empty() ? "neither angles nor points" : "both angles and points",
                                 forms));
  check_recording({.tracks = film.tracks, .t = film.t, .phi = film.phi, .spin = film.spin}, measured.origin);
  check_gaps(measured, film.t);
  for (const Track& track : film.tracks) check_gaps(measured, track.t);
  if (!std::isnan(film.error) && !(film.error > 0.0 && std::isfinite(film.error)))
    throw InputError(
        fmt::format("{}: error = {}; allowed: a standard error above 0", measured.origin, film.error));
  check_span(measured, spec);
  if (film.tracks.empty()) check_angles(measured, time_unit(spec.scene));
}

/// Whether a file is a table of events rather than a film.
bool is_of_events(const std::string& path) {
  if (is_tracker_project(path)) return false;
  std::string_view bytes, marks = "\xEF\xBB\xBF# \t\"";
  TextFile file(path, forms, std::size_t{1} << 30);
  bytes = file.peek(64);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(marks), bytes.size()));
  return bytes.starts_with("event");
}

std::vector<MeasuredEvent> read_events(const std::string& path, std::vector<long>& lines) {
  CsvFile file(path, fmt::format("measurements: {}", forms));
  constexpr std::array<std::string_view, 3> names{"event", "value", "error"};
  std::array<std::size_t, 3> columns{};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto found = std::ranges::find(file.header(), names[k]);
    if (found == file.header().end() || file.header().size() != names.size())
      throw InputError(fmt::format("{}: columns {}; allowed: event, value, error", file.place(),
                                   fmt::join(file.header(), ", ")));
    columns[k] = static_cast<std::size_t>(found - file.header().begin());
  }
  std::vector<MeasuredEvent> events;
  std::vector<std::string> cells;
  while (file.next(cells)) {
    events.push_back({cells[columns[0]], to_number(cells[columns[1]], file.place(), "value"),
                      to_number(cells[columns[2]], file.place(), "error")});
    lines.push_back(file.line());
  }
  if (events.empty()) throw InputError(path + ": no line after the header; allowed: at least one");
  return events;
}

}  // namespace

void check_measurements(const Measurements& measured, const Spec& spec) {
  const bool film = !measured.film.t.empty() || !measured.film.tracks.empty();
  if (measured.events.empty() != film)
    throw InputError(fmt::format("{}: {}; allowed: {}", measured.origin,
                                 film ? "has events and a film" : "nothing was measured", forms));
  for (std::size_t i = 0; i < measured.events.size(); ++i) check_event(measured, i, spec);
  if (film) check_film(measured, spec);
}

Measurements read_measurements(const std::vector<std::string>& paths, const Spec& spec,
                               const MeasurementOptions& options) {
  Measurements measured{.origin = fmt::format("{}", fmt::join(paths, ", "))};
  if (paths.size() == 1 && is_of_events(paths[0])) {
    if (options.allow_gaps || !std::isnan(options.error) || !std::isnan(options.scale) || options.y_down ||
        !options.markers.empty() || !std::isnan(options.recording.fps) ||
        std::ranges::any_of(options.free, find_camera_number))
      throw InputError(
          paths[0] +
          ": holds events; --error, --allow-gaps, --scale, --y-down, --marker, --fps and numbers of a "
          "camera in --free have no effect; allowed: with a film");
    measured.events = read_events(paths[0], measured.lines);
    return measured;
  }
  measured = measurements_of(read_film(paths, options.recording), spec, options);
  measured.origin = fmt::format("{}", fmt::join(paths, ", "));
  return measured;
}

Measurements measurements_of(const Recording& recording, const Spec& spec,
                             const MeasurementOptions& options) {
  check_recording(recording, "film");
  Measurements measured{.origin = "film"};
  measured.notes = recording.notes;
  measured.film = place_film(recording, spec, options, measured.notes);
  return measured;
}

}  // namespace leapmap
