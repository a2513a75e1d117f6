// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/solver.hpp"

#include "model/model.hpp"

namespace leapmap {

IntegrationOptions integration_options(const Numerics& numerics) {
  IntegrationOptions options = adaptive(resolved_method(numerics), numerics.tolerance);
  if (numerics.absolute_tolerance > 0.0) options.control.absolute = numerics.absolute_tolerance;
  options.control.fixed_step = numerics.fixed_step;
  options.max_steps = numerics.max_steps;
  return options;
}

Solver make_solver(const Spec& spec) {
  const Model& model = model_of(spec.scene);
  if (resolved_method(spec.numerics) != "exact")
    return model.integration(spec.scene, integration_options(spec.numerics));
  const auto stored = [&](std::string_view field) { return stores(spec.output, field); };
  return model.exact(spec.scene, spec.numerics.tolerance,
                     {.first_jump_time = stored("first_jump_time"),
                      .jump_time = stored("jump_time"),
                      .descent = stored("flight_time") || stored("dip")});
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
