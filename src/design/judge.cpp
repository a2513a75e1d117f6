// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/judge.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "boundaries/cliff.hpp"
#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "request/solver.hpp"

namespace leapmap {
namespace {

/// 0: in the range; else in (0, 1].
double missed_by(double value, double at_least, double at_most) {
  if (std::isnan(value)) return 1.0;
  const double distance = std::max({at_least - value, value - at_most, 0.0});
  if (distance == 0.0) return 0.0;
  const double bound = std::abs(value < at_least ? at_least : at_most);
  return distance / (distance + (bound > 0.0 ? bound : 1.0));
}

bool asks_of_made(const Question& question) {
  return !question.made_goals.empty() || std::ranges::any_of(question.objectives, &Objective::is_of_made);
}

/// What goals and objectives of a nominal hoop need.
Request request_of_nominal(const Question& question) {
  std::vector<const Field*> columns{find_field("status")};
  for (const Goal& goal : question.one.goals) add_column(columns, find_field(goal.field));
  for (const Objective& objective : question.objectives)
    if (objective.is_of_drawn()) add_column(columns, objective.field);
  return request_of(question.one, columns);
}

/// What they need of manufactured hoops.
Request request_of_many(const Question& question) {
  std::vector<const Field*> columns{find_field("yield")};
  for (const Objective& objective : question.objectives)
    if (objective.is_of_made()) add_column(columns, objective.field);
  for (const Goal& goal : question.made_goals) add_column(columns, find_field(goal.field));
  return request_of(question.one, columns);
}

/// A solver that shares its designs among threads. Which designs are solved together does not hang on how
/// many threads there are.
Solver shared(const Request& request, int threads) {
  static constexpr std::size_t block = 256;
  std::vector<Solver> solvers;
  for (int i = 0; i < threads; ++i) solvers.push_back(make_solver(request));
  return
      [solvers = std::move(solvers), threads](std::span<const Design> designs, std::span<Outcome> outcomes) {
        std::atomic<std::size_t> next_solver{0};
        parallel_for_each((designs.size() + block - 1) / block, threads, {}, [&] {
          return [&, &solver = solvers[next_solver++]](std::size_t number) {
            const std::size_t first = number * block, count = std::min(block, designs.size() - first);
            solver(designs.subspan(first, count), outcomes.subspan(first, count));
            return true;
          };
        });
      };
}

std::uint64_t number_of(const Discrete& outcome) {
  const std::uint64_t codes = std::uint64_t{static_cast<std::uint8_t>(outcome.status)} |
                              std::uint64_t{outcome.jumps_on} << 8 |
                              std::uint64_t{outcome.spurious_first_jump} << 16;
  return (codes + 1) * 0x9e3779b97f4a7c15u ^ outcome.phase_sequence;
}

}  // namespace

Goal tightened(const Goal& goal, double tolerance) {
  const Field& field = *find_field(goal.field);
  const auto* quantity = std::get_if<Quantity>(&field.source);
  if (!quantity || goal.at_least == goal.at_most) return goal;
  const double hair = quantity->measure == Measure::time ? 4.0 * tolerance : 1e-12;
  Goal tight = goal;
  if (std::isfinite(goal.at_least)) tight.at_least += hair * std::abs(goal.at_least);
  if (std::isfinite(goal.at_most)) tight.at_most -= hair * std::abs(goal.at_most);
  return tight;
}

Bench::Bench(const Question& question, const std::shared_ptr<const SobolPoints>& points, int threads)
    : question_(question), solver_(make_solver(request_of_nominal(question))) {
  std::vector<Goal> goals;
  for (const Goal& goal : question.one.goals)
    goals.push_back(tightened(goal, question.one.numerics.tolerance));
  goals_ = goal_checks(goals);
  if (!points) return;
  const Request many = request_of_many(question);
  scatter_.emplace(scatter_solver_of(many, points, [&](const Request& one) { return shared(one, threads); }));
  columns_ = MadeColumns(statistics_of(many));
}

void Bench::weigh(std::size_t objective, double value, Verdict& verdict) const {
  if (std::isnan(value)) verdict.violation += 1.0;
  verdict.cost[objective] = question_.objectives[objective].maximize ? -value : value;
}

Verdict Bench::verdict_of(const Design& design, const Outcome& outcome) const {
  Verdict verdict{.violation = 0.0, .outcome = number_of(discrete(outcome, true))};
  for (const GoalCheck& goal : goals_) {
    if (goal.reached(design, outcome)) continue;
    verdict.violation += std::holds_alternative<Quantity>(goal.field->source)
                             ? missed_by(goal.value(design, outcome), goal.at_least, goal.at_most)
                             : 1.0;
  }
  for (std::size_t k = 0; k < question_.objectives.size(); ++k)
    if (question_.objectives[k].is_of_drawn())
      weigh(k, stored_number(*question_.objectives[k].field, outcome), verdict);
  return verdict;
}

void Bench::judge_made(std::size_t design, Verdict& verdict) {
  const std::span<const Body> body(bodies_.data() + (bodies_.empty() ? 0 : design), bodies_.empty() ? 0 : 1);
  scatter_->solve({&designs_[design], 1}, columns_, body);
  const auto value = [&](const Field& field) { return columns_.column(field)[0]; };
  for (const Goal& goal : question_.made_goals)
    verdict.violation += missed_by(value(*find_field(goal.field)), goal.at_least, goal.at_most);
  for (std::size_t k = 0; k < question_.objectives.size(); ++k)
    if (question_.objectives[k].is_of_made()) weigh(k, value(*question_.objectives[k].field), verdict);
}

void Bench::judge(std::span<const double> values, std::span<Verdict> verdicts) {
  const std::size_t dimensions = question_.dimensions();
  const auto row = [&](std::size_t i) { return values.subspan(i * dimensions, dimensions); };
  designs_.resize(verdicts.size()), outcomes_.resize(verdicts.size());
  if (scatter_ && question_.designs.varies_body()) bodies_.resize(verdicts.size());
  for (std::size_t i = 0; i < designs_.size(); ++i)
    designs_[i] = question_.designs.at(row(i), bodies_.empty() ? nullptr : &bodies_[i]);
  solver_(designs_, outcomes_);
  for (std::size_t i = 0; i < designs_.size(); ++i) {
    verdicts[i] = verdict_of(designs_[i], outcomes_[i]);
    for (std::size_t k = 0; k < question_.objectives.size(); ++k)
      if (const Objective& objective = question_.objectives[k]; !objective.field)
        weigh(k, row(i)[objective.parameter], verdicts[i]);
    if (!scatter_) continue;
    // A drawing that misses a goal is not made: it is worse than any that is.
    if (verdicts[i].feasible())
      judge_made(i, verdicts[i]);
    else
      verdicts[i].violation += static_cast<double>(question_.made_goals.size());
  }
}

Judge::Judge(const Question& question, int threads, std::function<bool()> stop_requested)
    : question_(question),
      threads_(thread_count(threads)),
      stop_requested_(std::move(stop_requested)),
      points_(asks_of_made(question) ? points_of(question.one.scatter) : nullptr),
      benches_(static_cast<std::size_t>(threads_)) {}

Judge::Judge(const Judge& other, int threads)
    : question_(other.question_),
      threads_(threads),
      stop_requested_(other.stop_requested_),
      points_(other.points_),
      evaluations_(other.evaluations_),
      benches_(static_cast<std::size_t>(threads)) {}

std::unique_ptr<Judge> Judge::alone() const { return std::unique_ptr<Judge>(new Judge(*this, 1)); }

void Judge::judge_values(std::span<const double> values, std::span<Verdict> verdicts) {
  assert(values.size() == verdicts.size() * dimensions());
  const std::size_t block = makes_hoops() ? 4 : 256;
  const std::size_t blocks = (verdicts.size() + block - 1) / block;
  std::atomic<std::size_t> next_bench{0};
  const auto work = [&] {
    std::unique_ptr<Bench>& bench = benches_[next_bench++];
    if (!bench) bench = std::make_unique<Bench>(question_, points_);
    return [&](std::size_t number) {
      if (stop_requested_ && stop_requested_()) throw Stopped("the search was stopped");
      const std::size_t first = number * block, count = std::min(block, verdicts.size() - first);
      bench->judge(values.subspan(first * dimensions(), count * dimensions()),
                   verdicts.subspan(first, count));
      *evaluations_ += count;
      return true;
    };
  };
  if (blocks == 1 && makes_hoops()) {
    if (!wide_) wide_ = std::make_unique<Bench>(question_, points_, threads_);
    if (stop_requested_ && stop_requested_()) throw Stopped("the search was stopped");
    wide_->judge(values, verdicts);
    *evaluations_ += verdicts.size();
  } else if (blocks == 1)
    work()(0);
  else
    parallel_for_each(blocks, threads_, stop_requested_, work);
}

void Judge::judge(std::span<const double> places, std::span<Verdict> verdicts) {
  assert(places.size() == verdicts.size() * dimensions());
  values_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    values_[i] = question_.free[i % dimensions()].side.value(places[i]);
  judge_values(values_, verdicts);
}

Verdict Judge::judge(std::span<const double> place) {
  Verdict verdict;
  judge(place, {&verdict, 1});
  return verdict;
}

}  // namespace leapmap
