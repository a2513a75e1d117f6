// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/solver.hpp"

#include <algorithm>

#include "gait/settle.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"

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

}  // namespace

Solver make_solver(const Spec& spec) {
  if (spec.scene.settle > 0) {
    Spec without = spec;
    without.scene.settle = 0;
    return [solver = make_solver(without),
            gaits = std::make_shared<GaitSolver>(spec.scene, spec.numerics.tolerance)](
               std::span<const Design> designs, std::span<Outcome> outcomes) {
      solver(designs, outcomes);
      gaits->solve(designs, outcomes);
    };
  }
  const Model& model = model_of(spec.scene);
  if (resolved_method(spec.numerics) != "exact")
    return model.integration(spec.scene, integration_options(spec.numerics));
  return model.exact(spec.scene, spec.numerics.tolerance, wanted_of(spec.output));
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
  if (spec.scene.settle > 0) {
    Spec without = spec;
    without.scene.settle = 0;
    return [solver = make_gradient_solver(without),
            gaits = std::make_shared<GaitSolver>(spec.scene, spec.numerics.tolerance)](
               std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients) {
      solver(designs, outcomes, gradients);
      gaits->solve(designs, outcomes);
    };
  }
  return model_of(spec.scene).gradients(spec.scene, spec.numerics.tolerance, wanted_of(spec.output), asked);
}

Solver make_solver(const Spec& spec, std::string_view method, double tolerance) {
  const Model& model = model_of(spec.scene);
  return method == "exact" ? model.exact(spec.scene, tolerance, {})
                           : model.integration(spec.scene, adaptive(method, tolerance));
}

Motion tell(const Spec& spec, double interval) {
  const Model& model = model_of(spec.scene);
  return resolved_method(spec.numerics) == "exact"
             ? model.tell_exactly(spec.design, spec.scene, spec.numerics.tolerance, interval)
             : model.tell_by_integration(spec.design, spec.scene, integration_options(spec.numerics),
                                         interval);
}

Motion tell(const Spec& spec, std::string_view method, double tolerance) {
  const Model& model = model_of(spec.scene);
  return method == "exact"
             ? model.tell_exactly(spec.design, spec.scene, tolerance, 0.0)
             : model.tell_by_integration(spec.design, spec.scene, adaptive(method, tolerance), 0.0);
}

}  // namespace leapmap
