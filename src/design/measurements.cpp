// SPDX-License-Identifier: GPL-3.0-or-later
/// Reading measurements, and telling wrong ones before they are fitted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "design/correlated.hpp"
#include "leapmap/fit.hpp"
#include "model/fields.hpp"
#include "physics/parameters.hpp"
#include "physics/rolling.hpp"
#include "physics/sliding.hpp"
#include "spec/spacing.hpp"
#include "support/closest.hpp"
#include "support/csv.hpp"
#include "support/number.hpp"
#include "trajectory/units.hpp"

namespace leapmap {
namespace {

constexpr std::string_view forms =
    "columns t, phi; or t, x_P, y_P, x_O, y_O; or event, value, error (times in s, angles in rad, lengths in "
    "m)";
constexpr std::array<std::string_view, 4> marker_names{"x_P", "y_P", "x_O", "y_O"};

double to_number(const std::string& cell, const std::string& place, std::string_view column) {
  const auto value = number_in(cell);
  if (!value)
    throw InputError(fmt::format("{}: {} = '{}' is not a number; allowed: a finite number in every line",
                                 place, column, cell));
  return *value;
}

/// What programs write where a mark was not found.
bool is_no_mark(const std::string& cell) {
  return cell.empty() || cell == "NaN" || cell == "nan" || cell == "NA" || cell == "-";
}

/// Where a number came from.
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
  scene.friction = field->only_of.value_or(scene.friction);  // whichever models are fitted
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

void check_times(const Measurements& measured, double second) {
  const std::vector<double>& t = measured.film.t;
  if (t.size() < 3)
    throw InputError(fmt::format("{}: {} lines; allowed: three or more", measured.origin, t.size()));
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (!(t[i] > t[i - 1]))
      throw InputError(fmt::format("{}: t = {} after {}; allowed: ascending times", place_of(measured, i),
                                   t[i], t[i - 1]));
    steps.push_back(t[i] - t[i - 1]);
  }
  if (t.front() < 0.0)
    throw InputError(fmt::format("{}: t = {}; allowed: times since release, at least 0",
                                 place_of(measured, 0), t.front()));
  constexpr double longest = 300.0;  // in sqrt(R/g): a hoop that rolls so long has left any picture
  if (t.back() > longest * second)
    throw InputError(fmt::format(
        "{}: t = {} looks like another unit: {:.3g} s for a hoop that jumps after about {:.2g} s; "
        "allowed: seconds since release",
        place_of(measured, t.size() - 1), t.back(), t.back(), 8.0 * second));
  std::vector<double> sorted = steps;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double usual = sorted[sorted.size() / 2];
  constexpr double gap = 5.0;
  for (std::size_t i = 0; i < steps.size() && !measured.film.allow_gaps; ++i)
    if (steps[i] > gap * usual)
      throw InputError(
          fmt::format("{}: {:.6g} s after the line before, {:.3g} times the usual: the data have a gap; "
                      "allowed: even times, or "
                      "--allow-gaps",
                      place_of(measured, i + 1), steps[i], steps[i] / usual));
}

void check_angles(const Measurements& measured, double second) {
  const Film& film = measured.film;
  constexpr double fastest = 12.0;  // sqrt(g/R): a spin that no hoop has on the way to a jump
  for (std::size_t i = 1; i < film.t.size(); ++i)
    if (const double turned = film.phi[i] - film.phi[i - 1], passed = film.t[i] - film.t[i - 1];
        std::abs(turned) > std::max(fastest / second * passed, 0.5))
      throw InputError(fmt::format(
          "{}: phi changes by {:.4g} in {:.4g} s, which is faster than any hoop; it may be in degrees, or "
          "an angle cut "
          "off at a turn; allowed: radians that continue over revolutions",
          place_of(measured, i), turned, passed));
  constexpr double turns = 2.0 * std::numbers::pi;
  if (std::abs(film.phi.front()) > 2.0 * turns)
    throw InputError(
        fmt::format("{}: phi = {:.6g} at the beginning looks like degrees; allowed: radians, from "
                    "{:.4g} to {:.4g} there",
                    place_of(measured, 0), film.phi.front(), -2.0 * turns, 2.0 * turns));
  // Degrees of a slow hoop change slowly, too.
  const auto [low, high] = std::ranges::minmax(film.phi);
  if (high - low > 2.0 * std::numbers::pi * 4.0 * (1.0 + (film.t.back() - film.t.front()) / second / 8.0))
    throw InputError(
        fmt::format("{}: phi goes from {:.4g} to {:.4g} in {:.4g} s: it looks like degrees; allowed: radians",
                    measured.origin, low, high, film.t.back() - film.t.front()));
}

/// A film that shows the hoop held before it is let go: it stays where it is for much longer than one that is
/// free does, whose angle grows by half the acceleration times the square of the time.
void check_held(const Measurements& measured, const Spec& spec, double second) {
  const Film& film = measured.film;
  constexpr std::size_t first = 5;
  if (film.phi.size() < 3 * first || !spec.axes.empty()) return;
  std::vector<double> begin(film.phi.begin(), film.phi.begin() + first);
  std::ranges::nth_element(begin, begin.begin() + first / 2);
  const double at = begin[first / 2], scatter = scatter_of(film);
  std::size_t leaves = 0;
  while (leaves < film.phi.size() && !(std::abs(film.phi[leaves] - at) > 6.0 * scatter + 1e-3)) ++leaves;
  if (leaves < 2 * first || leaves == film.phi.size()) return;
  const Hoop<double> hoop = reduce<double>(spec.design);
  // Of rolling, or of sliding down with little friction or much: a hoop may slide and hardly turn.
  const Trig<double> phi = trig(at);
  const double rolling = angular_acceleration(hoop, phi, 0.0), way = hoop.sin_slope < 0.0 ? -1.0 : 1.0;
  double least = std::abs(rolling);
  for (double mu = 0.05; mu < 1.6; mu *= 1.1) {
    const double sliding = sliding_motion(hoop, phi, 0.0, way * mu).angular;
    least = sliding * rolling > 0.0 ? std::min(least, std::abs(sliding)) : 0.0;
    if (least == 0.0) return;
  }
  const double acceleration = least / (second * second);
  const double t = film.t[leaves] - film.t.front();
  if (0.5 * std::abs(acceleration) * t * t > 50.0 * (scatter + 1e-4))
    throw InputError(
        fmt::format("{}: phi stays at {:.4g} for {:.3g} s, in which a free hoop rotates by {:.2g}: "
                    "it is held; allowed: times after the release",
                    place_of(measured, leaves), at, t, 0.5 * std::abs(acceleration) * t * t));
}

/// length: L of the hoop, from the least to the most that it may be.
void check_markers(const Measurements& measured, const Side& length) {
  const auto& [x_P, y_P, x_O, y_O] = measured.film.markers;
  std::vector<double> apart;
  for (std::size_t i = 0; i < x_P.size(); ++i) apart.push_back(std::hypot(x_P[i] - x_O[i], y_P[i] - y_O[i]));
  std::ranges::nth_element(apart, apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2));
  const double median = apart[apart.size() / 2];
  constexpr double off = 1.5;
  if (length.high > 0.0 && !(median < off * length.high && median > length.low / off))
    throw InputError(
        fmt::format("{}: the markers are {:.4g} apart, and L of the hoop is {:.4g} m: another unit? allowed: "
                    "metres, or --scale "
                    "{:.4g} (metres a unit); or the radius of the hoop that was filmed, --set radius=...",
                    measured.origin, median, length.high, length.high / median));
}

void check_film(const Measurements& measured, const Spec& spec) {
  const Film& film = measured.film;
  const double second = time_unit(spec.scene);
  for (const auto* column :
       {&film.t, &film.phi, &film.markers[0], &film.markers[1], &film.markers[2], &film.markers[3]}) {
    if (!column->empty() && column->size() != film.t.size())
      throw InputError(fmt::format("{}: a column of {} numbers beside {} times; allowed: equal numbers",
                                   measured.origin, column->size(), film.t.size()));
    for (std::size_t i = 0; i < column->size(); ++i)
      if (!std::isfinite((*column)[i]))
        throw InputError(fmt::format("{}: {} is not a number; allowed: finite numbers", place_of(measured, i),
                                     (*column)[i]));
  }
  const bool markers =
      std::ranges::none_of(film.markers, [](const std::vector<double>& column) { return column.empty(); });
  if (film.phi.empty() == !markers)
    throw InputError(fmt::format("{}: has {}; allowed: {}", measured.origin,
                                 markers ? "both phi and markers" : "neither phi nor all four markers",
                                 forms));
  if (!std::isnan(film.error) && !(film.error > 0.0 && std::isfinite(film.error)))
    throw InputError(
        fmt::format("{}: error = {}; allowed: a standard error above 0", measured.origin, film.error));
  check_times(measured, second);
  if (!markers) {
    check_angles(measured, second);
    check_held(measured, spec, second);
    return;
  }
  const auto axis = std::ranges::find(spec.axes, "offset_ratio", &Axis::key);
  const double R = spec.scene.radius, fixed = spec.design.offset_ratio;
  check_markers(measured, axis == spec.axes.end()
                              ? Side{fixed * R, fixed * R}
                              : Side{std::ranges::min(axis->values) * R, std::ranges::max(axis->values) * R});
}

/// Where in the header each of these columns stands; nothing if one is missing.
template <std::size_t N>
std::optional<std::array<std::size_t, N>> columns_of(const std::vector<std::string>& header,
                                                     const std::array<std::string_view, N>& names) {
  std::array<std::size_t, N> columns{};
  for (std::size_t k = 0; k < N; ++k) {
    const auto found = std::ranges::find(header, names[k]);
    if (found == header.end()) return {};
    columns[k] = static_cast<std::size_t>(found - header.begin());
  }
  return columns;
}

}  // namespace

void check_measurements(const Measurements& measured, const Spec& spec) {
  if (measured.events.empty() == measured.film.t.empty())
    throw InputError(fmt::format("{}: {}; allowed: {}", measured.origin,
                                 measured.events.empty() ? "nothing was measured" : "has events and a film",
                                 forms));
  for (std::size_t i = 0; i < measured.events.size(); ++i) check_event(measured, i, spec);
  if (!measured.film.t.empty()) check_film(measured, spec);
}

Measurements read_measurements(const std::string& path, const MeasurementOptions& options) {
  CsvFile file(path, fmt::format("measurements as a CSV file, {}", forms));
  Measurements measured{.origin = path};
  measured.film.error = options.error, measured.film.allow_gaps = options.allow_gaps;
  const auto events = columns_of<3>(file.header(), {"event", "value", "error"});
  const auto angle = columns_of<2>(file.header(), {"t", "phi"});
  const auto markers = columns_of<4>(file.header(), marker_names);
  const auto time = columns_of<1>(file.header(), {"t"});
  const std::size_t known = events ? 3 : angle ? 2 : markers && time ? 5 : 0;
  if (known == 0 || known != file.header().size())
    throw InputError(fmt::format("{}: columns {}; allowed: {}", file.place().empty() ? path : file.place(),
                                 fmt::join(file.header(), ", "), forms));
  const bool of_film = options.allow_gaps || !std::isnan(options.error),
             of_markers = options.scale != 1.0 || options.y_down;
  if (events && (of_film || of_markers))
    throw InputError(
        path +
        ": holds events; --error, --allow-gaps, --scale and --y-down have no effect; allowed: with a film");
  if (angle && of_markers)
    throw InputError(path + ": holds angles; --scale and --y-down have no effect; allowed: with markers");
  std::vector<std::string> cells;
  while (file.next(cells)) {
    const std::string& place = file.place();
    if (const auto none = std::ranges::find_if(cells, is_no_mark); !events && none != cells.end()) {
      if (options.allow_gaps) continue;
      throw InputError(
          fmt::format("{}: {} = '{}' is a frame without a mark; allowed: numbers in every line, or "
                      "--allow-gaps",
                      place, file.header()[static_cast<std::size_t>(none - cells.begin())], *none));
    }
    measured.lines.push_back(file.line());
    const auto number = [&](std::size_t column, std::string_view name) {
      return to_number(cells[column], place, name);
    };
    if (events) {
      measured.events.push_back(
          {cells[(*events)[0]], number((*events)[1], "value"), number((*events)[2], "error")});
      continue;
    }
    measured.film.t.push_back(number((*time)[0], "t"));
    if (angle) measured.film.phi.push_back(number((*angle)[1], "phi"));
    for (std::size_t k = 0; markers && k < marker_names.size(); ++k) {
      const bool flipped = options.y_down && marker_names[k].front() == 'y';
      measured.film.markers[k].push_back((flipped ? -1.0 : 1.0) * options.scale *
                                         number((*markers)[k], marker_names[k]));
    }
  }
  if (measured.lines.empty()) throw InputError(path + ": no line after the header; allowed: at least one");
  return measured;
}

}  // namespace leapmap
