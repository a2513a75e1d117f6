// SPDX-License-Identifier: GPL-3.0-or-later
/// One design with Coulomb friction, from its release to its jump (see contact_phases.hpp).
///
/// Exact: rolling by its energy integral, sliding by quadratures in the angle, flights in closed form. By
/// integration: rolling and sliding by one of GSL's steppers in time, with events; the rest is shared.
#pragma once

#include <functional>

#include "friction/contact_phases.hpp"
#include "friction/rolling_leg.hpp"
#include "friction/sliding_leg.hpp"
#include "hoop/flight.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "trajectory/sequence.hpp"

namespace leapmap {

/// Told of every phase as it begins, of flights how they go, and of the state that the design ends in, whose
/// time and spin mean nothing if it stalls.
struct CoulombObserver {
  std::function<void(Phase, const ContactState<double>&, int direction)>
      phase;  ///< direction of sliding: 1, -1; else 0
  std::function<void(const LiftOff<double>&, const Flight<double>&)> lift_off;
  std::function<void(const ContactState<double>&)> turn;  ///< where it turns round, rolling
  std::function<void(const ContactState<double>&)> end;
};

/// A thread's own workspace. S: double, or long double for the tests' reference.
template <class S>
class CoulombSolver {
 public:
  /// tolerance: relative, of times; angles, spins and heights follow.
  explicit CoulombSolver(double tolerance) : rolling_(tolerance), sliding_(tolerance) {}

  /// Never throws for a bad design: what cannot be solved has status failed and a reason.
  /// slides, if there, is told the panels of every slide, one after the other.
  Outcome solve(const Design& design, const Scene& scene, const CoulombObserver& observer = {},
                std::vector<RecordedSlide<S>>* slides = nullptr) {
    ContactState<S> from = released<S>(design);
    return solve(Start::release, design, from, scene, observer, slides);
  }
  /// The same from where it was released or has just landed; moves that to just after the landing of its
  /// jump.
  Outcome solve(Start start, const Design& design, ContactState<S>& from, const Scene& scene,
                const CoulombObserver& observer = {}, std::vector<RecordedSlide<S>>* slides = nullptr);

 private:
  RollingLeg<S> rolling_;
  SlidingLeg<S> sliding_;
};

}  // namespace leapmap
