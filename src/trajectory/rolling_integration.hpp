// SPDX-License-Identifier: GPL-3.0-or-later
/// One design by integrating (10) in time with one of GSL's steppers.
#pragma once

#include <functional>
#include <string_view>

#include "numerics/gsl_integrator.hpp"
#include "trajectory/outcome.hpp"

namespace leapmap {

/// (phi, w), the state of a rolling hoop.
using RollingState = State<2>;

struct IntegrationOptions {
  const GslStepper* stepper = nullptr;  ///< never null when used
  StepControl control;
  long max_steps = 1'000'000;  ///< a design that needs more is given up as failed
};

/// Adaptive steps of the stepper of that name, which must be one of GSL's, with both tolerances the same.
IntegrationOptions adaptive(std::string_view stepper, double tolerance);

/// A place where the normal force touched zero, or nearly so, without an obvious answer.
struct Graze {
  double time;          ///< since release [sqrt(R/g)]
  double angle;         ///< phi [rad]
  double normal_force;  ///< at its extremum [weights]
  bool minimum;         ///< a minimum or a maximum of the normal force

  /// Whether it was counted as making a lift-off: a minimum below zero, or a maximum above zero, after which
  /// the normal force falls again.
  bool makes_lift_off() const { return minimum == (normal_force < 0.0); }
};

/// Looks on while a design is solved; unset functions cost nothing.
struct RollingObserver {
  /// Every step, in order; retake gives the method's own state inside it; only [0, end] of the step was
  /// rolled.
  std::function<void(const GslIntegrator<2>& integrator, double end)> step;
  std::function<void(const LiftOff<double>&, const Flight<double>&)> lift_off;
  std::function<void(const Graze&)> graze;
};

/// A thread's own workspace: GSL's memory is allocated here once, and every design restarts it.
class RollingIntegration {
 public:
  explicit RollingIntegration(const IntegrationOptions& options);
  RollingIntegration(const RollingIntegration&) = delete;
  RollingIntegration& operator=(const RollingIntegration&) = delete;

  /// Rolls the design until its jump, its stall or the end of the runway. Never throws for a bad design: what
  /// the method cannot do has status failed.
  Outcome solve(const Design& design, const Scene& scene, const RollingObserver& observer = {});

  /// How often the acceleration was asked for so far, by the stepper and by the search for events.
  long evaluations() const { return system_.evaluations; }

  /// What the right-hand side works on.
  struct System {
    Hoop<double> hoop;
    long evaluations = 0;
  };

 private:
  IntegrationOptions options_;
  System system_;
  GslIntegrator<2> integrator_;
  Falls<2> lift_offs_, stalls_;
};

}  // namespace leapmap
