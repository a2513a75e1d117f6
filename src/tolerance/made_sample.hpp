// SPDX-License-Identifier: GPL-3.0-or-later
/// What many hoops made after one drawing have in common: means, quantiles and shares, with errors that come
/// from the spread of replicates.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"
#include "model/fields.hpp"
#include "model/own_units.hpp"
#include "numerics/sobol_points.hpp"

namespace leapmap {

/// A goal, its field looked up.
struct GoalCheck {
  const Field* field;
  double at_least, at_most;
  double unit_of_nominal = 0.0;   ///< as of Goal
  const OwnUnit* unit = nullptr;  ///< of the field, if the limits are in SI

  /// The field's value in the unit of the limits.
  double value(const Design& design, const Outcome& outcome) const;
  /// False if the field does not apply.
  bool reached(const Design& design, const Outcome& outcome) const;
};
GoalCheck goal_check(const Goal& goal);
std::vector<GoalCheck> goal_checks(const std::vector<Goal>& goals);

/// How many of equally many hoops of each replicate are of some kind.
class MadeShare {
 public:
  explicit MadeShare(std::size_t samples) : samples_(samples) {}
  void clear() { counts_.fill(0); }
  void count(std::size_t replicate) { ++counts_[replicate]; }
  std::size_t counted() const;
  /// No better known than to a hoop in all, as where all are alike.
  Estimate share() const;

 private:
  std::size_t samples_;
  std::array<std::size_t, SobolPoints::replicates> counts_{};
};

/// The values of one quantity, replicate after replicate.
class MadeSample {
 public:
  void clear();
  void add(double value, std::size_t replicate);

  /// NaN of no values; of one value the standard deviation is NaN, too.
  double tell(Statistic statistic);
  /// NaN errors with hoops that jump in fewer than half of the replicates.
  double error(Statistic statistic);

 private:
  double error_of_quantile(double share);
  double error_of_moments(Statistic statistic);

  std::vector<double> values_, scratch_;
  std::array<std::size_t, SobolPoints::replicates> counts_{};
};

/// What hoops made after one drawing come to: which reach what they must, and the quantities of those that
/// jump. Of hoops that the method gave up on nothing is known: errors of shares grow by their share, those of
/// quantities are NaN.
class MadeTally {
 public:
  MadeTally(const std::vector<Goal>& goals, const std::vector<const Field*>& quantities, std::size_t samples);

  void clear();
  void add(const Design& design, const Outcome& outcome, std::size_t replicate);
  bool reaches_all(const Design& design, const Outcome& outcome) const;

  Estimate yield() const { return known(reached_.share()); }
  Estimate jumps() const { return known(jumped_.share()); }
  Estimate missed(std::size_t goal) const { return known(missed_[goal].share()); }
  double failed() const { return failed_.share().value; }
  double tell(Statistic statistic, double Outcome::*quantity);
  double error(Statistic statistic, double Outcome::*quantity);

 private:
  Estimate known(const Estimate& share) const;
  MadeSample& of(double Outcome::*quantity);

  std::vector<GoalCheck> goals_;
  std::vector<double Outcome::*> quantities_;
  MadeShare reached_, jumped_, failed_;
  std::vector<MadeShare> missed_;
  std::vector<MadeSample> samples_;
};

}  // namespace leapmap
