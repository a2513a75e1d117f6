// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/scatter_solver.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace leapmap {

MadeColumns::MadeColumns(std::vector<const Field*> fields)
    : fields_(std::move(fields)), columns_(fields_.size()) {}

void MadeColumns::begin(std::size_t designs) {
  for (std::vector<double>& column : columns_)
    column.assign(designs, std::numeric_limits<double>::quiet_NaN());
}

std::span<const double> MadeColumns::column(const Field& field) const {
  const auto found = std::find(fields_.begin(), fields_.end(), &field);
  assert(found != fields_.end());
  return columns_[static_cast<std::size_t>(found - fields_.begin())];
}

std::shared_ptr<const SobolPoints> points_of(const Scatter& scatter, std::size_t a_spread) {
  return std::make_shared<const SobolPoints>(a_spread * scatter.spreads.size(),
                                             static_cast<std::size_t>(scatter.samples),
                                             static_cast<std::uint64_t>(scatter.seed));
}

ScatterSolver::ScatterSolver(const Scatter& scatter, const std::optional<Body>& hoop,
                             std::vector<SameInSi> held, std::shared_ptr<const SobolPoints> points,
                             const std::vector<Goal>& goals, const std::vector<const Field*>& quantities,
                             Solver solver, bool interpolates)
    : hoops_(scatter, hoop, std::move(held), std::move(points)),
      solver_(std::move(solver)),
      tally_(goals, quantities, hoops_.samples()),
      made_(std::min(made_at_once, hoops_.samples())),
      outcomes_(made_.size()) {
  if (!interpolates) return;
  std::vector<double Outcome::*> numbers;
  const auto add = [&](const Field* field) {
    const auto* quantity = std::get_if<Quantity>(&field->source);
    if (quantity && std::find(numbers.begin(), numbers.end(), quantity->member) == numbers.end())
      numbers.push_back(quantity->member);
  };
  for (const Field* field : quantities) add(field);
  bool phases = false;
  for (const Goal& goal : goals) {
    const Field* field = find_field(goal.field);
    add(field);
    phases = phases || std::holds_alternative<Word>(field->source);
  }
  line_.emplace(std::move(numbers), phases);
}

double ScatterSolver::tell(const OfMade& what) {
  if (what.statistic == Statistic::cut_off) return cut_off_;
  if (what.statistic == Statistic::unsolved) return tally_.failed();
  if (what.statistic == Statistic::worst_case) return worst_;
  if (what.statistic == Statistic::yield) return what.error ? tally_.yield().error : tally_.yield().value;
  return what.error ? tally_.error(what.statistic, what.of) : tally_.tell(what.statistic, what.of);
}

void ScatterSolver::note_worst(std::span<const Outcome> outcomes) {
  for (const Outcome& outcome : outcomes) {
    if (outcome.status == Status::failed) continue;
    worst_ = std::min(worst_, outcome.status == Status::jumped ? outcome.jump_height : 0.0);
  }
}

namespace {

bool wants_worst(const MadeColumns& columns) {
  return std::any_of(columns.fields().begin(), columns.fields().end(), [](const Field* field) {
    return std::get<OfMade>(field->source).statistic == Statistic::worst_case;
  });
}

}  // namespace

void ScatterSolver::solve_one(const Design& drawn, const Body* body) {
  tally_.clear();
  worst_ = HUGE_VAL;
  cut_off_ = hoops_.draw(drawn, body);
  for (std::size_t first = 0; first < hoops_.samples(); first += made_.size()) {
    const std::size_t count = std::min(made_.size(), hoops_.samples() - first);
    hoops_.fill(first, std::span(made_).first(count));
    solver_(std::span(made_).first(count), std::span(outcomes_).first(count));
    for (std::size_t k = 0; k < count; ++k)
      tally_.add(made_[k], outcomes_[k], (first + k) / hoops_.a_replicate());
    note_worst(std::span(outcomes_).first(count));
  }
}

void ScatterSolver::take_from_line(std::size_t number, const Design& drawn) {
  tally_.clear();
  cut_off_ = hoops_.draw(drawn);
  for (std::size_t first = 0; first < hoops_.samples(); first += made_.size()) {
    const std::size_t count = std::min(made_.size(), hoops_.samples() - first);
    if (hoops_.makes_bodies()) hoops_.fill(first, std::span(made_).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      line_->put(number, first + k, outcomes_[k]);
      // Limits in SI hang on size and mass, which are as drawn unless bodies are made.
      tally_.add(hoops_.makes_bodies() ? made_[k] : drawn, outcomes_[k], (first + k) / hoops_.a_replicate());
    }
  }
}

void ScatterSolver::solve_corners() {
  hoops_.corners(corners_);
  at_corners_.resize(corners_.size());
  solver_(corners_, at_corners_);
  note_worst(at_corners_);
}

void ScatterSolver::solve(std::span<const Design> designs, MadeColumns& columns,
                          std::span<const Body> bodies) {
  columns.begin(designs.size());
  const bool worst = wants_worst(columns);
  const auto put = [&](std::size_t i) {
    if (worst) solve_corners();
    for (std::size_t f = 0; f < columns.fields().size(); ++f)
      columns.put(f, i, tell(std::get<OfMade>(columns.fields()[f]->source)));
  };
  for (std::size_t i = 0; i < designs.size();) {
    DrawnLine line = line_ && bodies.empty() ? line_of(designs.subspan(i)) : DrawnLine{};
    const std::size_t end = i + line.count;
    if (!line_ || !MadeLine::suits(line, designs.subspan(i, line.count), hoops_)) {
      for (; i < end; ++i) {
        solve_one(designs[i], bodies.empty() ? nullptr : &bodies[i]);
        put(i);
      }
      continue;
    }
    const std::span drawings = designs.subspan(i, line.count);
    line_->solve(drawings, std::move(line), hoops_, solver_);
    for (std::size_t j = 0; j < drawings.size(); ++j, ++i) {
      take_from_line(j, drawings[j]);
      put(i);
    }
  }
}

}  // namespace leapmap
