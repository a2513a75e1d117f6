// SPDX-License-Identifier: GPL-3.0-or-later
#include "web/page.hpp"

#include <algorithm>
#include <memory>
#include <variant>

#include "friction/coulomb.hpp"
#include "friction/model.hpp"
#include "gaits/error_growth.hpp"
#include "gaits/settle.hpp"
#include "hoop/body.hpp"
#include "noslip/exact.hpp"
#include "noslip/model.hpp"
#include "trajectory/clearance.hpp"

namespace leapmap::web {
namespace {

double& value_of(const Parameter& parameter, Design& design, Scene& scene) {
  const auto* of_design = std::get_if<double Design::*>(&parameter.member);
  return of_design ? design.**of_design : scene.*std::get<double Scene::*>(parameter.member);
}

Solver first_jump_solver(const Scene& scene, double tolerance) {
  if (scene.friction == Friction::coulomb)
    return one_by_one(std::make_shared<CoulombSolver<double>>(tolerance), scene);
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance), scene](std::span<const Design> designs,
                                                                           std::span<Outcome> outcomes) {
    solver->solve(designs, scene, outcomes);
  };
}

DualJumpSolver<StateDual> dual_solver(const Scene& scene, double tolerance) {
  return scene.friction == Friction::coulomb ? friction::state_jumps(scene, tolerance)
                                             : noslip::state_jumps(scene, tolerance);
}

void fill(std::span<const double> values, Design& design, Scene& scene) {
  const auto all = hoop_parameters();
  for (std::size_t i = 0; i < all.size(); ++i) value_of(all[i], design, scene) = values[i];
}

}  // namespace

std::span<const Parameter> hoop_parameters() {
  const auto all = leapmap::parameters();
  const auto first = std::find_if(all.begin(), all.end(), [](const Parameter& parameter) {
    return parameter.only_of.model == Mechanism::pendulum;
  });
  return all.first(static_cast<std::size_t>(first - all.begin()));
}

Page page;

Page::Page() {
  Design design;
  Scene scene;
  for (const Parameter& parameter : hoop_parameters())
    parameters.push_back(value_of(parameter, design, scene));
}

Design Page::design() const {
  Design design;
  Scene scene;
  fill(parameters, design, scene);
  return design;
}

Scene Page::scene(int friction) const {
  Design design;
  Scene scene;
  fill(parameters, design, scene);
  scene.friction = static_cast<Friction>(friction);
  scene.jumps = jumps, scene.settle = settle;
  return scene;
}

const Parameter& parameter_of(int number) { return hoop_parameters()[static_cast<std::size_t>(number)]; }

std::string variable_key(int number) {
  const auto all = hoop_parameters();
  auto at = static_cast<std::size_t>(number);
  if (at < all.size()) return std::string(all[at].name);
  at -= all.size();
  const auto rows = leapmap::body_numbers();
  const auto of_ring = static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [](const BodyNumber& row) { return !row.of_weight(); }));
  if (at < of_ring) return "hoop." + std::string(rows[at].name);
  at -= of_ring;
  const std::size_t of_weight = rows.size() - of_ring;
  return "hoop." + std::to_string(at / of_weight) + "." + std::string(rows[of_ring + at % of_weight].name);
}

std::optional<Variable> variable_of(int number) {
  return find_variable(variable_key(number), page.drawing ? &*page.drawing : nullptr);
}

const Field& field_of(int number) { return map_fields()[static_cast<std::size_t>(number)]; }

const std::vector<const Field*>& row_fields() {
  static const std::vector<const Field*> fields = [] {
    std::vector<const Field*> fields;
    for (const Field& field : map_fields())
      if (!std::holds_alternative<Word>(field.source) && !field.of_way) fields.push_back(&field);
    return fields;
  }();
  return fields;
}

PlacedDesigns placed_designs(int first, int second) {
  PlacedDesigns placed;
  const auto x = variable_of(first), y = variable_of(second);
  if (!x || !y) return placed;
  const Body drawn = page.drawing.value_or(Body{});
  const double drawn_mass = page.drawing ? reduce_checked(drawn).total_mass : 0.0;
  for (std::size_t i = 0; 2 * i < page.places.size(); ++i) {
    const double a = page.places[2 * i], b = page.places[2 * i + 1];
    if (!x->range.holds(a) || !y->range.holds(b)) continue;
    Design design = page.design();
    Body body = drawn;
    x->in(design, body) = a, y->in(design, body) = b;
    const double radius = 0.5 * body.diameter;
    if (std::any_of(body.weights.begin(), body.weights.end(),
                    [radius](const Weight& weight) { return weight.at > radius; }))
      continue;
    if (x->of_body() || y->of_body()) {
      follow_body(body, drawn.diameter, drawn_mass, design);
      hold_in_si(page.held, design.mass, design.size, design);
    }
    placed.designs.push_back(design);
    if (page.drawing) placed.bodies.push_back(body);
    placed.which.push_back(i);
  }
  return placed;
}

JumpSolver<double> jump_solver(const Scene& scene, double tolerance, const Wanted& wanted) {
  if (scene.friction == Friction::coulomb)
    return jumps_one_by_one<double>(std::make_shared<CoulombSolver<double>>(tolerance), scene);
  return [solver = std::make_shared<ExactSolver<Batch>>(tolerance, wanted), scene](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) { solver->solve(start, designs, states, scene, outcomes); };
}

Solver solver_of(const Scene& scene, double tolerance) {
  return scene.jumps > 1 ? in_sequence(jump_solver(scene, tolerance), scene)
                         : first_jump_solver(scene, tolerance);
}

void tell_more(const Scene& scene, double tolerance, std::span<const Design> designs,
               std::span<Outcome> outcomes) {
  if (scene.clear_height > 0.0) find_clearances(scene, designs, outcomes);
  const Scene alone = each_jump_alone(scene);
  if (page.tells_growth && scene.jumps > 1)
    ErrorGrowth(scene, dual_solver(alone, tolerance)).tell(designs, outcomes);
  if (scene.settle > 0)
    GaitSolver(scene, {in_rounds(jump_solver(alone, tolerance, untimed)), jump_solver(alone, tolerance),
                       dual_solver(alone, tolerance), tolerance})
        .solve(designs, outcomes);
}

/// Names by number, null after the last.
LEAPMAP_EXPORT const char* parameter_name(int i) { return name_at(hoop_parameters(), i); }
LEAPMAP_EXPORT const char* field_name(int i) { return name_at(map_fields(), i); }

/// What a code of a field means; null: it is no code, or there is none so large.
LEAPMAP_EXPORT const char* code_name(int field, int code) {
  const auto* codes = std::get_if<leapmap::Code>(&field_of(field).source);
  return codes && static_cast<std::size_t>(code) < codes->names.size()
             ? codes->names[static_cast<std::size_t>(code)].data()
             : nullptr;
}

/// The ranges of parameters.
LEAPMAP_EXPORT double parameter_least(int i) { return parameter_of(i).range.least; }
LEAPMAP_EXPORT double parameter_most(int i) { return parameter_of(i).range.most; }
/// Their values, which the page sets; at first leapmap's defaults.
LEAPMAP_EXPORT double* parameter_values() { return page.parameters.data(); }

/// What solve, solve_places and solve_made tell of a hoop: so many jumps at most, the gait after `settle` of
/// them if that is above zero, and how errors grow, which only a sequence has.
LEAPMAP_EXPORT void ask(int jumps, int settle, int growth) {
  page.jumps = std::clamp(static_cast<long>(jumps), 1l, most_jumps);
  page.settle = std::max(settle, 0);
  page.tells_growth = growth != 0;
}

}  // namespace leapmap::web
