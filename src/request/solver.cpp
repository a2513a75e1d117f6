// SPDX-License-Identifier: GPL-3.0-or-later
#include "request/solver.hpp"

#include <algorithm>

#include "gait/error_growth.hpp"
#include "gait/settle.hpp"
#include "model/model.hpp"
#include "spec/spec.hpp"
#include "trajectory/clearance.hpp"

namespace leapmap {

IntegrationOptions integration_options(const Numerics& numerics) {
  IntegrationOptions options = adaptive(resolved_method(numerics), numerics.tolerance);
  if (numerics.absolute_tolerance > 0.0) options.control.absolute = numerics.absolute_tolerance;
  options.control.fixed_step = numerics.fixed_step;
  options.max_steps = numerics.max_steps;
  return options;
}

namespace {

constexpr std::string_view semi_analytic = "semi-analytic solver", integrator = "integration in time";

bool is_exact(const Request& request) { return resolved_method(request.numerics) == "exact"; }

Wanted wanted_of(const Request& request) {
  Wanted wanted{.first_jump_time = false, .jump_time = false, .descent = false, .landing = false};
  for (const Field* column : request.columns)
    if (column->needs) wanted.*column->needs = true;
  return wanted;
}

/// Fills in what comes of whole flights and sequences, once the designs are solved; empty: nothing is asked
/// for. derives_clearances: they are found elsewhere, with their derivatives.
Solver follow_up(const Request& request, bool derives_clearances = false) {
  const double tolerance = request.numerics.tolerance;
  std::shared_ptr<ErrorGrowth> growth;
  std::shared_ptr<GaitSolver> gaits;
  if (request.scene.jumps > 1 && wants(request, "sequence_condition"))
    growth = std::make_shared<ErrorGrowth>(request.scene, tolerance);
  if (wants_gaits(request)) gaits = std::make_shared<GaitSolver>(request.scene, tolerance);
  const bool clears = !derives_clearances && (wants(request, "clears_from") || wants(request, "clears_to"));
  Solver ways;
  const bool asks_for_ways =
      std::ranges::any_of(request.columns, [](const Field* field) { return field->of_way; });
  if (const auto make_ways = model_of(request.scene).ways; make_ways && asks_for_ways)
    ways = make_ways(request.scene, std::min(tolerance, 1e-10));
  if (!growth && !gaits && !clears && !ways) return {};
  return [growth, gaits, clears, ways, scene = request.scene](std::span<const Design> designs,
                                                              std::span<Outcome> outcomes) {
    if (clears) find_clearances(scene, designs, outcomes);
    if (ways) ways(designs, outcomes);
    if (growth) growth->tell(designs, outcomes);
    if (gaits) gaits->solve(designs, outcomes);
  };
}

/// And the derivatives of what clearances follow from.
GradientWanted with_flights(GradientWanted wanted) {
  for (double Outcome::*const number : numbers_of_flights())
    if (!wanted.wants(number)) wanted.of.push_back(number);
  return wanted;
}

}  // namespace

Solver make_solver(const Request& request) {
  const Scene scene = scene_asked(request);
  const Model& model = model_of(scene);
  Solver solver =
      is_exact(request)
          ? need(model, &Model::exact, semi_analytic)(scene, request.numerics.tolerance, wanted_of(request))
          : need(model, &Model::integration, integrator)(scene, integration_options(request.numerics));
  const Solver after = follow_up(request);
  if (!after) return solver;
  return [solver = std::move(solver), after](std::span<const Design> designs, std::span<Outcome> outcomes) {
    solver(designs, outcomes);
    after(designs, outcomes);
  };
}

GradientSolver make_gradient_solver(const Request& request) {
  const GradientWanted asked = derivatives_of(request);
  if (asked.of.empty())
    return [solver = make_solver(request)](std::span<const Design> designs, std::span<Outcome> outcomes,
                                           Gradients&) { solver(designs, outcomes); };
  const Scene scene = scene_asked(request);
  const bool clears = asked.wants(&Outcome::clears_from) || asked.wants(&Outcome::clears_to);
  const GradientWanted flights = clears ? with_flights(asked) : asked;
  GradientSolver solver = need(model_of(scene), &Model::gradients, "derivatives")(
      scene, request.numerics.tolerance, wanted_of(request), flights);
  if (const Solver after = follow_up(request, clears))
    solver = [solver = std::move(solver), after](std::span<const Design> designs, std::span<Outcome> outcomes,
                                                 Gradients& gradients) {
      solver(designs, outcomes, gradients);
      after(designs, outcomes);
    };
  if (!clears) return solver;
  return [solver = std::move(solver), scene, flown = std::make_shared<Gradients>(flights)](
             std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients) {
    solver(designs, outcomes, *flown);
    gradients.take(*flown, designs.size());
    find_clearances(scene, designs, outcomes, *flown, &gradients);
  };
}

ScatterSolver scatter_solver_of(const Request& request, std::shared_ptr<const SobolPoints> points) {
  return {request.scatter,
          request.hoop,
          std::move(points),
          request.goals,
          quantities_of(statistics_of(request)),
          make_solver(request_of_sample(request))};
}

Motion tell(const Design& design, const Request& request, double interval) {
  const Model& model = model_of(request.scene);
  Motion motion = is_exact(request)
                      ? need(model, &Model::tell_exactly, semi_analytic)(design, request.scene,
                                                                         request.numerics.tolerance, interval)
                      : need(model, &Model::tell_by_integration, integrator)(
                            design, request.scene, integration_options(request.numerics), interval);
  if (const Solver after = follow_up(request)) after({&design, 1}, {&motion.outcome, 1});
  return motion;
}

}  // namespace leapmap
