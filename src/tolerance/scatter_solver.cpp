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
                             Solver solver)
    : hoops_(scatter, hoop, std::move(held), std::move(points)),
      solver_(std::move(solver)),
      tally_(goals, quantities, hoops_.samples()),
      made_(std::min(made_at_once, hoops_.samples())),
      outcomes_(made_.size()) {}

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

void ScatterSolver::solve(std::span<const Design> designs, MadeColumns& columns,
                          std::span<const Body> bodies) {
  columns.begin(designs.size());
  for (std::size_t i = 0; i < designs.size(); ++i) {
    tally_.clear();
    cut_off_ = hoops_.draw(designs[i], bodies.empty() ? nullptr : &bodies[i]);
    for (std::size_t first = 0; first < hoops_.samples(); first += made_.size()) {
      const std::size_t count = std::min(made_.size(), hoops_.samples() - first);
      hoops_.fill(first, std::span(made_).first(count));
      solver_(std::span(made_).first(count), std::span(outcomes_).first(count));
      for (std::size_t k = 0; k < count; ++k)
        tally_.add(made_[k], outcomes_[k], (first + k) / hoops_.a_replicate());
      if (first == 0) worst_ = HUGE_VAL;
      note_worst(std::span(outcomes_).first(count));
    }
    if (wants_worst(columns)) {
      hoops_.corners(corners_);
      at_corners_.resize(corners_.size());
      solver_(corners_, at_corners_);
      note_worst(at_corners_);
    }
    for (std::size_t f = 0; f < columns.fields().size(); ++f)
      columns.put(f, i, tell(std::get<OfMade>(columns.fields()[f]->source)));
  }
}

}  // namespace leapmap
