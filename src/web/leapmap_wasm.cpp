// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop for the explorer's page: the exact solver and its motion, compiled to WebAssembly.
///
/// The page writes parameters() in place, calls solve, and reads the rest, all of it the last solve's. Names
/// and units are those of `leapmap hop --json`.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "map/schema.hpp"
#include "trajectory/story.hpp"

namespace leapmap {
namespace {

struct Parameter {
  const char* name;
  std::variant<double Design::*, double Scene::*> member;
};
constexpr std::array parameter_table{Parameter{"slope", &Design::slope},
                                     Parameter{"mass_ratio", &Design::mass_ratio},
                                     Parameter{"offset_ratio", &Design::offset_ratio},
                                     Parameter{"inertia_factor", &Design::inertia_factor},
                                     Parameter{"release_angle", &Design::release_angle},
                                     Parameter{"release_spin", &Design::release_spin},
                                     Parameter{"mu_static", &Design::mu_static},
                                     Parameter{"mu_kinetic", &Design::mu_kinetic},
                                     Parameter{"restitution", &Design::restitution},
                                     Parameter{"runway", &Scene::runway},
                                     Parameter{"hop_height", &Scene::hop_height},
                                     Parameter{"rest_speed", &Scene::rest_speed},
                                     Parameter{"radius", &Scene::radius},
                                     Parameter{"gravity", &Scene::gravity}};

/// What a point of the motion holds, in this order; lengths in m, times in s, forces in weights.
constexpr std::array column_names{"t", "phi", "spin", "x", "y", "normal_force", "friction", "phase"};
/// Likewise a lift-off.
constexpr std::array lift_off_names{"time", "angle", "spin", "height", "apex_time", "flight_time", "dip"};

/// The page's one design and all that is known of it.
struct Page {
  Page() {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      parameters[i] = std::visit(
          [](auto member) {
            if constexpr (std::is_same_v<decltype(member), double Design::*>)
              return Design{}.*member;
            else
              return Scene{}.*member;
          },
          parameter_table[i].member);
  }

  std::array<double, parameter_table.size()> parameters;
  Outcome outcome;
  double time_unit = 1.0;
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
  return i >= 0 && static_cast<std::size_t>(i) < parameter_table.size()
             ? parameter_table[static_cast<std::size_t>(i)].name
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

/// Their values, which the page sets; at first leapmap's defaults.
LEAPMAP_EXPORT double* parameters() { return page.parameters.data(); }

/// Solves the design to a tolerance of times, and its motion every `interval` [s]; 0: as often as a picture
/// needs, 400 to 4,000 times in all.
LEAPMAP_EXPORT void solve(int with_friction, double tolerance, double interval) {
  Design design;
  Scene scene;
  scene.friction = with_friction ? Friction::coulomb : Friction::sticking;
  for (std::size_t i = 0; i < parameter_table.size(); ++i) {
    if (const auto* of_design = std::get_if<double Design::*>(&parameter_table[i].member))
      design.** of_design = page.parameters[i];
    else
      scene.*std::get<double Scene::*>(parameter_table[i].member) = page.parameters[i];
  }
  const double second = page.time_unit = time_unit(scene);
  interval /= second;
  if (!(interval > 0.0)) {
    const double end = tell_exactly(design, scene, tolerance, std::numeric_limits<double>::infinity()).end;
    interval = std::max({std::min(0.03, end / 400.0), end / 4000.0, 1e-12});
  }
  const Story story = tell_exactly(design, scene, tolerance, interval);
  page.outcome = story.outcome;
  page.points.clear(), page.lift_offs.clear();
  for (const TracePoint& point : story.points)
    page.points.push_back({point.t * second, point.phi, point.spin / second, point.x * scene.radius,
                           point.y * scene.radius, point.normal_force, point.friction,
                           static_cast<double>(point.phase)});
  for (const auto& [lift_off, flight] : story.candidates)
    page.lift_offs.push_back({lift_off.time * second, lift_off.angle, lift_off.spin, flight.height,
                              flight.apex_time * second, flight.flight_time * second, flight.dip});
}

/// A field of the outcome as the map stores it; NaN where it does not apply, or is a text.
LEAPMAP_EXPORT double field_value(int i) {
  const Field& field = map_fields()[static_cast<std::size_t>(i)];
  if (const auto* quantity = std::get_if<Quantity>(&field.source))
    return page.outcome.*quantity->member * quantity->unit(page.time_unit);
  const auto* code = std::get_if<Code>(&field.source);
  return code && code->value(page.outcome) != code->fill ? code->value(page.outcome) : Outcome::none;
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
