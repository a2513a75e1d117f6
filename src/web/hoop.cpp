// SPDX-License-Identifier: GPL-3.0-or-later
/// One hoop, its motion and its gradient.
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <variant>

#include "friction/gradient.hpp"
#include "friction/model.hpp"
#include "model/parameters.hpp"
#include "noslip/gradient.hpp"
#include "noslip/model.hpp"
#include "trajectory/way.hpp"
#include "web/page.hpp"

namespace leapmap::web {
namespace {

/// What a point of the motion holds, in this order; lengths in m, times in s, forces in weights.
constexpr std::array column_names{"t", "phi", "spin", "x", "y", "normal_force", "friction", "phase"};
/// Likewise a lift-off.
constexpr std::array lift_off_names{"time",      "angle",       "spin", "height",
                                    "apex_time", "flight_time", "dip",  "is_jump"};

/// The models' motions, in the order of Friction.
constexpr std::array tells{noslip::tell_exactly, friction::tell_exactly};

/// The last solve's.
struct SolvedHoop {
  Outcome outcome;
  std::string text;
  std::vector<std::array<double, column_names.size()>> points;
  std::vector<std::array<double, lift_off_names.size()>> lift_offs;
  std::vector<double> gradient;  // by each of parameters
};
SolvedHoop told;

template <std::size_t n>
const char* name_in(const std::array<const char*, n>& names, int i) {
  return i >= 0 && static_cast<std::size_t>(i) < n ? names[static_cast<std::size_t>(i)] : nullptr;
}

}  // namespace

/// Names by number, null after the last.
LEAPMAP_EXPORT const char* column_name(int i) { return name_in(column_names, i); }
LEAPMAP_EXPORT const char* lift_off_name(int i) { return name_in(lift_off_names, i); }

/// Solves the design to a tolerance of times, and its motion every `interval` [s]; 0: as often as a picture
/// needs, 400 to 4,000 times in all. friction: a Friction's number.
LEAPMAP_EXPORT void solve(int friction, double tolerance, double interval) {
  const Design design = page.design();
  const Scene scene = page.scene(friction);
  const auto tell = tells.at(static_cast<std::size_t>(friction));
  const double second = time_unit(scene);
  if (!(interval > 0.0)) {
    const double end = tell(design, scene, tolerance, std::numeric_limits<double>::infinity()).end;
    interval = std::max({std::min(0.03 * second, end / 400.0), end / 4000.0, 1e-12 * second});
  }
  const Motion motion = tell(design, scene, tolerance, interval);
  told.outcome = motion.outcome;
  tell_more(scene, tolerance, {&design, 1}, {&told.outcome, 1});
  const auto ways = scene.friction == Friction::coulomb ? friction::ways : noslip::ways;
  ContactState<double> at = released<double>(design);
  Outcome again;
  ways(scene, tolerance)(Start::release, {&design, 1}, {&at, 1}, {&again, 1});
  if (same_flags(again, told.outcome))
    for (const WayRow<double>& row : way_rows<double>) told.outcome.*row.kept = again.*row.kept;
  told.points.clear(), told.lift_offs.clear();
  for (const MotionPoint& point : motion.points)
    told.points.push_back({point.t, point.phi, point.spin, point.x, point.y, point.normal_force,
                           point.friction, static_cast<double>(point.phase)});
  for (const Candidate& flown : motion.candidates)
    told.lift_offs.push_back({flown.t, flown.phi, flown.spin * second, flown.height, flown.apex_time,
                              flown.flight_time, flown.dip, flown.is_jump ? 1.0 : 0.0});
}

/// A field of the outcome as the map stores it; NaN where it does not apply, or is a text.
LEAPMAP_EXPORT double field_value(int i) { return stored_number(field_of(i), told.outcome); }

/// A field that is a text: the status, the sequence of phases. Null: it is a number.
LEAPMAP_EXPORT const char* field_text(int i) {
  const Field& field = field_of(i);
  if (field.name == "status") return name_of(told.outcome.status).data();
  if (!std::holds_alternative<Word>(field.source)) return nullptr;
  told.text = phase_letters(told.outcome.phase_sequence);
  return told.text.c_str();
}

/// The derivatives of a field of the first jump by each parameter, in parameters' order and both in their
/// units; NaN: there is none, as leapmap/gradient.hpp says. The field is a quantity.
LEAPMAP_EXPORT const double* gradient(int friction, double tolerance, int field) {
  Scene scene = page.scene(friction);
  scene.jumps = 1;
  const auto all = hoop_parameters();
  told.gradient.assign(all.size(), Outcome::none);
  const auto of = number_of(field_of(field));
  if (!of) return told.gradient.data();
  GradientWanted wanted{{*of}, {}};
  for (std::size_t k = 0; k < (scene.friction == Friction::coulomb ? differentiable.size() : without_slip);
       ++k)
    wanted.by.push_back(k);
  Gradients gradients(wanted);
  const Design design = page.design();
  Outcome outcome;
  if (scene.friction == Friction::coulomb)
    CoulombGradients(tolerance).solve({&design, 1}, scene, {&outcome, 1}, gradients);
  else
    RollingGradients(tolerance, {}, wanted).solve({&design, 1}, scene, {&outcome, 1}, gradients);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const std::size_t k : wanted.by)
      if (const auto* member = std::get_if<double Design::*>(&all[i].member);
          member && *member == differentiable[k])
        told.gradient[i] = gradients.column(*of, differentiable[k])[0];
  return told.gradient.data();
}

LEAPMAP_EXPORT int point_count() { return static_cast<int>(told.points.size()); }
LEAPMAP_EXPORT const double* points() { return told.points.empty() ? nullptr : told.points[0].data(); }
LEAPMAP_EXPORT int lift_off_count() { return static_cast<int>(told.lift_offs.size()); }
LEAPMAP_EXPORT const double* lift_offs() {
  return told.lift_offs.empty() ? nullptr : told.lift_offs[0].data();
}

}  // namespace leapmap::web
