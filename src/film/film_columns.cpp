// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>

#include "spec/quantity.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

enum class Role { unused, time, frame, x, y, likelihood, angle, spin };

struct RoleName {
  Role role;
  std::string_view name;
};

constexpr std::array role_names{
    RoleName{Role::time, "t"},
    RoleName{Role::time, "time"},
    RoleName{Role::time, "zeit"},
    RoleName{Role::time, "temps"},
    RoleName{Role::time, "timestamp"},
    RoleName{Role::frame, "frame"},
    RoleName{Role::frame, "frames"},
    RoleName{Role::frame, "step"},
    RoleName{Role::frame, "coords"},
    RoleName{Role::frame, "index"},
    RoleName{Role::frame, "#"},
    RoleName{Role::x, "x"},
    RoleName{Role::y, "y"},
    RoleName{Role::likelihood, "likelihood"},
    RoleName{Role::likelihood, "confidence"},
    RoleName{Role::likelihood, "score"},
    RoleName{Role::angle, "phi"},
    RoleName{Role::angle, "theta"},
    RoleName{Role::angle, "angle"},
    RoleName{Role::angle, "winkel"},
    RoleName{Role::angle, "\xCF\x86"},
    RoleName{Role::angle, "\xCE\xB8"},
    RoleName{Role::spin, "omega"},
    RoleName{Role::spin, "spin"},
    RoleName{Role::spin, "angular velocity"},
    RoleName{Role::spin, "\xCF\x89"},
};

struct Column {
  Role role = Role::unused;
  std::string name{};   ///< as the table has it
  std::string group{};  ///< of the point
  std::string unit{};   ///< in brackets after the name; empty: not stated
};

constexpr std::string_view separators = " _/.";

Role role_of(std::string_view name) {
  const std::string small = lower_case(name);
  for (const RoleName& row : role_names)
    if (row.name == small) return row.role;
  return Role::unused;
}

/// "Weight/X", "pt1_cam1_X", "x_P", "rim x", "x1": a coordinate and the point that it is of.
void split_point(Column& column) {
  const std::string_view name = column.name;
  if (name.size() < 2) return;
  const auto is_mark = [](char c) { return std::string_view(" _/.").find(c) != std::string_view::npos; };
  const auto coordinate = [](char c) { return std::string_view("xXyY").find(c) != std::string_view::npos; };
  const auto take = [&](char c, std::string_view rest) {
    column.role = c == 'x' || c == 'X' ? Role::x : Role::y;
    column.group = trimmed(rest, separators);
  };
  const bool numbered = std::ranges::all_of(name.substr(1), [](char c) { return c >= '0' && c <= '9'; });
  if (coordinate(name.back()) && is_mark(name[name.size() - 2]))
    take(name.back(), name.substr(0, name.size() - 1));
  else if (coordinate(name.front()) && (is_mark(name[1]) || numbered))
    take(name.front(), name.substr(1));
}

/// A header's cell, without its unit in brackets.
Column column_of(std::string_view cell) {
  Column column;
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}})
    if (const std::size_t at = cell.find(open); at != cell.npos && cell.ends_with(close)) {
      column.unit = trimmed(cell.substr(at + 1, cell.size() - at - 2), separators);
      cell = cell.substr(0, at);
    }
  column.name = trimmed(cell, separators);
  column.role = role_of(column.name);
  if (column.role == Role::unused) split_point(column);
  return column;
}

/// The columns by the last line of the header; the line above it has the points' names, from the left on.
std::vector<Column> columns_of(const FilmTable& table) {
  std::vector<Column> columns(table.columns());
  if (table.headers.empty()) return columns;
  const std::vector<std::string>& names = table.headers.back();
  if (names.size() < columns.size())
    throw InputError(fmt::format("{}: {} names above {} columns; allowed: a name for each", table.path,
                                 names.size(), columns.size()));
  for (std::size_t k = 0; k < columns.size() && k < names.size(); ++k) columns[k] = column_of(names[k]);
  if (table.headers.size() < 2) return columns;
  const std::vector<std::string>& groups = table.headers[table.headers.size() - 2];
  std::string group;
  for (std::size_t k = 0; k < columns.size() && k < groups.size(); ++k) {
    if (!groups[k].empty()) group = groups[k];
    if (columns[k].group.empty()) columns[k].group = group;
  }
  return columns;
}

/// How many of the SI's unit a column's unit is; a unit that is not stated counts as one.
double factor_of(const FilmTable& table, const Column& column, std::string_view si) {
  if (column.unit.empty()) return 1.0;
  try {
    return number_in_own_unit(fmt::format("1 {}", column.unit), si, {});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: column '{}': {}; allowed: a unit such as {}", table.path, column.name,
                                 error.what(), si));
  }
}

bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-9; }

/// Times of all rows [s] by the column nearest on the left of a place, or by the frames' numbers.
struct Times {
  std::vector<double> t{};  ///< NaN: none in that row
  std::string words{};
};

Times times_by_frames(const FilmTable& table, const RecordingOptions& options, const Column* column,
                      std::size_t at) {
  if (std::isnan(options.fps))
    throw InputError(fmt::format("{}: has {}, but no times; allowed: with --fps and the frames per second",
                                 table.path, column ? "frame numbers" : "a row for each frame"));
  Times times{.words = fmt::format("frames at {:g} per second", options.fps)};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double frame = column ? table.rows[i][at].value_or(std::nan("")) : static_cast<double>(i);
    times.t.push_back(frame / options.fps);
  }
  return times;
}

Times times_of(const FilmTable& table, const std::vector<Column>& columns, std::size_t place,
               const RecordingOptions& options) {
  const auto nearest = [&](Role role) -> std::optional<std::size_t> {
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (columns[k].role == role && (!found || k < place)) found = k;
    return found;
  };
  const auto time = nearest(Role::time), frame = nearest(Role::frame);
  if (!time) return times_by_frames(table, options, frame ? &columns[*frame] : nullptr, frame.value_or(0));
  if (!std::isnan(options.fps))
    throw InputError(
        fmt::format("--fps has no effect on {}, which has times in column '{}'; allowed: "
                    "without it, or a table without that column",
                    table.path, columns[*time].name));
  const Column& column = columns[*time];
  Times times{.words = column.unit.empty() ? "s" : column.unit};
  double factor = factor_of(table, column, "s");
  std::vector<double> given;
  for (const auto& row : table.rows)
    if (row[*time]) given.push_back(*row[*time]);
  // Programs that write milliseconds without a unit round them.
  if (column.unit.empty() && given.size() > 3 && std::ranges::all_of(given, is_whole)) {
    const double step = (given.back() - given.front()) / static_cast<double>(given.size() - 1);
    if (step < 1.5)
      throw InputError(
          fmt::format("{}: '{}' counts frames or milliseconds; allowed: a header such as '{} [ms]', "
                      "or 'frame' and --fps",
                      table.path, column.name, column.name));
    factor = 1e-3, times.words = "ms (whole numbers)";
  }
  double last = -HUGE_VAL;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double t = table.rows[i][*time].value_or(std::nan("")) * factor;
    if (t <= last)
      throw InputError(fmt::format("{}:{}: {} = {} s after {} s; allowed: ascending times", table.path,
                                   table.lines[i], column.name, t, last));
    if (!std::isnan(t)) last = t;
    times.t.push_back(t);
  }
  return times;
}

struct Point {
  std::string group;
  std::optional<std::size_t> x{}, y{}, likelihood{};
};

std::vector<Point> points_of(const FilmTable& table, const std::vector<Column>& columns) {
  std::vector<Point> points;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& column = columns[k];
    if (column.role != Role::x && column.role != Role::y && column.role != Role::likelihood) continue;
    auto point = std::ranges::find(points, column.group, &Point::group);
    if (point == points.end()) point = points.insert(points.end(), {column.group});
    auto& place = column.role == Role::x ? point->x : column.role == Role::y ? point->y : point->likelihood;
    if (place)
      throw InputError(fmt::format("{}: '{}' of the point '{}' appears twice; allowed: once", table.path,
                                   column.name, column.group));
    place = k;
  }
  std::erase_if(points, [](const Point& point) { return !point.x || !point.y; });
  return points;
}

/// The unit of a point's positions, and what turns them into metres if it is one of length.
double take_unit(const FilmTable& table, const Column& column, Recording& recording) {
  const bool pixels = column.unit == "px" || column.unit == "pixel" || column.unit == "pixels";
  const std::string unit = pixels ? "px" : column.unit.empty() ? "" : "m";
  if (!recording.tracks.empty() && recording.unit != unit)
    throw InputError(fmt::format("{}: positions in {}, others in {}; allowed: one unit for all", table.path,
                                 unit.empty() ? "no stated unit" : unit,
                                 recording.unit.empty() ? "no stated unit" : recording.unit));
  recording.unit = unit;
  return unit == "m" ? factor_of(table, column, "m") : 1.0;
}

std::string stem_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

void add_points(const FilmTable& table, const std::vector<Column>& columns, const std::vector<Point>& points,
                const RecordingOptions& options, Recording& recording) {
  std::vector<std::string> words;
  for (const Point& point : points) {
    const Times times = times_of(table, columns, std::min(*point.x, *point.y), options);
    const double in_x = take_unit(table, columns[*point.x], recording),
                 in_y = take_unit(table, columns[*point.y], recording);
    Track track{.name = point.group.empty() ? stem_of(table.path) : point.group,
                .file = points.size() == 1 ? stem_of(table.path) : std::string()};
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto& row = table.rows[i];
      const bool unlikely =
          point.likelihood && !(row[*point.likelihood].value_or(0.0) >= options.least_likelihood);
      if (unlikely || !row[*point.x] || !row[*point.y] || std::isnan(times.t[i])) continue;
      track.t.push_back(times.t[i]);
      track.x.push_back(in_x * *row[*point.x]), track.y.push_back(in_y * *row[*point.y]);
    }
    const std::string& unit = columns[*point.x].unit;
    words.push_back(
        fmt::format("'{}' x, y{} from columns {}, {}, {} points{}", track.name,
                    unit.empty() ? "" : " in " + unit, *point.x + 1, *point.y + 1, track.t.size(),
                    track.t.size() < table.rows.size()
                        ? fmt::format(", {} frames without one", table.rows.size() - track.t.size())
                        : ""));
    if (words.size() == 1) words[0] = fmt::format("time in {}; {}", times.words, words[0]);
    recording.tracks.push_back(std::move(track));
  }
  recording.notes.push_back(fmt::format("{}: {}", table.path, fmt::join(words, "; ")));
}

void add_angles(const FilmTable& table, const std::vector<Column>& columns, const RecordingOptions& options,
                Recording& recording) {
  if (!recording.t.empty())
    throw InputError(fmt::format("{}: is a second table of angles; allowed: one", table.path));
  const auto find = [&](Role role) { return std::ranges::find(columns, role, &Column::role); };
  const auto angle = find(Role::angle), spin = find(Role::spin);
  const auto place = [&](auto column) { return static_cast<std::size_t>(column - columns.begin()); };
  const Times times = times_of(table, columns, place(angle), options);
  const double in_angle = factor_of(table, *angle, "rad"),
               in_spin = spin == columns.end() ? 1.0 : factor_of(table, *spin, "rad s-1");
  const auto value = [&](const auto& row, auto column, double factor) {
    return row[place(column)] ? factor * *row[place(column)] : std::nan("");
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double phi = value(table.rows[i], angle, in_angle),
                 w = spin == columns.end() ? std::nan("") : value(table.rows[i], spin, in_spin);
    if (std::isnan(times.t[i]) || (std::isnan(phi) && std::isnan(w))) continue;
    recording.t.push_back(times.t[i]), recording.phi.push_back(phi);
    if (spin != columns.end()) recording.spin.push_back(w);
  }
  const auto unit = [](const Column& column, const char* usual) {
    return column.unit.empty() ? std::string(usual) : column.unit;
  };
  recording.notes.push_back(fmt::format(
      "{}: time in {}; angle '{}' in {}{}; {} rows", table.path, times.words, angle->name,
      unit(*angle, "rad"),
      spin == columns.end() ? ""
                            : fmt::format("; angular velocity '{}' in {}", spin->name, unit(*spin, "rad/s")),
      recording.t.size()));
}

/// The first of many names, and not all of long ones.
std::string first_names(const std::vector<std::string>& names) {
  constexpr std::size_t most = 12, longest = 40;
  std::vector<std::string> some;
  for (std::size_t k = 0; k < std::min(most, names.size()); ++k) some.push_back(names[k].substr(0, longest));
  return fmt::format("{}{}", fmt::join(some, ", "), names.size() > most ? ", ..." : "");
}

}  // namespace

void add_table(const FilmTable& table, const RecordingOptions& options, Recording& recording) {
  const std::vector<Column> columns = columns_of(table);
  const std::vector<Point> points = points_of(table, columns);
  const bool has_angle = std::ranges::find(columns, Role::angle, &Column::role) != columns.end();
  if (points.empty() && !has_angle)
    throw InputError(fmt::format(
        "{}: columns {}: none is a point's x and y, or an angle; allowed: a header with names such as t, x, "
        "y, or t, phi",
        table.path,
        table.headers.empty() ? std::string("without names") : first_names(table.headers.back())));
  if (has_angle && !points.empty())
    throw InputError(fmt::format("{}: has both an angle and points; allowed: one of the two", table.path));
  if (has_angle)
    add_angles(table, columns, options, recording);
  else
    add_points(table, columns, points, options, recording);
  std::vector<std::string> unused;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& column = columns[k];
    const auto before = std::span(columns).first(k);
    const bool again = (column.role == Role::angle || column.role == Role::spin) &&
                       std::ranges::find(before, column.role, &Column::role) != before.end();
    if ((column.role == Role::unused && !column.name.empty()) || again) unused.push_back(column.name);
  }
  if (!unused.empty()) recording.notes.back() += fmt::format("; not used: {}", fmt::join(unused, ", "));
}

}  // namespace leapmap
