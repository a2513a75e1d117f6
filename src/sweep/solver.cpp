// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/solver.hpp"

#include <algorithm>

#include "gait/error_growth.hpp"
#include "gait/settle.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "sweep/map_layout.hpp"

namespace leapmap {

IntegrationOptions integration_options(const Numerics& numerics) {
  IntegrationOptions options = adaptive(resolved_method(numerics), numerics.tolerance);
  if (numerics.absolute_tolerance > 0.0) options.control.absolute = numerics.absolute_tolerance;
  options.control.fixed_step = numerics.fixed_step;
  options.max_steps = numerics.max_steps;
  return options;
}

namespace {

Wanted wanted_of(const Output& output) {
  const auto stored = [&](std::string_view field) { return stores(output, field); };
  const bool of_later_times = std::ranges::any_of(
      output.fields, [](const std::string& field) { return field.starts_with("jump_time_"); });
  return {.first_jump_time = stored("first_jump_time"),
          .jump_time = stored("jump_time") || of_later_times,
          .descent = stored("flight_time") || stored("dip")};
}

bool asks_for(const Spec& spec, bool Field::*kind) {
  return std::ranges::any_of(fields_of(spec.scene),
                             [&](const Field* field) { return field->*kind && stores(spec, *field); });
}

/// Fills in what comes of whole sequences, once the designs are solved; empty: nothing is asked for.
Solver afterwards(const Spec& spec) {
  const double tolerance = spec.numerics.tolerance;
  std::shared_ptr<ErrorGrowth> growth;
  std::shared_ptr<GaitSolver> gaits;
  if (spec.scene.jumps > 1 && stores(spec, *find_field("sequence_condition")))
    growth = std::make_shared<ErrorGrowth>(spec.scene, tolerance);
  if (spec.scene.settle > 0 && asks_for(spec, &Field::of_gait))
    gaits = std::make_shared<GaitSolver>(spec.scene, tolerance);
  if (!growth && !gaits) return {};
  return [growth, gaits](std::span<const Design> designs, std::span<Outcome> outcomes) {
    if (growth) growth->tell(designs, outcomes);
    if (gaits) gaits->solve(designs, outcomes);
  };
}

}  // namespace

Scene scene_asked(const Spec& spec) {
  Scene scene = spec.scene;
  const bool derives = std::ranges::any_of(gradients_of(spec).of, [](const auto& of) { return of.jump > 1; });
  if (!derives && !asks_for(spec, &Field::of_sequence)) scene.jumps = 1;
  return scene;
}

Scene scene_followed(const Spec& spec) {
  Scene scene = scene_asked(spec);
  if (scene.settle > 0 && asks_for(spec, &Field::of_gait)) scene.jumps = std::max(scene.jumps, scene.settle);
  return scene;
}

Solver make_solver(const Spec& spec) {
  const Scene scene = scene_asked(spec);
  const Model& model = model_of(scene);
  Solver solver = resolved_method(spec.numerics) == "exact"
                      ? model.exact(scene, spec.numerics.tolerance, wanted_of(spec.output))
                      : model.integration(scene, integration_options(spec.numerics));
  const Solver after = afterwards(spec);
  if (!after) return solver;
  return [solver = std::move(solver), after](std::span<const Design> designs, std::span<Outcome> outcomes) {
    solver(designs, outcomes);
    after(designs, outcomes);
  };
}

GradientWanted gradients_of(const Spec& spec) {
  GradientWanted wanted;
  for (const std::string& name : spec.output.gradients) wanted.of.push_back(*number_of(*find_field(name)));
  if (wanted.of.empty()) return wanted;
  const std::vector<std::string>& by = spec.output.gradients_by;
  for (std::size_t k = 0; k < differentiable.size(); ++k) {
    const auto parameter = std::ranges::find_if(parameters(), [&](const Parameter& row) {
      const auto* member = std::get_if<double Design::*>(&row.member);
      return member && *member == differentiable[k];
    });
    if (has(spec.scene.friction, parameter->only_of) &&
        (by.empty() || std::ranges::find(by, parameter->name) != by.end()))
      wanted.by.push_back(k);
  }
  return wanted;
}

GradientSolver make_gradient_solver(const Spec& spec) {
  const GradientWanted asked = gradients_of(spec);
  if (asked.of.empty())
    return [solver = make_solver(spec)](std::span<const Design> designs, std::span<Outcome> outcomes,
                                        Gradients&) { solver(designs, outcomes); };
  const Scene scene = scene_asked(spec);
  GradientSolver solver =
      model_of(scene).gradients(scene, spec.numerics.tolerance, wanted_of(spec.output), asked);
  const Solver after = afterwards(spec);
  if (!after) return solver;
  return [solver = std::move(solver), after](std::span<const Design> designs, std::span<Outcome> outcomes,
                                             Gradients& gradients) {
    solver(designs, outcomes, gradients);
    after(designs, outcomes);
  };
}

Solver make_solver(const Spec& spec, std::string_view method, double tolerance) {
  const Model& model = model_of(spec.scene);
  return method == "exact" ? model.exact(spec.scene, tolerance, {})
                           : model.integration(spec.scene, adaptive(method, tolerance));
}

Motion tell(const Spec& spec, double interval) {
  const Model& model = model_of(spec.scene);
  Motion motion =
      resolved_method(spec.numerics) == "exact"
          ? model.tell_exactly(spec.design, spec.scene, spec.numerics.tolerance, interval)
          : model.tell_by_integration(spec.design, spec.scene, integration_options(spec.numerics), interval);
  Spec everything = spec;
  everything.output.fields.clear();
  for (const Field* field : fields_of(spec.scene)) everything.output.fields.emplace_back(field->name);
  if (const Solver after = afterwards(everything)) after({&spec.design, 1}, {&motion.outcome, 1});
  return motion;
}

Motion tell(const Spec& spec, std::string_view method, double tolerance) {
  const Model& model = model_of(spec.scene);
  return method == "exact"
             ? model.tell_exactly(spec.design, spec.scene, tolerance, 0.0)
             : model.tell_by_integration(spec.design, spec.scene, adaptive(method, tolerance), 0.0);
}

}  // namespace leapmap
