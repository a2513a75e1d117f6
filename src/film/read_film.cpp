// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "film/film_columns.hpp"
#include "film/film_table.hpp"
#include "film/tracker_project.hpp"
#include "leapmap/film.hpp"

namespace leapmap {
namespace {

void check_column(const std::string& what, const std::vector<double>& column, std::size_t size, bool gaps) {
  if (column.size() != size)
    throw InputError(
        fmt::format("{}: {} numbers beside {} times; allowed: equal numbers", what, column.size(), size));
  for (std::size_t i = 0; i < size; ++i)
    if (!std::isfinite(column[i]) && !(gaps && std::isnan(column[i])))
      throw InputError(fmt::format("{}: row {}: {} is not a number; allowed: finite numbers{}", what, i + 1,
                                   column[i], gaps ? ", and NaN for none" : ""));
}

void check_times(const std::string& what, const std::vector<double>& t) {
  check_column(what, t, t.size(), false);
  if (t.size() < 3)
    throw InputError(fmt::format("{}: {} rows with numbers; allowed: three or more", what, t.size()));
  for (std::size_t i = 1; i < t.size(); ++i)
    if (!(t[i] > t[i - 1]))
      throw InputError(fmt::format("{}: row {}: t = {} s after {} s; allowed: ascending times", what, i + 1,
                                   t[i], t[i - 1]));
}

}  // namespace

void check_recording(const Recording& recording, const std::string& origin) {
  if (recording.tracks.empty()) check_times(origin, recording.t);
  if (!recording.t.empty()) check_column(origin + ": phi", recording.phi, recording.t.size(), true);
  if (!recording.spin.empty()) check_column(origin + ": spin", recording.spin, recording.t.size(), true);
  if (!recording.t.empty() && std::ranges::all_of(recording.phi, [](double phi) { return std::isnan(phi); }))
    throw InputError(origin + ": no angle at any time; allowed: angles");
  for (const Track& track : recording.tracks) {
    const std::string what = fmt::format("{}: '{}'", origin, track.name);
    check_times(what, track.t);
    check_column(what + " x", track.x, track.t.size(), false);
    check_column(what + " y", track.y, track.t.size(), false);
    if (std::ranges::count(recording.tracks, track.name, &Track::name) > 1)
      throw InputError(
          fmt::format("{}: two tracks are named '{}'; allowed: names of their own", origin, track.name));
  }
}

Recording read_film(const std::vector<std::string>& paths, const RecordingOptions& options) {
  if (paths.empty()) throw InputError("a film: no file is given; allowed: one or more");
  Recording recording;
  for (const std::string& path : paths) {
    const std::string unit = recording.unit;
    const bool first = recording.tracks.empty();
    if (is_tracker_project(path)) {
      if (!std::isnan(options.fps))
        throw InputError(fmt::format(
            "--fps has no effect on {}, which has the time from frame to frame; allowed: without it", path));
      add_tracker_project(path, recording);
      if (!first && recording.unit != unit)
        throw InputError(fmt::format("{}: has positions in {}, the files before it in {}; allowed: one unit",
                                     path, recording.unit, unit.empty() ? "no stated unit" : unit));
    } else {
      add_table(read_film_table(path), options, recording);
    }
    if (!recording.tracks.empty() && !recording.t.empty())
      throw InputError(path + ": the files hold both points and angles; allowed: one of the two");
  }
  check_recording(recording, paths.back());
  return recording;
}

}  // namespace leapmap
