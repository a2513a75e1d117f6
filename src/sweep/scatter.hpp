// SPDX-License-Identifier: GPL-3.0-or-later
/// What a map tells of hoops as made: for each of its designs, that many are made and solved.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sweep/made_hoops.hpp"
#include "sweep/made_sample.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// Hoops solved at once.
inline constexpr std::size_t made_at_once = 1024;

/// The fields of hoops as made that the spec's map has: yield and its error, what is cut off, and of each
/// quantity asked for its mean, standard deviation and quantiles. None without [scatter].
std::vector<const Field*> scatter_fields_of(const Spec& spec);

/// The quantities of which such fields are, in the order of map_fields.
std::vector<const Field*> quantities_of_made(const Spec& spec);

/// Throws InputError if the spec's [scatter] or [goal] is not one that read_spec would let pass, or its
/// scatter lies for the larger part where no hoop can be.
void check_scatter(const Spec& spec);

/// The points after which hoops are made; dimensions: as many, of each spread.
std::shared_ptr<const SobolPoints> points_of(const Scatter& scatter, std::size_t a_spread = 1);

/// A spec whose solver computes what is looked at in hoops as made: goals, and these quantities.
Spec spec_of_made(const Spec& spec, const std::vector<const Field*>& quantities);

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
  ScatterSolver(const Spec& spec, std::shared_ptr<const SobolPoints> points);
  /// Fills in the columns of designs.size() designs.
  void solve(std::span<const Design> designs, MadeColumns& columns);

 private:
  double tell(const OfMade& what);

  MadeHoops hoops_;
  Solver solver_;
  MadeTally tally_;
  double cut_off_ = 0.0;
  std::vector<Design> made_;
  std::vector<Outcome> outcomes_;
};

}  // namespace leapmap
