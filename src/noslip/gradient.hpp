// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives of rolling without slip: the exact solver's roots, each with one Newton step in duals, and its
/// times by quadratures of duals.
#pragma once

#include "noslip/dual_time.hpp"
#include "noslip/exact.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

/// Designs that never turn round are differentiated in lanes, the others, and times that are hard, one at a
/// time. A thread's own workspace.
class RollingGradients {
 public:
  /// As ExactSolver; times, too, have derivatives to some roundings, whatever the tolerance.
  RollingGradients(double tolerance, const Wanted& wanted, const GradientWanted& gradients);

  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
             Gradients& gradients);

 private:
  using T = Batch;
  using D = LanesDual;

  /// A lift-off of a design that has not turned round, by the design's place in the block.
  struct LiftOffAt {
    std::uint32_t design;
    double angle;
    bool jumps, first;
  };
  struct Lot;

  void in_lanes(const Lot& lot, std::span<const LiftOffAt> lift_offs);
  D time_in_lanes(const DesignLanes<T>& index, const Roll<D>& roll, const D& angle, const T& way,
                  MaskOf<T>& hard);
  void alone(const Lot& lot, const LiftOffAt& lift_off);
  void turning(const Lot& lot, std::uint32_t design);
  void way(const Lot& lot, std::uint32_t design);

  bool of_jump_, of_first_, of_time_, of_first_time_, of_dip_, of_landing_, of_way_;
  ExactSolver<T> solver_;
  ExactSolver<double> teller_;
  RollingTime<D> clock_;
  DualTime<RollingDual> time_;
};

}  // namespace leapmap
