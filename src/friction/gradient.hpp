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

/// Jumps with derivatives, as DualJumpSolver has them, in duals D. A thread's own workspace.
///
/// A phase ends where something is zero: a guard of friction, the slip, n0, the height of a flight. Its dual
/// state is that of the plain solver's end, moved along the motion to where that zero is: by -g / (dg/dt) in
/// time, g being zero in value. Where dg/dt all but vanishes the phase is about to change, and nothing after
/// it has a derivative.
template <class D>
class CoulombJumps {
 public:
  /// Derivatives are of a solution to that tolerance, or to a finer one.
  explicit CoulombJumps(double tolerance) : plain_(std::min(tolerance, finest)), plain_panels_(finest) {}

  Outcome jump(Start start, const Design& design, const Scene& scene, ContactState<D>& at,
               const PutDual<D>& put);
  /// Derivatives of the first jump of a design that is solved already, and of the way there if it
  /// follows_way; put(quantity, value, unit) takes them.
  template <class Put>
  void derive(const Design& design, const Scene& scene, const Outcome& solved, bool follows_way,
              const Put& put);

 private:
  static constexpr double finest = 1e-12;

  CoulombSolver<double> plain_;
  SlidingPanels<double> plain_panels_;
  SlidingPanels<D> panels_{finest};
  DualTime<DesignDual> time_;
};

/// First jumps with their derivatives by the parameters. A thread's own workspace.
class CoulombGradients {
 public:
  /// Outcomes are CoulombSolver's at that tolerance. Derivatives are of a finer solution.
  explicit CoulombGradients(double tolerance) : solver_(tolerance), duals_(tolerance) {}

  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
             Gradients& gradients);
  /// The same of designs that are solved already.
  void derive_solved(std::span<const Design> designs, const Scene& scene, std::span<const Outcome> outcomes,
                     Gradients& gradients);

 private:
  CoulombSolver<double> solver_;
  CoulombJumps<DesignDual> duals_;
};

}  // namespace leapmap
