// SPDX-License-Identifier: GPL-3.0-or-later
#include "request/solver.hpp"

#include <algorithm>
#include <cmath>

#include "gaits/error_growth.hpp"
#include "gaits/settle.hpp"
#include "hoop/units.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "spec/spec.hpp"
#include "trajectory/clearance.hpp"
#include "trajectory/sequence.hpp"
#include "trajectory/way.hpp"

namespace leapmap {

IntegrationOptions integration_options(const Numerics& numerics, const Scene& scene) {
  IntegrationOptions options = adaptive(resolved_method(numerics, scene), numerics.tolerance);
  if (numerics.absolute_tolerance > 0.0) options.control.absolute = numerics.absolute_tolerance;
  options.control.fixed_step = numerics.fixed_step;
  options.max_steps = numerics.max_steps;
  return options;
}

namespace {

constexpr std::string_view semi_analytic = "semi-analytic solver", integrator = "integration in time";

bool is_exact(const Request& request) { return resolved_method(request) == "exact"; }

Wanted wanted_of(const Request& request) {
  Wanted wanted{.first_jump_time = false, .jump_time = false, .descent = false, .landing = false};
  for (const Field* column : request.columns)
    if (column->needs) wanted.*column->needs = true;
  return wanted;
}

/// Whether two solutions make the same jump, as far as errors let them.
bool is_same(const Jump& a, const Jump& b) {
  constexpr double near = 1e-6;
  return std::abs(a.distance - b.distance) <= near * (1.0 + std::abs(a.distance)) &&
         std::abs(a.height - b.height) <= near;
}

/// What `again` has of walls and ways, of as many jumps as both make alike.
void take_measures(const Outcome& again, bool clears, bool ways, Outcome& outcome) {
  std::size_t alike = 0;
  const std::size_t most = std::min(outcome.later_jumps.size(), again.later_jumps.size());
  while (alike < most && is_same(outcome.later_jumps[alike], again.later_jumps[alike])) ++alike;
  for (double Outcome::*const of_robot : {&Outcome::motor_max_torque, &Outcome::efficiency})
    if (ways) outcome.*of_robot = again.*of_robot;
  for (const JumpRow& row : jump_rows) {
    const bool is_wall = row.first == &Outcome::clears_from || row.first == &Outcome::clears_to;
    if (!(is_wall ? clears : ways && is_of_way(row.first))) continue;
    outcome.*row.first = again.*row.first;
    for (std::size_t k = 0; k < alike; ++k)
      outcome.later_jumps[k].*row.later = again.later_jumps[k].*row.later;
  }
}

/// Fills in where walls may stand and what the way to each jump asks: every jump is solved once more, but for
/// the walls of a first one. Empty: nothing of that is asked for.
Solver jump_measures(const Request& request) {
  const auto asks = [&](bool Field::*kind) {
    return std::ranges::any_of(request.columns, [&](const Field* field) {
      return field->*kind && !std::holds_alternative<Derivative>(field->source);
    });
  };
  const Scene scene = scene_asked(request);
  const Model& model = model_of(scene);
  const bool clears = asks(&Field::of_wall), ways = model.ways && asks(&Field::of_way);
  if (!clears && !ways) return {};
  if (!ways && scene.jumps == 1)
    return [scene](std::span<const Design> designs, std::span<Outcome> outcomes) {
      find_clearances(scene, designs, outcomes);
    };
  const double tolerance = std::min(request.numerics.tolerance, 1e-10);
  JumpSolver<double> next = ways          ? model.ways(scene, tolerance)
                            : model.jumps ? model.jumps(scene, tolerance, Wanted{})
                                          : need(model, &Model::integrated_jumps, integrator)(
                                                scene, integration_options(request.numerics, request.scene));
  if (clears)
    next = [next, scene](Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
                         std::span<Outcome> outcomes) {
      next(start, designs, states, outcomes);
      find_clearances(scene, designs, outcomes);
    };
  return
      [scene, clears, ways, sequences = std::make_shared<Sequences<double>>(next),
       again = std::vector<Outcome>()](std::span<const Design> designs, std::span<Outcome> outcomes) mutable {
        again.assign(designs.size(), {});
        sequences->solve(designs, scene, again);
        for (std::size_t i = 0; i < designs.size(); ++i) {
          if (outcomes[i].status != Status::jumped || !same_flags(again[i], outcomes[i])) continue;
          take_measures(again[i], clears, ways, outcomes[i]);
        }
      };
}

/// And the derivatives of what clearances follow from.
GradientWanted with_flights(GradientWanted wanted) {
  for (double Outcome::*const number : numbers_of_flights())
    if (!wanted.wants(number)) wanted.of.push_back(number);
  return wanted;
}

}  // namespace

Solver follow_up(const Request& request) {
  const double tolerance = request.numerics.tolerance;
  std::shared_ptr<ErrorGrowth> growth;
  std::shared_ptr<GaitSolver> gaits;
  if (request.scene.jumps > 1 && wants(request, "sequence_condition"))
    growth = std::make_shared<ErrorGrowth>(request.scene, tolerance);
  if (wants_gaits(request)) gaits = std::make_shared<GaitSolver>(request.scene, tolerance);
  const Solver measures = jump_measures(request);
  if (!growth && !gaits && !measures) return {};
  return [growth, gaits, measures](std::span<const Design> designs, std::span<Outcome> outcomes) {
    if (measures) measures(designs, outcomes);
    if (growth) growth->tell(designs, outcomes);
    if (gaits) gaits->solve(designs, outcomes);
  };
}

namespace {

/// Of hoops of the scene's radius.
Solver solver_at_unit_size(const Request& request) {
  const Scene scene = scene_asked(request);
  const Model& model = model_of(scene);
  Solver solver = is_exact(request) ? need(model, &Model::exact, semi_analytic)(
                                          scene, request.numerics.tolerance, wanted_of(request))
                                    : need(model, &Model::integration, integrator)(
                                          scene, integration_options(request.numerics, request.scene));
  const Solver after = follow_up(request);
  if (!after) return solver;
  return [solver = std::move(solver), after](std::span<const Design> designs, std::span<Outcome> outcomes) {
    solver(designs, outcomes);
    after(designs, outcomes);
  };
}

GradientSolver gradient_solver_at_unit_size(const Request& request) {
  const GradientWanted asked = derivatives_of(request);
  if (asked.of.empty())
    return
        [solver = solver_at_unit_size(request)](std::span<const Design> designs, std::span<Outcome> outcomes,
                                                Gradients&) { solver(designs, outcomes); };
  const Scene scene = scene_asked(request);
  const bool clears = asked.wants(&Outcome::clears_from) || asked.wants(&Outcome::clears_to);
  const GradientWanted flights = clears ? with_flights(asked) : asked;
  GradientSolver solver = need(model_of(scene), &Model::gradients, "derivatives")(
      scene, request.numerics.tolerance, wanted_of(request), flights);
  if (const Solver after = follow_up(request))
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

/// Without a resisting torque the derivative by it is that of a small one, against which the hoop must not
/// reverse.
GradientSolver with_small_resistance(GradientSolver solver, Request request) {
  const GradientWanted asked = derivatives_of(request);
  if (std::ranges::find(asked.by, by_resisting_torque) == asked.by.end()) return solver;
  request.columns = {find_field("status")};
  return [solver = std::move(solver), resisted = solver_at_unit_size(request),
          places = std::vector<std::size_t>(), some = std::vector<Design>(), found = std::vector<Outcome>()](
             std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients) mutable {
    solver(designs, outcomes, gradients);
    places.clear(), some.clear();
    constexpr double small = 1e-9;
    for (std::size_t i = 0; i < designs.size(); ++i)
      if (designs[i].resisting_torque == 0.0 && outcomes[i].status == Status::jumped) {
        places.push_back(i), some.push_back(designs[i]);
        some.back().resisting_torque = small;
      }
    found.assign(some.size(), {});
    resisted(some, found);
    for (std::size_t k = 0; k < places.size(); ++k)
      if (found[k].status != Status::jumped) gradients.forget(by_resisting_torque, places[k]);
  };
}

}  // namespace

Solver make_solver(const Request& request) {
  return
      [solver = solver_at_unit_size(request)](std::span<const Design> designs, std::span<Outcome> outcomes) {
        solver(designs, outcomes);
        resize(designs, outcomes);
      };
}

GradientSolver make_gradient_solver(const Request& request) {
  return
      [solver = with_small_resistance(gradient_solver_at_unit_size(request), request), held = request.held](
          std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients) {
        solver(designs, outcomes, gradients);
        resize(designs, outcomes);
        for (std::size_t i = 0; i < designs.size(); ++i)
          if (designs[i].size != 1.0)
            for (const OutcomeNumber& of : gradients.wanted().of)
              if (grows_with_size(of)) gradients.scale(of, i, std::sqrt(designs[i].size));
        for (const SameInSi& one : held)
          for (std::size_t i = 0; i < designs.size(); ++i)
            gradients.scale_by(place_of(one.parameter), i, one.of_hoop(designs[i].mass, designs[i].size));
      };
}

bool can_be_interpolated(const Request& request) {
  const Request sample = request_of_sample(request);
  const Scene& scene = sample.scene;
  const bool one_jump = scene.jumps == 1 && scene.settle == 0;
  const auto is_extreme = [](const Field* field) {
    const auto* made = std::get_if<OfMade>(&field->source);
    return made && made->statistic == Statistic::worst_case;
  };
  return request.scatter.interpolate && one_jump && is_exact(sample) && model_of(scene).slips &&
         std::ranges::none_of(request.columns, is_extreme) &&
         std::ranges::none_of(sample.columns,
                              [](const Field* field) { return field->of_way || field->of_wall; });
}

std::string_view interpolated_along(const Spec& spec, const Request& request) {
  const DesignSpace space(spec);
  if (!wants_samples(request) || !can_be_interpolated(request) || spec.axes.empty() || space.varies_body())
    return {};
  std::vector<Design> row;
  for (std::size_t i = 0; i < spec.axes.back().values.size(); ++i) row.push_back(space.at(i));
  const MadeHoops hoops(request.scatter, request.hoop, request.held, points_of(request.scatter));
  return MadeLine::suits(line_of(row), row, hoops) ? spec.axes.back().key : std::string_view();
}

ScatterSolver scatter_solver_of(const Request& request, std::shared_ptr<const SobolPoints> points,
                                const std::function<Solver(const Request&)>& make) {
  return {request.scatter,
          request.hoop,
          request.held,
          std::move(points),
          request.goals,
          quantities_of(statistics_of(request)),
          make(request_of_sample(request)),
          can_be_interpolated(request)};
}

Motion tell(const Design& design, const Request& request, double interval) {
  const Model& model = model_of(request.scene);
  if (request.scene.jumps > 1 && !is_exact(request))
    need(model, &Model::integrated_jumps, "jumps that begin at a landing");
  Motion motion = is_exact(request) ? need(model, &Model::tell_exactly, semi_analytic)(
                                          design, request.scene, request.numerics.tolerance, interval)
                                    : need(model, &Model::tell_by_integration, integrator)(
                                          design, request.scene,
                                          integration_options(request.numerics, request.scene), interval);
  if (const Solver after = follow_up(request)) after({&design, 1}, {&motion.outcome, 1});
  return motion;
}

}  // namespace leapmap
