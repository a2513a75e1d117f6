// SPDX-License-Identifier: GPL-3.0-or-later
/// What is told of hoops as made: for each design, that many are made and solved.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "tolerance/made_hoops.hpp"
#include "tolerance/made_line.hpp"
#include "tolerance/made_sample.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// The points after which hoops are made; a_spread: dimensions of each spread.
std::shared_ptr<const SobolPoints> points_of(const Scatter& scatter, std::size_t a_spread = 1);

/// Hoops solved at once.
inline constexpr std::size_t made_at_once = 1024;

/// Of a block of designs, a column for each field.
class MadeColumns {
 public:
  MadeColumns() = default;
  explicit MadeColumns(std::vector<const Field*> fields);

  void begin(std::size_t designs);
  void put(std::size_t field, std::size_t design, double value) { columns_[field][design] = value; }
  std::span<const Field* const> fields() const { return fields_; }
  /// The field must be one of them.
  std::span<const double> column(const Field& field) const;

 private:
  std::vector<const Field*> fields_;
  std::vector<std::vector<double>> columns_;
};

/// One a thread.
class ScatterSolver {
 public:
  /// quantities: of which the columns are, besides shares; solver: tells these and what the goals are of.
  /// interpolates: hoops made after lines of drawings may be interpolated; not with a column of the worst.
  ScatterSolver(const Scatter& scatter, const std::optional<Body>& hoop, std::vector<SameInSi> held,
                std::shared_ptr<const SobolPoints> points, const std::vector<Goal>& goals,
                const std::vector<const Field*>& quantities, Solver solver, bool interpolates = false);
  bool can_make(const Design& drawn, const Body* body = nullptr) const {
    return hoops_.can_make(drawn, body);
  }
  /// Fills in the columns of designs.size() designs. bodies: one for each, or none, where all have the
  /// nominal one.
  void solve(std::span<const Design> designs, MadeColumns& columns, std::span<const Body> bodies = {});

 private:
  double tell(const OfMade& what);
  void note_worst(std::span<const Outcome> outcomes);
  void solve_corners();
  void solve_one(const Design& drawn, const Body* body);
  /// Of a drawing of the line that was solved.
  void take_from_line(std::size_t number, const Design& drawn);

  MadeHoops hoops_;
  Solver solver_;
  MadeTally tally_;
  double cut_off_ = 0.0;
  std::vector<Design> made_;
  std::vector<Outcome> outcomes_;
  double worst_ = 0.0;  // least height of the hoops in hand, 0 where one does not jump
  std::vector<Design> corners_;
  std::vector<Outcome> at_corners_;
  std::optional<MadeLine> line_;
};

}  // namespace leapmap
