// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop for the explorer's page: the exact solver and its motion, compiled to WebAssembly.
///
/// The page writes parameter_values() in place, calls solve, and reads the rest, all of it the last solve's.
/// Names and units are those of `leapmap hop --json`.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coulomb/coulomb.hpp"
#include "coulomb/gradient.hpp"
#include "coulomb/model.hpp"
#include "gait/error_growth.hpp"
#include "gait/settle.hpp"
#include "model/fields.hpp"
#include "model/parameters.hpp"
#include "rolling/exact.hpp"
#include "rolling/gradient.hpp"
#include "rolling/model.hpp"
#include "trajectory/sequence.hpp"

namespace leapmap {
namespace {

/// What a point of the motion holds, in this order; lengths in m, times in s, forces in weights.
constexpr std::array column_names{"t", "phi", "spin", "x", "y", "normal_force", "friction", "phase"};
/// Likewise a lift-off.
constexpr std::array lift_off_names{"time",      "angle",       "spin", "height",
                                    "apex_time", "flight_time", "dip",  "is_jump"};

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

  Design design() const {
    Design design;
    Scene scene;
    fill(design, scene);
    return design;
  }
  Scene scene(int friction) const {
    Design design;
    Scene scene;
    fill(design, scene);
    scene.friction = static_cast<Friction>(friction);
    scene.jumps = jumps, scene.settle = settle;
    return scene;
  }

  std::vector<double> parameters;
  long jumps = 1, settle = 0;
  bool tells_growth = false;
  Outcome outcome;
  std::string text;
  std::vector<std::array<double, column_names.size()>> points;
  std::vector<std::array<double, lift_off_names.size()>> lift_offs;
  std::vector<double> heights;
  std::vector<double> places;    // of a map: two parameters of each design
  std::vector<double> rows;      // of a map: row_fields() of each design
  std::vector<double> gradient;  // by each of parameters

 private:
  void fill(Design& design, Scene& scene) const {
    const auto all = leapmap::parameters();
    for (std::size_t i = 0; i < all.size(); ++i) value_of(all[i], design, scene) = parameters[i];
  }
};
Page page;

/// What a map computed on the page tells of each design: all numbers and codes.
const std::vector<const Field*>& row_fields() {
  static const std::vector<const Field*> fields = [] {
    std::vector<const Field*> fields;
    for (const Field& field : map_fields())
      if (!std::holds_alternative<Word>(field.source)) fields.push_back(&field);
    return fields;
  }();
  return fields;
}

std::size_t status_row() {
  const auto& fields = row_fields();
  return static_cast<std::size_t>(
      std::find_if(fields.begin(), fields.end(), [](const Field* field) { return field->name == "status"; }) -
      fields.begin());
}

Solver first_jump_solver(const Scene& scene, double tolerance) {
  if (scene.friction == Friction::coulomb)
    return one_by_one(std::make_shared<CoulombSolver<double>>(tolerance), scene);
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance), scene](std::span<const Design> designs,
                                                                           std::span<Outcome> outcomes) {
    solver->solve(designs, scene, outcomes);
  };
}

JumpSolver<double> jump_solver(const Scene& scene, double tolerance, const Wanted& wanted = {}) {
  if (scene.friction == Friction::coulomb)
    return jumps_one_by_one<double>(std::make_shared<CoulombSolver<double>>(tolerance), scene);
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance, wanted), scene](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) { solver->solve(start, designs, states, scene, outcomes); };
}

DualJumpSolver dual_solver(const Scene& scene, double tolerance) {
  return scene.friction == Friction::coulomb ? coulomb::dual_jumps(scene, tolerance)
                                             : rolling::dual_jumps(scene, tolerance);
}

/// Fills in what was asked for besides jumps: gaits, and how errors grow.
void tell_more(const Scene& scene, double tolerance, std::span<const Design> designs,
               std::span<Outcome> outcomes) {
  const Scene alone = each_jump_alone(scene);
  if (page.tells_growth && scene.jumps > 1)
    ErrorGrowth(scene, dual_solver(alone, tolerance)).tell(designs, outcomes);
  if (scene.settle > 0)
    GaitSolver(scene, {jump_solver(alone, tolerance, untimed), jump_solver(alone, tolerance),
                       dual_solver(alone, tolerance)})
        .solve(designs, outcomes);
}

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
  const Design design = page.design();
  const Scene scene = page.scene(friction);
  const auto tell = tells.at(static_cast<std::size_t>(friction));
  const double second = time_unit(scene);
  if (!(interval > 0.0)) {
    const double end = tell(design, scene, tolerance, std::numeric_limits<double>::infinity()).end;
    interval = std::max({std::min(0.03 * second, end / 400.0), end / 4000.0, 1e-12 * second});
  }
  const Motion motion = tell(design, scene, tolerance, interval);
  page.outcome = motion.outcome;
  tell_more(scene, tolerance, {&design, 1}, {&page.outcome, 1});
  page.points.clear(), page.lift_offs.clear();
  for (const MotionPoint& point : motion.points)
    page.points.push_back({point.t, point.phi, point.spin, point.x, point.y, point.normal_force,
                           point.friction, static_cast<double>(point.phase)});
  for (const Candidate& flown : motion.candidates)
    page.lift_offs.push_back({flown.t, flown.phi, flown.spin * second, flown.height, flown.apex_time,
                              flown.flight_time, flown.dip, flown.is_jump ? 1.0 : 0.0});
}

/// What solve and solve_places tell of a hoop: so many jumps at most, the gait after `settle` of them if that
/// is above zero, and how errors grow, which only a sequence has.
LEAPMAP_EXPORT void ask(int jumps, int settle, int growth) {
  page.jumps = std::clamp(static_cast<long>(jumps), 1l, most_jumps);
  page.settle = std::max(settle, 0);
  page.tells_growth = growth != 0;
}

/// Lets hoops jump that differ in one parameter, evenly from `from` to `to`: heights()[i * keep + k] is the
/// height of hoop i's jump settle + k + 1 [diameters]; NaN: it makes none. Each may roll as far as the runway
/// to its next landing. Returns how many jumps were made in all.
LEAPMAP_EXPORT int bifurcate(int friction, double tolerance, int parameter, double from, double to, int count,
                             int settle, int keep) {
  Scene scene = page.scene(friction);
  scene.jumps = 1;
  const auto member =
      std::get_if<double Design::*>(&leapmap::parameters()[static_cast<std::size_t>(parameter)].member);
  page.heights.assign(static_cast<std::size_t>(count) * static_cast<std::size_t>(keep), Outcome::none);
  if (!member) return 0;
  const JumpSolver<double> solve = jump_solver(scene, tolerance, untimed);
  std::vector<Design> designs;
  std::vector<ContactState<double>> states;
  std::vector<std::size_t> which;
  for (int i = 0; i < count; ++i) {
    designs.push_back(page.design());
    designs.back().** member = count > 1 ? from + (to - from) * i / (count - 1) : from;
    states.push_back(released<double>(designs.back()));
    which.push_back(static_cast<std::size_t>(i));
  }
  std::vector<Outcome> outcomes;
  int made = 0;
  for (int jump = 0; jump < settle + keep && !designs.empty(); ++jump) {
    outcomes.resize(designs.size());
    solve(jump == 0 ? Start::release : Start::landing, designs, states, outcomes);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      if (outcomes[i].status != Status::jumped || is_beyond(scene, states[i]) || is_of_no_flight(outcomes[i]))
        continue;
      ++made;
      if (jump >= settle)
        page.heights[which[i] * static_cast<std::size_t>(keep) + static_cast<std::size_t>(jump - settle)] =
            outcomes[i].jump_height;
      designs[kept] = designs[i], states[kept] = reduced(states[i]), which[kept] = which[i];
      ++kept;
    }
    designs.resize(kept), states.resize(kept), which.resize(kept);
  }
  return made;
}
LEAPMAP_EXPORT const double* heights() { return page.heights.data(); }

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

/// The derivatives of a field of the first jump by each parameter, in parameters' order and both in their
/// units; NaN: there is none, as leapmap/gradient.hpp says. The field is a quantity.
LEAPMAP_EXPORT const double* gradient(int friction, double tolerance, int field) {
  Scene scene = page.scene(friction);
  scene.jumps = 1;
  const auto all = leapmap::parameters();
  page.gradient.assign(all.size(), Outcome::none);
  const auto of = number_of(map_fields()[static_cast<std::size_t>(field)]);
  if (!of) return page.gradient.data();
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
        page.gradient[i] = gradients.column(*of, differentiable[k])[0];
  return page.gradient.data();
}

/// What rows() holds of each design, in this order; null after the last.
LEAPMAP_EXPORT const char* row_name(int i) {
  const auto& fields = row_fields();
  return i >= 0 && static_cast<std::size_t>(i) < fields.size()
             ? fields[static_cast<std::size_t>(i)]->name.data()
             : nullptr;
}

/// Room for two numbers of each of so many designs, which the page fills in: first and second by turns.
LEAPMAP_EXPORT double* places(int count) {
  page.places.resize(2 * static_cast<std::size_t>(count));
  return page.places.data();
}

/// Solves so many designs, the page's own but for two parameters, whose values are in places(): of each
/// design a row of rows(), as the map stores it; NaN: does not apply. A design that nothing can be with is
/// not_computed.
LEAPMAP_EXPORT void solve_places(int friction, double tolerance, int first, int second, int count) {
  const Scene scene = page.scene(friction);
  const auto all = leapmap::parameters();
  const Parameter &x = all[static_cast<std::size_t>(first)], &y = all[static_cast<std::size_t>(second)];
  const auto member = [](const Parameter& parameter) {
    return std::get_if<double Design::*>(&parameter.member);
  };
  const std::size_t wide = row_fields().size();
  page.rows.assign(static_cast<std::size_t>(count) * wide, Outcome::none);
  if (!member(x) || !member(y)) return;
  std::vector<Design> designs;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const double a = page.places[2 * i], b = page.places[2 * i + 1];
    page.rows[i * wide + status_row()] = static_cast<double>(Status::not_computed);
    if (!x.range.holds(a) || !y.range.holds(b)) continue;
    designs.push_back(page.design());
    designs.back().**member(x) = a, designs.back().**member(y) = b;
    which.push_back(i);
  }
  std::vector<Outcome> outcomes(designs.size());
  const Solver solve = scene.jumps > 1 ? in_sequence(jump_solver(scene, tolerance), scene)
                                       : first_jump_solver(scene, tolerance);
  solve(designs, outcomes);
  tell_more(scene, tolerance, designs, outcomes);
  for (std::size_t k = 0; k < which.size(); ++k)
    for (std::size_t f = 0; f < wide; ++f)
      page.rows[which[k] * wide + f] = stored_number(*row_fields()[f], outcomes[k]);
}
LEAPMAP_EXPORT const double* rows() { return page.rows.data(); }

LEAPMAP_EXPORT int point_count() { return static_cast<int>(page.points.size()); }
LEAPMAP_EXPORT const double* points() { return page.points.empty() ? nullptr : page.points[0].data(); }
LEAPMAP_EXPORT int lift_off_count() { return static_cast<int>(page.lift_offs.size()); }
LEAPMAP_EXPORT const double* lift_offs() {
  return page.lift_offs.empty() ? nullptr : page.lift_offs[0].data();
}

}  // namespace leapmap
