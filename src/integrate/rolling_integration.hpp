// SPDX-License-Identifier: GPL-3.0-or-later
/// One design by integrating its equations of motion in time with one of GSL's steppers.
#pragma once

#include <functional>

#include "hoop/flight.hpp"
#include "integrate/guarded_steps.hpp"
#include "integrate/integration_options.hpp"
#include "integrate/rolling_models.hpp"
#include "leapmap/design.hpp"
#include "leapmap/motion.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "trajectory/sequence.hpp"

namespace leapmap {

/// Looks on while a design is solved; unset functions cost nothing.
template <std::size_t D>
struct IntegrationObserver {
  /// Every step, in order; retake gives the method's own state inside it; only [0, end] of the step was
  /// rolled.
  std::function<void(const GslIntegrator<D>& integrator, double end)> step;
  std::function<void(const LiftOff<double>&, const Flight<double>&)> lift_off;
  /// Its time in sqrt(R/g).
  std::function<void(const Graze&)> graze;
};

/// A thread's own workspace for one model of rolling: GSL's memory is allocated here once, and every design
/// restarts it.
template <class Model>
class Integration {
 public:
  static constexpr std::size_t D = Model::dimension;
  using Observer = IntegrationObserver<D>;

  explicit Integration(const IntegrationOptions& options);
  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  /// Rolls the design until its jump or the end of the runway, or until it has turned round twice and comes
  /// to where it set out. Never throws for a bad design: what the method cannot do has status failed.
  Outcome solve(const Design& design, const Scene& scene, const Observer& observer = {}) {
    ContactState<double> from = released<double>(design);
    return solve(Start::release, design, from, scene, observer);
  }
  /// The same from where it was released or has just landed; moves that to just after the landing of its
  /// jump.
  Outcome solve(Start start, const Design& design, ContactState<double>& from, const Scene& scene,
                const Observer& observer = {});

  /// How often the acceleration was asked for so far, by the stepper and by the search for events.
  long evaluations() const { return system_.evaluations; }

  /// What the right-hand side works on.
  struct System {
    Model model{};
    long evaluations = 0;
  };

 private:
  /// What falls through zero: the normal force where the hoop lifts off, and the spin, as seen in the
  /// direction of rolling, where it turns round.
  static constexpr std::size_t lift_off_guard = 0, turn_guard = 1, guard_count = 2;

  /// A design on its way.
  struct Rolling {
    const ContactState<double>& from;
    const Scene& scene;
    const Observer& observer;
    double energy, runway;  ///< runway: how far from the release, either way, the hoop's centre may travel
    double way = 1.0;       ///< in which it rolls: 1 downhill, -1 uphill
    int turns = 0;
    double side = 0.0;  ///< where it turned first, from where it set out
    Outcome outcome{};
  };

  /// Samples the guards of a design.
  struct GuardsOf;

  Outcome roll(Start start, const Design& design, const ContactState<double>& from, const Scene& scene,
               const Observer& observer);
  bool take(Rolling& rolling, const LiftOff<double>& lift_off, double tau);
  void take_way(Rolling& rolling);
  bool step_on(Rolling& rolling);
  bool take_lift_offs(Rolling& rolling, double end);
  double end_of_way(Rolling& rolling);
  void tell_grazes(const Rolling& rolling, double end);
  bool is_believable(const State<D>& y, double energy) const;
  double time_at(double angle, double earliest, double latest);
  friend class GuardedSteps<D>;  // for which it is a method
  bool advance();
  const Step<D>& step() const { return integrator_.step(); }
  bool retake(double tau, State<D>& y);

  IntegrationOptions options_;
  System system_;
  GslIntegrator<D> integrator_;
  GuardedSteps<D> steps_;
};

/// The least model that rolls, and what looks on.
using RollingIntegration = Integration<OneCoordinate>;
using RollingObserver = RollingIntegration::Observer;

}  // namespace leapmap
