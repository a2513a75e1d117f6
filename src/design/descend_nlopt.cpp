// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <nlopt.hpp>

#include "design/descend.hpp"
#include "hoop/units.hpp"
#include "leapmap/errors.hpp"
#include "request/solver.hpp"

namespace leapmap {
namespace {

/// What SLSQP may ask: objective and goals, which are quantities or parameters, with derivatives.
class Slope {
 public:
  explicit Slope(Judge& judge) : judge_(judge) {
    const Question& question = judge.question();
    std::vector<OutcomeNumber> of;
    std::vector<const Field*> columns{find_field("status")};
    const auto ask = [&](const Field* field) {
      if (!field || !std::holds_alternative<Quantity>(field->source)) return;
      if (std::ranges::find(columns, field) != columns.end()) return;
      columns.push_back(field);
      of.push_back(*number_of(*field));
    };
    const Objective& objective = question.objectives[0];
    ask(objective.field);
    for (const Goal& goal : question.one.goals)
      if (const auto* quantity = std::get_if<Quantity>(&find_field(goal.field)->source)) {
        ask(find_field(goal.field));
        const Goal tight = tightened(goal, question.one.numerics.tolerance);
        if (std::isfinite(tight.at_least)) bounds_.push_back({quantity->member, tight.at_least, -1.0});
        if (std::isfinite(tight.at_most)) bounds_.push_back({quantity->member, tight.at_most, 1.0});
      }
    if (of.empty()) return;
    std::vector<std::string> by;
    for (const Variable& parameter : parameters_of(question.designs.variables())) by.push_back(parameter.key);
    for (const std::string& held : question.one.nominal_units)
      if (std::ranges::find(by, held) == by.end()) by.push_back(held);
    std::ranges::copy(derivative_columns(question.one.scene, of, by), std::back_inserter(columns));
    const Request request = request_of(question.one, columns);
    held_ = request.held;
    solver_ = make_gradient_solver(request);
    gradients_ = Gradients(derivatives_of(request));
  }

  /// Goals as inequalities, each at most 0.
  std::size_t bounds() const { return bounds_.size(); }
  /// Best feasible place met so far.
  Place best;

  double objective(const std::vector<double>& at, std::vector<double>& slope) {
    look(at);
    const Objective& asked = judge_.question().objectives[0];
    const double sign = asked.maximize ? -1.0 : 1.0;
    if (asked.field) return value(std::get<Quantity>(asked.field->source).member, sign, slope);
    for (std::size_t k = 0; k < slope.size(); ++k)
      slope[k] = k == asked.parameter ? sign * per_place(k) : 0.0;
    return sign * values_[asked.parameter];
  }
  double bound(std::size_t number, const std::vector<double>& at, std::vector<double>& slope) {
    look(at);
    const Bound& bound = bounds_[number];
    return value(bound.of, bound.sign, slope) - bound.sign * bound.value;
  }

 private:
  struct Bound {
    double Outcome::*of;
    double value, sign;
  };
  /// Solves the design there, if it is not the last one.
  void look(const std::vector<double>& at) {
    if (at == at_) return;
    at_ = at;
    for (const double coordinate : at)
      if (!std::isfinite(coordinate)) throw nlopt::forced_stop();
    values_ = judge_.question().values(at);
    design_ = judge_.question().designs.at(values_, &body_);
    if (solver_) gradients_.begin(1), solver_({&design_, 1}, {&outcome_, 1}, gradients_);
    Place here{at, judge_.judge(at)};
    if (better(here.verdict, best.verdict)) best = std::move(here);
  }
  /// d parameter / d coordinate.
  double per_place(std::size_t k) const {
    const Side& side = judge_.question().free[k].side;
    return side.log ? values_[k] * std::log(side.high / side.low) : side.high - side.low;
  }
  double value(double Outcome::*of, double sign, std::vector<double>& slope) {
    const Design by = gradients_.of_design(of, 0);
    const ByScale by_scale = ByScale::of(design_, by, in_seconds(of, outcome_), held_);
    for (std::size_t k = 0; k < slope.size(); ++k)
      slope[k] = sign * per_place(k) * judge_.question().free[k].variable.derivative(by, body_, by_scale);
    const double value = sign * outcome_.*of;
    for (const double part : slope)
      if (!std::isfinite(part)) throw nlopt::forced_stop();  // out of the branch, or on its edge
    if (!std::isfinite(value)) throw nlopt::forced_stop();
    return value;
  }

  Judge& judge_;
  GradientSolver solver_;
  Gradients gradients_;
  std::vector<Bound> bounds_;
  std::vector<double> at_;
  std::vector<SameInSi> held_;
  std::vector<double> values_;
  Design design_;
  Body body_;
  Outcome outcome_;
};

struct OneBound {
  Slope* slope;
  std::size_t number;
};

}  // namespace

void descend(Judge& judge, Place& place) {
  const Question& question = judge.question();
  const Field* field = question.objectives[0].field;
  const Scene& scene = question.one.scene;
  const auto has_slope = [&](const Goal& goal) {
    const Field& of = *find_field(goal.field);
    return !std::holds_alternative<Quantity>(of.source) ||
           (can_be_differentiated(of, scene) && goal.unit_of_nominal == 0.0);
  };
  const bool smooth = (!field || can_be_differentiated(*field, scene)) && !judge.makes_hoops() &&
                      std::ranges::all_of(question.one.goals, has_slope);
  if (!smooth || !place.verdict.feasible() || resolved_method(question.one) != "exact") return;
  Slope slope(judge);
  slope.best = place;
  nlopt::opt slsqp(nlopt::LD_SLSQP, static_cast<unsigned>(judge.dimensions()));
  slsqp.set_lower_bounds(0.0);
  slsqp.set_upper_bounds(1.0);
  slsqp.set_min_objective([](const std::vector<double>& at, std::vector<double>& by,
                             void* data) { return static_cast<Slope*>(data)->objective(at, by); },
                          &slope);
  std::vector<OneBound> bounds;
  for (std::size_t k = 0; k < slope.bounds(); ++k) bounds.push_back({&slope, k});
  for (OneBound& bound : bounds)
    slsqp.add_inequality_constraint(
        [](const std::vector<double>& at, std::vector<double>& by, void* data) {
          const auto& one = *static_cast<OneBound*>(data);
          return one.slope->bound(one.number, at, by);
        },
        &bound, 0.0);
  slsqp.set_maxeval(200);
  slsqp.set_xtol_rel(1e-14);
  std::vector<double> at = place.at;
  double cost = 0.0;
  try {
    slsqp.optimize(at, cost);
  } catch (const nlopt::forced_stop&) {
    // It left the branch: what it met before stands.
  } catch (const nlopt::roundoff_limited&) {
    // As near as numbers go.
  } catch (const Stopped&) {
    throw;
  } catch (const std::runtime_error&) {
    // SLSQP's own trouble is no error of the search.
  }
  place = slope.best;
}

}  // namespace leapmap
