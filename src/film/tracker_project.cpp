// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/tracker_project.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <vector>

#include "film/unzip.hpp"
#include "support/number.hpp"
#include "support/posix.hpp"

namespace leapmap {
namespace {

constexpr std::string_view a_project = "a project of Tracker, .trk or .trz";
constexpr std::size_t most_project_bytes = std::size_t{1} << 28;

std::string text_of(const std::string& path) {
  if (path.ends_with(".trz")) {
    const TextFile readable(path, a_project,
                            most_project_bytes);  // says in its own words what is wrong with a file
    return unzipped(path, ".trk", most_project_bytes, a_project);
  }
  return TextFile(path, a_project, most_project_bytes).rest();
}

/// The property of that name of an object; empty: it has none.
pugi::xml_node property(pugi::xml_node object, std::string_view name) {
  for (const pugi::xml_node node : object.children("property"))
    if (node.attribute("name").as_string() == name) return node;
  return {};
}

/// The object that a property holds.
pugi::xml_node object_of(pugi::xml_node object, std::string_view name) {
  return property(object, name).child("object");
}

double number_of(pugi::xml_node object, std::string_view name, double usual) {
  return number_in(property(object, name).text().as_string()).value_or(usual);
}

/// The frame of "[12]".
std::optional<std::size_t> frame_of(pugi::xml_node item) {
  const std::string_view name = item.attribute("name").as_string();
  std::size_t frame = 0;
  if (!name.starts_with('[') || !name.ends_with(']')) return {};
  const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size() - 1, frame);
  constexpr std::size_t most_frames = 1'000'000'000;
  if (error != std::errc() || end != name.data() + name.size() - 1 || frame > most_frames) return {};
  return frame;
}

/// The project's axes in a frame, in pixels of the picture, whose y is downwards.
struct Axes {
  std::size_t frame = 0;  ///< the first one that has them
  double x = 0.0, y = 0.0, angle = 0.0, x_scale = 1.0, y_scale = 1.0;
};

std::vector<Axes> axes_of(pugi::xml_node panel) {
  std::vector<Axes> all;
  for (const pugi::xml_node item : property(object_of(panel, "coords"), "framedata").children("property")) {
    const pugi::xml_node data = item.child("object");
    if (!data || !frame_of(item)) continue;
    all.push_back({*frame_of(item), number_of(data, "xorigin", 0.0), number_of(data, "yorigin", 0.0),
                   number_of(data, "angle", 0.0) * std::numbers::pi / 180.0, number_of(data, "xscale", 1.0),
                   number_of(data, "yscale", 1.0)});
  }
  std::ranges::sort(all, {}, &Axes::frame);
  if (all.empty()) all.push_back({});
  return all;
}

/// Times of frames [s].
struct Clock {
  double start = 0.0, step = 0.0;
  std::size_t first = 0;

  double at(std::size_t frame) const {
    return start + step * (static_cast<double>(frame) - static_cast<double>(first));
  }
};

Clock clock_of(pugi::xml_node panel, const std::string& path) {
  const pugi::xml_node clip = object_of(panel, "videoclip"), control = object_of(panel, "clipcontrol");
  const double milliseconds = number_of(control, "delta_t", 0.0);
  if (!(milliseconds > 0.0))
    throw InputError(fmt::format("{}: delta_t = {} ms from frame to frame; allowed: above 0", path,
                                 property(control, "delta_t").text().as_string("none")));
  return {1e-3 * number_of(clip, "starttime", 0.0), 1e-3 * milliseconds,
          static_cast<std::size_t>(std::clamp(number_of(clip, "startframe", 0.0), 0.0, 1e9))};
}

Track track_of(pugi::xml_node mass, const std::vector<Axes>& axes, const Clock& clock) {
  Track track{.name = property(mass, "name").text().as_string("point")};
  std::vector<std::pair<std::size_t, pugi::xml_node>> frames;
  for (const pugi::xml_node item : property(mass, "framedata").children("property"))
    if (const auto frame = frame_of(item); frame && item.child("object"))
      frames.emplace_back(*frame, item.child("object"));
  std::ranges::sort(frames, {}, [](const auto& one) { return one.first; });
  for (const auto& [frame, point] : frames) {
    const double x = number_of(point, "x", std::nan("")), y = number_of(point, "y", std::nan(""));
    if (std::isnan(x) || std::isnan(y)) continue;
    const auto after = std::ranges::upper_bound(axes, frame, {}, &Axes::frame);
    const Axes& own = after == axes.begin() ? axes.front() : *(after - 1);
    const double right = x - own.x, up = own.y - y, c = std::cos(own.angle), s = std::sin(own.angle);
    track.t.push_back(clock.at(frame));
    track.x.push_back((right * c + up * s) / own.x_scale);
    track.y.push_back((up * c - right * s) / own.y_scale);
  }
  return track;
}

}  // namespace

bool is_tracker_project(std::string_view path) { return path.ends_with(".trk") || path.ends_with(".trz"); }

void add_tracker_project(const std::string& path, Recording& recording) {
  const std::string text = text_of(path);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  const pugi::xml_node panel = document.child("object");
  if (!parsed || !std::string_view(panel.attribute("class").as_string()).ends_with("TrackerPanel"))
    throw InputError(fmt::format("{}: {}; allowed: {}", path,
                                 parsed ? "is no project of Tracker" : parsed.description(), a_project));
  const std::vector<Axes> axes = axes_of(panel);
  const Clock clock = clock_of(panel, path);
  for (const Axes& one : axes)
    if (!(one.x_scale > 0.0 && one.y_scale > 0.0))
      throw InputError(fmt::format("{}: xscale = {}, yscale = {} pixels per unit; allowed: above 0", path,
                                   one.x_scale, one.y_scale));
  const bool calibrated = axes.front().x_scale != 1.0;
  std::vector<std::string> words;
  for (const pugi::xml_node item : property(panel, "tracks").children("property")) {
    const pugi::xml_node mass = item.child("object");
    if (!std::string_view(mass.attribute("class").as_string()).ends_with("PointMass")) continue;
    Track track = track_of(mass, axes, clock);
    if (track.t.empty()) continue;
    const auto frames =
        static_cast<std::size_t>(std::lround((track.t.back() - track.t.front()) / clock.step)) + 1;
    words.push_back(fmt::format(
        "'{}' x, y, {} points{}", track.name, track.t.size(),
        frames > track.t.size() ? fmt::format(", {} frames without one", frames - track.t.size()) : ""));
    recording.tracks.push_back(std::move(track));
  }
  if (words.empty())
    throw InputError(
        fmt::format("{}: has no point mass with points; allowed: a project with a tracked point", path));
  recording.unit = calibrated ? "m" : "px";
  recording.notes.push_back(
      fmt::format("{}: {:.6g} ms from frame to frame; axes at {:g} deg, {}; {}", path, 1e3 * clock.step,
                  axes.front().angle * 180.0 / std::numbers::pi,
                  calibrated ? fmt::format("{:g} px per m", axes.front().x_scale) : "pixels, not calibrated",
                  fmt::join(words, "; ")));
}

}  // namespace leapmap
