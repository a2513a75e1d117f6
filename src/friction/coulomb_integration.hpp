// SPDX-License-Identifier: GPL-3.0-or-later
/// One design with Coulomb friction by integrating rolling and sliding in time with one of GSL's steppers:
/// the audit of CoulombSolver, with which it shares equations, flights and landings, but neither energy
/// integral nor quadratures.
#pragma once

#include <functional>

#include "friction/contact_phases.hpp"
#include "friction/coulomb.hpp"
#include "integrate/guarded_steps.hpp"
#include "integrate/integration_options.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// The motion inside a step of a phase in contact: the state tau after the step's start; false if the method
/// fails there.
using ContactMotion = std::function<bool(double tau, ContactState<double>&)>;

/// A step in contact: its phase and direction of sliding, the state at its start, how much of it was gone
/// through, and the motion in it.
using StepObserver =
    std::function<void(Phase, int direction, const ContactState<double>&, double end, const ContactMotion&)>;

/// A thread's own workspace.
class CoulombIntegration {
 public:
  explicit CoulombIntegration(const IntegrationOptions& options);
  CoulombIntegration(const CoulombIntegration&) = delete;
  CoulombIntegration& operator=(const CoulombIntegration&) = delete;

  /// step, if set, is told of every step in contact, in order.
  Outcome solve(const Design& design, const Scene& scene, const CoulombObserver& observer = {},
                const StepObserver& step = {}) {
    ContactState<double> from = released<double>(design);
    return solve(Start::release, design, from, scene, observer, step);
  }
  /// The same from where it was released or has just landed; moves that to just after the landing of its
  /// jump.
  Outcome solve(Start start, const Design& design, ContactState<double>& from, const Scene& scene,
                const CoulombObserver& observer = {}, const StepObserver& step = {});

  /// What the right-hand sides work on.
  struct System {
    Hoop<double> hoop;
    double friction;  ///< mu_kinetic sign(v) while sliding, infinity while rolling
    long evaluations = 0;
  };

  /// How often a right-hand side was asked for so far.
  long evaluations() const { return system_.evaluations; }

  /// What ends a phase where it falls through zero, and in what.
  struct Guard {
    std::function<Sample<double>(const State<4>&)> sample;
    PhaseEnd end;
  };

 private:
  PhaseEnd follow(Phase phase, int direction, ContactState<double>& at, std::span<const Guard> guards,
                  const StepObserver& step_told);
  PhaseEnd roll(const Hoop<double>& hoop, const Contact<double>& contact, ContactState<double>& at,
                double runway, const StepObserver& step_told);
  PhaseEnd slide(const Hoop<double>& hoop, const Contact<double>& contact, ContactState<double>& at,
                 double runway, int direction, const StepObserver& step_told);

  IntegrationOptions options_;
  System system_{};
  GslIntegrator<4> integrator_;
  GuardedSteps<4> guarded_;
  long steps_ = 0;
};

}  // namespace leapmap
