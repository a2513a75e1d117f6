// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/place_film.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "film/film_angles.hpp"
#include "film/film_model.hpp"
#include "film/marks.hpp"
#include "film/observations.hpp"
#include "hoop/rolling.hpp"
#include "hoop/sliding.hpp"
#include "hoop/units.hpp"
#include "model/variable.hpp"
#include "numerics/median.hpp"
#include "spec/spacing.hpp"
#include "support/closest.hpp"

namespace leapmap {
namespace {

/// Distances L of the mass from the axis [m], from the least to the most that it may be.
Side length_of(const Spec& spec) {
  const double R = spec.scene.radius;
  const auto axis = std::ranges::find(spec.axes, "offset_ratio", &Axis::key);
  if (axis == spec.axes.end()) return {spec.design.offset_ratio * R, spec.design.offset_ratio * R};
  return {std::ranges::min(axis->values) * R, std::ranges::max(axis->values) * R};
}

std::string place_words(const Track& track) {
  if (track.at == 0.0) return "the hoop's centre";
  if (std::isnan(track.at)) return "the mass, at L";
  return fmt::format("{:.4g} mm from the axis", 1000.0 * track.at);
}

void multiply(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

/// Turns positions so that y is upwards and the hoop moves towards larger x. A hoop that rolls on a plane
/// below it turns clockwise when it moves to the right: with y downwards it seems to turn the other way.
void orient(Film& film, bool y_down, std::vector<std::string>& notes) {
  const auto [centre, mark] = centre_and_mark(film);
  const Track& moving = centre ? *centre : *mark;
  const double moved = moving.x.back() - moving.x.front();
  bool flip = y_down;
  if (!y_down && centre && mark) {
    double turned = 0.0;
    std::optional<double> last;
    for_common_times(*mark, *centre, [&, mark = mark, centre = centre](std::size_t i, std::size_t k) {
      const double angle = std::atan2(mark->y[i] - centre->y[k], mark->x[i] - centre->x[k]);
      if (last) turned += std::remainder(angle - *last, 2.0 * std::numbers::pi);
      last = angle;
    });
    flip = turned * moved > 0.0;
    if (flip) notes.push_back("y is downwards in the film: the hoop would roll the wrong way otherwise");
  }
  for (Track& track : film.tracks) {
    if (flip) multiply(track.y, -1.0);
    if (moved < 0.0) multiply(track.x, -1.0);
  }
  if (moved < 0.0) notes.push_back("the hoop moves to the left in the film: x is mirrored");
}

/// The unit of positions. Where none is stated it is that of m, cm and mm in which the hoop has its size, or
/// else pixels.
void find_unit(Film& film, const std::string& stated, const Spec& spec, double scale,
               std::vector<std::string>& notes, const std::string& origin) {
  const auto [centre, mark] = centre_and_mark(film);
  if (stated == "m" && !std::isnan(scale))
    throw InputError(
        fmt::format("--scale has no effect on {}, whose positions have a unit; allowed: without it", origin));
  if (!mark && stated != "m" && std::isnan(scale))
    throw InputError(
        fmt::format("{}: the centre alone does not show the unit of its positions; allowed: --scale, the "
                    "metres in one, or a header such as x [mm]",
                    origin));
  if (!mark) {
    if (!std::isnan(scale))
      for (Track& track : film.tracks) multiply(track.x, scale), multiply(track.y, scale);
    return;
  }
  const Side length = std::isnan(mark->at) ? length_of(spec) : Side{mark->at, mark->at};
  double shown = 0.0, allowed = 1.5;  // in the film's unit: the distance of the mark from the axis
  if (centre) {
    std::vector<double> apart;
    for_common_times(*mark, *centre, [&, mark = mark, centre = centre](std::size_t i, std::size_t k) {
      apart.push_back(std::hypot(mark->x[i] - centre->x[k], mark->y[i] - centre->y[k]));
    });
    if (apart.size() < 3)
      throw InputError(
          fmt::format("{}: '{}' and '{}' have {} times in common; allowed: tracks of the same frames", origin,
                      mark->name, centre->name, apart.size()));
    shown = median(apart);
  } else {
    const auto [low, high] = std::ranges::minmax(mark->y);
    shown = 0.5 * (high - low), allowed = 6.0;  // its way may be that of a jump, or of a part of a revolution
  }
  if (!std::isnan(scale)) {
    for (Track& track : film.tracks) multiply(track.x, scale), multiply(track.y, scale);
    shown *= scale;
  } else if (stated.empty()) {
    constexpr double close = 1.25;
    for (const auto& [unit, metres] : {std::pair{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}}) {
      const double size = shown * metres, off = centre ? close : 2.5;
      if (length.high > 10.0) break;  // a radius of more is in another unit
      if (!(size < off * length.high && size > length.low / off)) continue;
      for (Track& track : film.tracks) multiply(track.x, metres), multiply(track.y, metres);
      shown *= metres;
      if (metres != 1.0) notes.push_back(fmt::format("positions are in {}, by the size of the hoop", unit));
      break;
    }
  }
  if (!(shown > 0.0))
    throw InputError(
        fmt::format("{}: '{}' does not move; allowed: a film of a hoop that rolls", origin, mark->name));
  const bool fits = shown < allowed * length.high && shown > length.low / allowed;
  if (fits || length.high == 0.0) return;
  const double metres = 0.5 * (length.low + length.high) / shown;
  const bool plausible = length.high < 10.0;  // a radius of more is in another unit
  const bool pixels = plausible && std::isnan(scale) && (stated == "px" || (stated.empty() && shown > 20.0));
  if (!pixels)
    throw InputError(fmt::format(
        "{}: the markers are {:.4g} apart, and L of the hoop is {:.4g} m: another unit? allowed: metres, or "
        "--scale {:.4g} (metres a unit); or the radius of the hoop that was filmed, --set radius=...",
        origin, shown, length.high, metres * (std::isnan(scale) ? 1.0 : scale)));
  film.unit = "px", film.camera.scale = metres;
  notes.push_back(
      fmt::format("positions are in pixels; scale is free, about {:.4g} mm a pixel", 1e3 * metres));
}

/// The angle by which the plane descends in the film: of the line through the centre's way.
double descent_of(const Film& film) {
  const auto [centre, mark] = centre_and_mark(film);
  const Track& track = centre ? *centre : *mark;
  constexpr double rolls = 0.7;  // of the way: the rest may be a jump
  const double end = track.x.front() + rolls * (track.x.back() - track.x.front());
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < track.t.size() && track.x[i] <= end; ++i) {
    const double at_x = track.x[i] - track.x.front(), at_y = track.y[i] - track.y.front();
    n += 1.0, x += at_x, y += at_y, xx += at_x * at_x, xy += at_x * at_y;
  }
  const double spread = xx - x * x / n;
  return spread > 0.0 ? -std::atan((xy - x * y / n) / spread) : 0.0;
}

void find_axes(Film& film, const Spec& spec, std::vector<std::string>& notes) {
  const double descent = descent_of(film), slope = spec.design.slope;
  film.is_level = std::abs(descent) > 0.5 * std::abs(slope) && std::abs(slope) > 0.02;
  film.camera.tilt = 0.0;
  if (!film.is_level && !is_free(film, "tilt")) return;
  film.camera.tilt = descent - (film.is_level ? slope : 0.0);
  if (film.is_level && !is_free(film, "tilt")) film.free.push_back("tilt");
  notes.push_back(fmt::format(
      "axes: {}; the hoop descends by {:.3g} deg, so that tilt, which is free, is about {:.2g} deg",
      film.is_level ? "horizontal" : "along the plane", descent * 180.0 / std::numbers::pi,
      film.camera.tilt * 180.0 / std::numbers::pi));
}

void refuse_unknown_free(const std::vector<std::string>& names, const Film& film) {
  for (const std::string& name : names) {
    const CameraNumber* number = find_camera_number(name);
    if (!number && !find_variable(name, nullptr)) refuse_free_name(name);
    if (!number) continue;
    const bool of_points = name == "scale" || name == "tilt" || number->unit.empty();
    if (of_points == film.tracks.empty() && name != "time_offset")
      throw InputError(
          fmt::format("--free {}: has no effect on a film of {}; allowed: {}", name,
                      film.tracks.empty() ? "angles" : "points",
                      film.tracks.empty() ? "time_offset, angle_offset" : "time_offset, scale, tilt"));
  }
}

/// By how much a free hoop would rotate from rest in that time at least: by rolling, or by sliding with
/// little friction or much, where it may hardly rotate [rad].
double least_rotation(const Design& design, double angle, double time) {
  const Hoop<double> hoop = reduce<double>(design);
  const Trig<double> phi = trig(angle);
  const double rolling = angular_acceleration(hoop, phi, 0.0), way = hoop.sin_slope < 0.0 ? -1.0 : 1.0;
  double least = std::abs(rolling);
  for (double mu = 0.05; mu < 1.6 && least > 0.0; mu *= 1.1) {
    const double sliding = sliding_motion(hoop, phi, 0.0, way * mu).angular;
    least = sliding * rolling > 0.0 ? std::min(least, std::abs(sliding)) : 0.0;
  }
  return 0.5 * least * time * time;
}

/// Whether the hoop is held until it leaves its place: a free one would have rotated by much more than the
/// noise. With one track alone, or free masses, that is not known.
bool is_held(const Film& film, const Spec& spec, double leaves) {
  const FilmAngles angles = angles_of(film, spec.design.slope);
  if (angles.t.empty() || !spec.axes.empty()) return true;
  const double scatter = film.tracks.empty()
                             ? scatter_of(observations_of(film), Measured::angle)
                             : scatter_of(observations_of(film), Measured::x) * film.camera.scale /
                                   (spec.design.offset_ratio * spec.scene.radius + 1e-9);
  const double time = (leaves - angles.t.front()) / time_unit(spec.scene);
  constexpr double times_noise = 20.0, rounding = 1e-3;
  return least_rotation(spec.design, angles.phi.front(), time) > times_noise * scatter + rounding;
}

}  // namespace

void refuse_free_name(const std::string& name) {
  std::vector<std::string_view> all;
  for (const CameraNumber& number : camera_numbers)
    if (!number.unit.empty()) all.push_back(number.name);
  for (const Parameter& parameter : parameters())
    if (std::holds_alternative<double Design::*>(parameter.member)) all.push_back(parameter.name);
  throw InputError(fmt::format("--free {}: is no parameter of a fit{}; allowed: {}", name,
                               did_you_mean(name, all), fmt::join(all, ", ")));
}

std::optional<double> leaves_at(const Film& film, double slope, double second) {
  constexpr std::size_t first = 5;
  const std::vector<Observation> observations = observations_of(film);
  const Measured kind = film.tracks.empty() ? Measured::angle : Measured::x;
  const double scatter = scatter_of(observations, kind);
  // One series: angles, or the way along x and y of a mark, or of the centre.
  std::vector<double> t, away;
  if (film.tracks.empty()) {
    const FilmAngles angles = angles_of(film, slope);
    if (angles.t.size() < 3 * first) return {};
    const double from = median({angles.phi.begin(), angles.phi.begin() + first});
    t = angles.t;
    for (const double phi : angles.phi) away.push_back(std::abs(phi - from));
  } else {
    const auto [centre, mark] = centre_and_mark(film);
    const Track& track = mark ? *mark : *centre;
    if (track.t.size() < 3 * first) return {};
    const double x = median({track.x.begin(), track.x.begin() + first}),
                 y = median({track.y.begin(), track.y.begin() + first});
    t = track.t;
    for (std::size_t i = 0; i < t.size(); ++i) away.push_back(std::hypot(track.x[i] - x, track.y[i] - y));
  }
  const double still = 6.0 * scatter + (film.tracks.empty() ? 1e-3 : 1e-6 / film.camera.scale);
  std::size_t leaves = away.size();
  while (leaves > 0 && away[leaves - 1] > still) --leaves;
  if (leaves == away.size()) return {};
  constexpr double long_held = 1.0;  // sqrt(R/g): a free hoop may move that little for so long
  if (leaves < 2 * first || t[leaves] - t.front() < long_held * second) return {};
  return t[leaves];
}

Film place_film(const Recording& recording, const Spec& spec, const MeasurementOptions& options,
                std::vector<std::string>& notes) {
  Film film{.t = recording.t,
            .phi = recording.phi,
            .spin = recording.spin,
            .tracks = recording.tracks,
            .error = options.error,
            .allow_gaps = options.allow_gaps};
  const std::string origin = recording.notes.empty()
                                 ? std::string("film")
                                 : recording.notes[0].substr(0, recording.notes[0].find(": "));
  for (const std::string& name : options.free)
    if (find_camera_number(name)) film.free.push_back(name);
  refuse_unknown_free(options.free, film);
  if (film.tracks.empty()) {
    if (!std::isnan(options.scale) || options.y_down || !options.markers.empty())
      throw InputError(origin +
                       ": holds angles; --scale, --y-down and --marker have no effect; allowed: with "
                       "positions");
  } else {
    place_marks(film, spec, options.markers);
    for (const Track& track : film.tracks)
      notes.push_back(fmt::format("'{}' is {}", track.name, place_words(track)));
    orient(film, options.y_down, notes);
    find_unit(film, recording.unit, spec, options.scale, notes, origin);
    if (film.unit == "px" && !is_free(film, "scale")) film.free.push_back("scale");
    find_axes(film, spec, notes);
  }
  const double second = time_unit(spec.scene);
  const auto leaves = leaves_at(film, spec.design.slope, second);
  const double first = observations_of(film).front().t;
  if (is_free(film, "time_offset")) {
    film.camera.time_offset = leaves.value_or(first);
  } else if (leaves && is_held(film, spec, *leaves)) {
    film.free.push_back("time_offset"), film.camera.time_offset = *leaves;
    notes.push_back(
        fmt::format("the hoop is held at first: it has left its place at t = {:.4g} s; time_offset, the time "
                    "of the release, is free",
                    *leaves));
  } else if (constexpr double late = 0.3; !film.tracks.empty() && std::abs(first) > late * second) {
    film.camera.time_offset = first;
    notes.push_back(fmt::format(
        "the release is taken to be the first frame, t = {:.4g} s; --free time_offset if it is not", first));
  }
  return film;
}

}  // namespace leapmap
