// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop for the explorer's page: the exact solver and its motion, compiled to WebAssembly.
///
/// The page writes parameter_values() in place, calls solve, and reads the rest, all of it the last solve's.
/// Names and units are those of `leapmap hop --json`.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "coulomb/model.hpp"
#include "model/fields.hpp"
#include "model/parameters.hpp"
#include "rolling/model.hpp"

namespace leapmap {
namespace {

/// What a point of the motion holds, in this order; lengths in m, times in s, forces in weights.
constexpr std::array column_names{"t", "phi", "spin", "x", "y", "normal_force", "friction", "phase"};
/// Likewise a lift-off.
constexpr std::array lift_off_names{"time", "angle", "spin", "height", "apex_time", "flight_time", "dip"};

/// The models' motions, in the order of Friction.
constexpr std::array tells{rolling::tell_exactly, coulomb::tell_exactly};

double& value_of(const Parameter& parameter, Design& design, Scene& scene) {
  const auto* of_design = std::get_if<double Design::*>(&parameter.member);
  return of_design ? design.**of_design : scene.*std::get<double Scene::*>(parameter.member);
}

/// The page's one design and all that is known of it.
struct Page {
  Page() {
    Design design;
    Scene scene;
    for (const Parameter& parameter : leapmap::parameters())
      parameters.push_back(value_of(parameter, design, scene));
  }

  std::vector<double> parameters;
  Outcome outcome;
  std::string text;
  std::vector<std::array<double, column_names.size()>> points;
  std::vector<std::array<double, lift_off_names.size()>> lift_offs;
};
Page page;

template <std::size_t n>
const char* name_in(const std::array<const char*, n>& names, int i) {
  return i >= 0 && static_cast<std::size_t>(i) < n ? names[static_cast<std::size_t>(i)] : nullptr;
}

}  // namespace

#define LEAPMAP_EXPORT extern "C" __attribute__((visibility("default"), used))

/// Names by number, null after the last.
LEAPMAP_EXPORT const char* parameter_name(int i) {
  const auto all = leapmap::parameters();
  return i >= 0 && static_cast<std::size_t>(i) < all.size() ? all[static_cast<std::size_t>(i)].name.data()
                                                            : nullptr;
}
LEAPMAP_EXPORT const char* column_name(int i) { return name_in(column_names, i); }
LEAPMAP_EXPORT const char* lift_off_name(int i) { return name_in(lift_off_names, i); }
LEAPMAP_EXPORT const char* field_name(int i) {
  const auto fields = map_fields();
  return i >= 0 && static_cast<std::size_t>(i) < fields.size()
             ? fields[static_cast<std::size_t>(i)].name.data()
             : nullptr;
}

/// What a code of a field means; null: it is no code, or there is none so large.
LEAPMAP_EXPORT const char* code_name(int field, int code) {
  const auto* codes = std::get_if<leapmap::Code>(&map_fields()[static_cast<std::size_t>(field)].source);
  return codes && static_cast<std::size_t>(code) < codes->names.size()
             ? codes->names[static_cast<std::size_t>(code)].data()
             : nullptr;
}

/// Their ranges.
LEAPMAP_EXPORT double parameter_least(int i) {
  return leapmap::parameters()[static_cast<std::size_t>(i)].range.least;
}
LEAPMAP_EXPORT double parameter_most(int i) {
  return leapmap::parameters()[static_cast<std::size_t>(i)].range.most;
}
/// Their values, which the page sets; at first leapmap's defaults.
LEAPMAP_EXPORT double* parameter_values() { return page.parameters.data(); }

/// Solves the design to a tolerance of times, and its motion every `interval` [s]; 0: as often as a picture
/// needs, 400 to 4,000 times in all. friction: a Friction's number.
LEAPMAP_EXPORT void solve(int friction, double tolerance, double interval) {
  Design design;
  Scene scene;
  scene.friction = static_cast<Friction>(friction);
  const auto all = leapmap::parameters();
  for (std::size_t i = 0; i < all.size(); ++i) value_of(all[i], design, scene) = page.parameters[i];
  const auto tell = tells.at(static_cast<std::size_t>(friction));
  const double second = time_unit(scene);
  if (!(interval > 0.0)) {
    const double end = tell(design, scene, tolerance, std::numeric_limits<double>::infinity()).end;
    interval = std::max({std::min(0.03 * second, end / 400.0), end / 4000.0, 1e-12 * second});
  }
  const Motion motion = tell(design, scene, tolerance, interval);
  page.outcome = motion.outcome;
  page.points.clear(), page.lift_offs.clear();
  for (const MotionPoint& point : motion.points)
    page.points.push_back({point.t, point.phi, point.spin, point.x, point.y, point.normal_force,
                           point.friction, static_cast<double>(point.phase)});
  for (const Candidate& flown : motion.candidates)
    page.lift_offs.push_back({flown.t, flown.phi, flown.spin * second, flown.height, flown.apex_time,
                              flown.flight_time, flown.dip});
}

/// A field of the outcome as the map stores it; NaN where it does not apply, or is a text.
LEAPMAP_EXPORT double field_value(int i) {
  return stored_number(map_fields()[static_cast<std::size_t>(i)], page.outcome);
}

/// A field that is a text: the status, the sequence of phases. Null: it is a number.
LEAPMAP_EXPORT const char* field_text(int i) {
  const Field& field = map_fields()[static_cast<std::size_t>(i)];
  if (field.name == "status") return name_of(page.outcome.status).data();
  if (!std::holds_alternative<Word>(field.source)) return nullptr;
  page.text = phase_letters(page.outcome.phase_sequence);
  return page.text.c_str();
}

LEAPMAP_EXPORT int point_count() { return static_cast<int>(page.points.size()); }
LEAPMAP_EXPORT const double* points() { return page.points.empty() ? nullptr : page.points[0].data(); }
LEAPMAP_EXPORT int lift_off_count() { return static_cast<int>(page.lift_offs.size()); }
LEAPMAP_EXPORT const double* lift_offs() {
  return page.lift_offs.empty() ? nullptr : page.lift_offs[0].data();
}

}  // namespace leapmap
