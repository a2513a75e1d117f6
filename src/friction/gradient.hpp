// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives with Coulomb friction: the phases that the exact solver went through once more in duals, one
/// chained to the next.
#pragma once

#include <algorithm>

#include "friction/coulomb.hpp"
#include "noslip/dual_time.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/sequence_gradient.hpp"

namespace leapmap {

/// A phase ends where something is zero: a guard of friction, the slip, n0, the height of a flight. Its dual
/// state is that of the plain solver's end, moved along the motion to where that zero is: by -g / (dg/dt) in
/// time, g being zero in value. Where dg/dt all but vanishes the phase is about to change, and nothing after
/// it has a derivative. A thread's own workspace.
template <class D = DesignDual>
class CoulombGradients {
 public:
  /// Outcomes are CoulombSolver's at that tolerance. Derivatives are of a finer solution.
  explicit CoulombGradients(double tolerance)
      : solver_(tolerance), finer_(std::min(tolerance, finest)), plain_panels_(finest) {}

  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
             Gradients& gradients) requires by_design<D>;
  /// The same of designs that are solved already.
  void derive_solved(std::span<const Design> designs, const Scene& scene, std::span<const Outcome> outcomes,
                     Gradients& gradients) requires by_design<D>;

  /// One jump with derivatives, as DualJumpSolver has it.
  Outcome jump(Start start, const Design& design, const Scene& scene, ContactState<D>& at,
               const PutDual<D>& put);

 private:
  static constexpr double finest = 1e-12;

  CoulombSolver<double> solver_, finer_;
  SlidingPanels<double> plain_panels_;
  SlidingPanels<D> panels_{finest};
  DualTime<DesignDual> time_;
};

}  // namespace leapmap
