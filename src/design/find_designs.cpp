// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "design/descend.hpp"
#include "design/front.hpp"
#include "design/improve.hpp"
#include "design/judge.hpp"
#include "engine/parallel.hpp"
#include "hoop/units.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/find_designs.hpp"
#include "leapmap/gradient.hpp"
#include "leapmap/units.hpp"
#include "model/model.hpp"
#include "numerics/sobol_points.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

/// How much is done before the answer, for designs that take so long.
struct Effort {
  std::size_t sample;    ///< designs of the first sample, 16 times a whole number
  std::size_t starts;    ///< places of it that are followed
  std::size_t improved;  ///< of these, the best that are followed to the end
  std::size_t front;     ///< places kept of a front
  std::size_t told;      ///< of either
};

/// The quantities that objectives and goals name, each once.
std::vector<const Field*> quantities_of(const Question& question) {
  std::vector<const Field*> fields;
  const auto add = [&](const Field* field) {
    if (field && std::holds_alternative<Quantity>(field->source)) add_column(fields, field);
  };
  for (const Objective& objective : question.objectives) add(objective.field);
  for (const Goal& goal : question.one.goals) add(find_field(goal.field));
  return fields;
}

Effort effort_of(const Judge& judge, const FindOptions& options) {
  const Question& question = judge.question();
  const bool slips = model_of(question.one.scene).slips;
  Effort effort{slips ? std::size_t{1} << 18 : std::size_t{1} << 21, 64, 16, 2048, 2048};
  // A model that is integrated takes a hundred times as long for a design.
  if (!model_of(question.one.scene).exact) effort = {std::size_t{1} << 14, 16, 8, 512, 512};
  // What is asked of the way takes ten times as long as the jump alone.
  if (std::ranges::any_of(quantities_of(question), &Field::of_way))
    effort.sample /= 16, effort.starts = 16, effort.improved = 8;
  if (judge.makes_hoops()) {
    const auto hoops = static_cast<std::size_t>(question.one.scatter.samples);
    effort = {std::clamp<std::size_t>(16 * effort.sample / hoops, 1024, effort.sample), 16, 6, 256, 256};
    // Along one line a yield is smooth over a tolerance: some hundred places show all of it.
    if (question.dimensions() == 1) effort.sample = 256, effort.starts = 6, effort.improved = 2;
  }
  if (options.sample > 0) {
    effort.sample = SobolPoints::whole(options.sample);
    // A small sample tells few places apart.
    effort.starts = std::clamp<std::size_t>(effort.sample / 256, 8, effort.starts);
    effort.improved = std::clamp<std::size_t>(effort.sample / 1024, 2, effort.improved);
  }
  if (question.objectives.size() == 2) {
    if (options.most > 0) effort.told = options.most;
  } else {
    effort.told = options.most > 0 ? options.most : 8;
    effort.improved = std::max(effort.improved, effort.told);
  }
  effort.starts = std::max(effort.starts, effort.improved);
  return effort;
}

/// Tells steps as they are done.
class StepCounter {
 public:
  StepCounter(const FindOptions& options, std::size_t total) : options_(options), total_(total) {}
  void done(std::size_t steps = 1) {
    done_ = std::min(done_ + steps, total_);
    if (options_.progress) options_.progress(done_, total_);
  }

 private:
  const FindOptions& options_;
  std::size_t done_ = 0, total_;
};

constexpr std::size_t sample_steps = 32;

/// The best of a dense sample, best first: so many at most. fronts: take those that nothing of the same
/// outcome dominates.
std::vector<Place> sampled(Judge& judge, const Effort& effort, const FindOptions& options, StepCounter& steps,
                           Fronts* fronts = nullptr) {
  const std::size_t dimensions = judge.dimensions();
  const std::size_t most = fronts ? 1 : std::size_t{1} << 15;
  const SobolPoints points(dimensions, effort.sample, options.seed);
  std::vector<Place> best;
  for (std::size_t part = 0; part < sample_steps; ++part) {
    const std::size_t first = part * effort.sample / sample_steps,
                      count = (part + 1) * effort.sample / sample_steps - first;
    std::vector<double> places(count * dimensions);
    for (std::size_t k = 0; k < dimensions; ++k)
      for (std::size_t i = 0; i < count; ++i) places[i * dimensions + k] = points.column(k)[first + i];
    std::vector<Verdict> verdicts(count);
    judge.judge(places, verdicts);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(std::min(most, count)),
                              [&](std::size_t a, std::size_t b) {
                                if (better(verdicts[a], verdicts[b])) return true;
                                return !better(verdicts[b], verdicts[a]) && a < b;
                              });
    for (std::size_t rank = 0; rank < std::min(most, count); ++rank)
      best.push_back(place_of(places, verdicts, order[rank]));
    if (fronts) fronts->add(places, verdicts);
    std::ranges::stable_sort(best,
                             [](const Place& a, const Place& b) { return better(a.verdict, b.verdict); });
    if (best.size() > most) best.resize(most);
    steps.done();
  }
  return best;
}

/// The best places that are not beside one another, or have different outcomes.
std::vector<Place> starts_of(const std::vector<Place>& sample, std::size_t most) {
  constexpr double beside = 0.04;
  std::vector<Place> starts;
  for (const Place& place : sample) {
    if (starts.size() == most) break;
    const bool is_new = std::ranges::none_of(starts, [&](const Place& start) {
      return start.verdict.outcome == place.verdict.outcome && distance(start, place) < beside;
    });
    if (is_new) starts.push_back(place);
  }
  return starts;
}

/// One place of each basin, best first.
void leave_one_a_basin(Judge& judge, std::vector<Place>& places, std::size_t most) {
  std::ranges::stable_sort(places,
                           [](const Place& a, const Place& b) { return better(a.verdict, b.verdict); });
  std::vector<Place> left;
  for (Place& place : places) {
    if (left.size() == most) break;
    if (!left.empty() && left[0].verdict.feasible() != place.verdict.feasible()) break;
    if (std::ranges::none_of(left, [&](const Place& other) { return are_connected(judge, other, place); }))
      left.push_back(std::move(place));
  }
  places = std::move(left);
}

std::vector<Place> best_places(Judge& judge, const Effort& effort, const FindOptions& options,
                               StepCounter& steps) {
  std::vector<Place> places = starts_of(sampled(judge, effort, options, steps), effort.starts);
  // Each start on a thread of its own.
  parallel_for_each(places.size(), judge.threads(), options.stop_requested, [&] {
    return [&, own = std::shared_ptr<Judge>(judge.alone())](std::size_t i) {
      descend(*own, places[i]);
      improve(*own, places[i],
              {.most_rounds = 40,
               .a_round = std::size_t{!own->makes_hoops()      ? 128u
                                      : own->dimensions() == 1 ? 4u
                                                               : 8u},
               .seed = options.seed * 1000 + i,
               .widest = 0.03});
      return true;
    };
  });
  steps.done(places.size());
  leave_one_a_basin(judge, places, effort.improved);
  for (Place& place : places) {
    improve(judge, place,
            {.most_rounds = std::size_t{judge.makes_hoops() ? 40u : 400u},
             .a_round = std::size_t{!judge.makes_hoops()      ? 512u
                                    : judge.dimensions() == 1 ? 8u
                                                              : 64u},
             .seed = options.seed,
             .widest = 0.1});
    follow_boundary(judge, place, options.seed);
    move_off_boundary(judge, place, options.seed);
    steps.done();
  }
  leave_one_a_basin(judge, places, effort.told);
  return places;
}

/// The front; or, if no design is feasible, the nearest miss.
std::vector<Place> front_places(Judge& judge, const Effort& effort, const FindOptions& options,
                                StepCounter& steps, double& hypervolume) {
  Fronts fronts;
  std::vector<Place> best = sampled(judge, effort, options, steps, &fronts);
  if (!best.front().verdict.feasible()) {
    improve(judge, best.front(), {.seed = options.seed});
    if (!best.front().verdict.feasible()) return best;
    fronts.add(best.front().at, {&best.front().verdict, 1});
  }
  fronts.thin(effort.front);
  refine(judge, fronts, effort.front, effort.sample / 32, options.seed);
  steps.done(effort.starts + effort.improved);
  Front front = fronts.of_all();
  front.thin(effort.told);
  hypervolume = front.hypervolume();
  return front.places();
}

/// Bounds and goals that a place lies on, as near as a millionth.
std::vector<std::string> binding(const Question& question, const Place& place, const FoundDesign& found) {
  constexpr double on = 1e-6;
  std::vector<std::string> binds;
  for (std::size_t k = 0; k < question.free.size(); ++k) {
    const FreeParameter& parameter = question.free[k];
    const bool angle = find_option("", parameter.name)->unit == "rad";
    const auto told = [&](double bound) {
      return angle ? fmt::format("{:.6g} deg", bound / degrees(1.0)) : fmt::format("{:.6g}", bound);
    };
    if (place.at[k] < on)
      binds.push_back(parameter.name + " at its lower bound, " + told(parameter.side.low));
    if (place.at[k] > 1.0 - on)
      binds.push_back(parameter.name + " at its upper bound, " + told(parameter.side.high));
  }
  for (const Goal& goal : question.one.goals) {
    const Field& field = *find_field(goal.field);
    if (!std::holds_alternative<Quantity>(field.source)) continue;
    const GoalCheck check = goal_check(goal);
    const double value = check.value(found.design, found.outcome);
    const double unit = check.unit ? goal.unit_of_nominal : 1.0;
    const std::string si = check.unit ? fmt::format(" {}", check.unit->si) : "";
    const auto is_on = [&](double bound) {
      return std::isfinite(bound) && std::abs(value - bound) <= on * (unit + std::abs(bound));
    };
    if (is_on(goal.at_least))
      binds.push_back(fmt::format("{} at least {:.6g}{}", goal.field, goal.at_least, si));
    if (is_on(goal.at_most))
      binds.push_back(fmt::format("{} at most {:.6g}{}", goal.field, goal.at_most, si));
  }
  for (const Goal& goal : question.made_goals)  // a hoop more or less is nothing
    if (goal.field == "yield" && std::abs(found.yield.value - goal.at_least) <= 3.0 * found.yield.error)
      binds.push_back(fmt::format("{} at least {:.6g}", goal.field, goal.at_least));
  if (!found.cliff.empty() && found.cliff[0].distance < on)
    binds.push_back(fmt::format("cliff ({})", name_of(found.cliff[0].kind)));
  return binds;
}

/// Statistics of fresh hoops made after a design: the yield, if there are goals, and the objectives that are
/// statistics.
void put_statistics(const Question& question, const Body& body, FoundDesign& found) {
  std::vector<const Field*> asked;
  if (!question.one.goals.empty()) asked = {find_field("yield"), find_field("yield_error")};
  for (const Objective& objective : question.objectives)
    if (objective.is_of_made()) add_column(asked, objective.field);
  MadeColumns columns(asked);
  Request request = request_of(question.one, asked);
  request.scatter = fresh_samples(question.one.scatter);
  scatter_solver_of(request, points_of(request.scatter)).solve({&found.design, 1}, columns, {&body, 1});
  if (!question.one.goals.empty()) found.yield = {columns.column(*asked[0])[0], columns.column(*asked[1])[0]};
  for (std::size_t k = 0; k < question.objectives.size(); ++k)
    if (question.objectives[k].is_of_made())
      found.objectives[k] = columns.column(*question.objectives[k].field)[0];
}

/// What is told of each place. As the solver sees designs alone; one that misses a goal so is left out.
void tell(const Judge& judge, const std::vector<Place>& places, const FindOptions& options,
          FoundDesigns& found) {
  const Question& question = judge.question();
  const bool front = question.objectives.size() == 2,
             differentiable_method = resolved_method(question.one) == "exact";
  const std::vector<GoalCheck> goals = goal_checks(question.one.goals);
  const Spec grid = question.grid();
  Request all = request_of_outcomes(question.one);
  for (const Field* field : quantities_of(question)) add_column(all.columns, field);
  std::vector<FoundDesign> told(places.size());
  std::vector<char> stays(places.size(), 1);
  parallel_for_each(places.size(), judge.threads(), options.stop_requested, [&] {
    return [&, solve = make_solver(all)](std::size_t i) {
      if (options.stop_requested && options.stop_requested()) throw Stopped("the search was stopped");
      FoundDesign& one = told[i];
      one.free = question.values(places[i].at);
      Body body;
      one.design = question.designs.at(one.free, &body);
      solve({&one.design, 1}, {&one.outcome, 1});
      for (std::size_t k = 0; k < question.objectives.size(); ++k)
        if (question.objectives[k].is_of_drawn())
          one.objectives.push_back(stored_number(*question.objectives[k].field, one.outcome));
        else
          one.objectives.push_back(question.objectives[k].maximize ? -places[i].verdict.cost[k]
                                                                   : places[i].verdict.cost[k]);
      if (!front) one.cliff = near_cliffs(grid, one.free).nearest;
      if (!front && differentiable_method)
        for (const Field* field : quantities_of(question)) {
          if (!can_be_differentiated(*field, question.one.scene)) continue;
          const SolveOptions how{.tolerance = question.one.numerics.tolerance, .threads = 1};
          FieldGradient& slope = one.gradients.emplace_back();
          slope.of = field->name;
          const auto of = std::get<Quantity>(field->source).member;
          slope.by = gradient(one.design, of, question.one.scene, how);
          const std::vector<SameInSi> held = held_in_si(question.one);
          Design by = slope.by;
          for (const SameInSi& each : held)
            by.*each.parameter *= each.of_hoop(one.design.mass, one.design.size);
          const ByScale by_scale = ByScale::of(one.design, by, in_seconds(of, one.outcome), held);
          for (const FreeParameter& parameter : question.free)
            slope.by_free.push_back(parameter.variable.derivative(by, body, by_scale));
        }
      if (judge.makes_hoops()) put_statistics(question, body, one);
      one.binds = binding(question, places[i], one);
      stays[i] = !found.reached || std::ranges::all_of(goals, [&](const GoalCheck& goal) {
        return goal.reached(one.design, one.outcome);
      });
      return true;
    };
  });
  for (std::size_t i = 0; i < told.size(); ++i)
    if (stays[i]) found.designs.push_back(std::move(told[i]));
}

/// Proves the worst hoops of what was found; where that is not known, the least height that was met stays.
void prove_worst(const Question& question, const FindOptions& options, FoundDesigns& found) {
  constexpr long most_boxes = 4000;  // some seconds a design
  for (FoundDesign& one : found.designs) {
    Spec within = question.one;
    within.design = one.design;
    for (const Goal& goal : question.made_goals)
      if (goal.field == "worst_case") within.goals.push_back({"jump_height", goal.at_least, goal.at_most});
    one.worst = worst_case(
        within,
        {.threads = options.threads, .most_boxes = most_boxes, .stop_requested = options.stop_requested});
    for (std::size_t k = 0; k < question.objectives.size(); ++k)
      if (question.objectives[k].name == "worst_case" && !std::isnan(one.worst->height.low))
        one.objectives[k] = one.worst->height.low;
  }
  // A hoop that the samples of the search have not met may miss the goal all the same.
  if (found.reached)
    std::erase_if(found.designs, [](const FoundDesign& one) {
      return one.worst->answer == WorstCase::Answer::counterexample;
    });
}

}  // namespace

Spec list_of(const Spec& spec, const FoundDesigns& found) {
  const Question question = question_of(spec);
  Spec list = question.one;
  list.scatter = fresh_samples(list.scatter);
  list.output = spec.output, list.numerics.audit = 1.0;
  if (list.scatter.spreads.empty()) list.goals.clear();  // as in any map of hoops as drawn
  list.maximize = spec.maximize, list.minimize = spec.minimize;
  // What was asked for is stored, too, if it is no field that a map has by default.
  std::vector<const Field*> stored = columns_of(list);
  const std::size_t before = stored.size();
  for (const Field* field : quantities_of(question)) add_column(stored, field);
  if (stored.size() > before) {
    list.output.fields.clear();
    for (const Field* field : stored)
      if (!std::holds_alternative<Derivative>(field->source)) list.output.fields.emplace_back(field->name);
  }
  list.list.count = found.designs.size();
  for (std::size_t k = 0; k < question.free.size(); ++k) {
    Axis& column = list.list.columns.emplace_back(Axis{question.free[k].name, {}});
    for (const FoundDesign& one : found.designs) column.values.push_back(one.free[k]);
  }
  return list;
}

FoundDesigns find_designs(const Spec& spec, const FindOptions& asked) {
  const auto begin = std::chrono::steady_clock::now();
  const Question question = question_of(spec);
  FindOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  const StopScope scope(options.stop_requested);
  Judge judge(question, options.threads, options.stop_requested);
  const Effort effort = effort_of(judge, options);
  StepCounter steps(options, sample_steps + effort.starts + effort.improved);
  FoundDesigns found;
  const std::vector<Place> places = question.objectives.size() == 2
                                        ? front_places(judge, effort, options, steps, found.hypervolume)
                                        : best_places(judge, effort, options, steps);
  found.reached = places.front().verdict.feasible();
  tell(judge, places, options, found);
  if (asks_for_worst_case(question)) prove_worst(question, options, found);
  if (found.designs.empty()) {  // none holds alone: the goals leave no room for a rounding
    found.reached = false;
    tell(judge, {places.front()}, options, found);
  }
  if (!found.reached) {
    found.designs.resize(1);
    for (const Goal& goal : spec.goals)
      found.missed.push_back(goal.field == "yield" ? found.designs[0].yield.value
                             : goal.field == "worst_case"
                                 ? found.designs[0].worst->height.low
                                 : goal_check(goal).value(found.designs[0].design, found.designs[0].outcome));
  }
  found.evaluations = judge.evaluations();
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace leapmap
