// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/rolling_integration.hpp"

#include <gsl/gsl_errno.h>

#include <algorithm>
#include <cmath>

#include "physics/flight_search.hpp"
#include "trajectory/jump_rule.hpp"
#include "trajectory/units.hpp"

namespace leapmap {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Rolling conserves energy: a method that is off by more than this share of it has lost the motion. Far
/// looser than any tolerance worth having, it catches fixed steps and tolerances that are too long.
constexpr double most_energy_drift = 0.05;

constexpr const char* no_step = "the stepper found no step";
constexpr const char* no_event = "an event could not be located";
constexpr const char* energy_lost = "the energy is off by more than 5 %";
constexpr const char* out_of_steps = "more steps than max_steps";

template <class Model>
int right_hand_side(double, const double y[], double f[], void* params) {
  auto& system = *static_cast<typename Integration<Model>::System*>(params);
  ++system.evaluations;
  system.model.derivative(y, f);
  return GSL_SUCCESS;
}

template <class Model>
int jacobian(double, const double y[], double* dfdy, double dfdt[], void* params) {
  if constexpr (Model::has_jacobian) {
    static_cast<const typename Integration<Model>::System*>(params)->model.jacobian(y, dfdy);
    std::fill_n(dfdt, Model::dimension, 0.0);
    return GSL_SUCCESS;
  } else {
    return GSL_EUNIMPL;
  }
}

}  // namespace

template <class Model>
Integration<Model>::Integration(const IntegrationOptions& options)
    : options_(options),
      integrator_(*options.stepper, options.control,
                  {&right_hand_side<Model>, &jacobian<Model>, D, &system_}) {}

template <class Model>
Outcome Integration<Model>::solve(const Design& design, const Scene& scene, const Observer& observer) {
  Outcome outcome = roll(design, scene, observer);
  to_seconds(outcome, time_unit(scene));
  return outcome;
}

/// The outcome with its times in sqrt(R/g).
template <class Model>
Outcome Integration<Model>::roll(const Design& design, const Scene& scene, const Observer& observer) {
  const Model& model = system_.model;
  system_.model.set(derive<double>(design));
  const Hoop<double>& hoop = model.hoop;
  // A lift-off is where the normal force falls through zero, a stall where the spin does.
  const auto normal_force_at = [&](const State<D>& y) {
    ++system_.evaluations;
    return model.normal_force(y);
  };
  const auto spin_at = [&](const State<D>& y) {
    ++system_.evaluations;
    return Sample<double>{model.spin(y), angular_acceleration(hoop, trig(model.angle(y)), model.spin(y))};
  };
  const auto retake = [&](double tau, State<D>& y) {
    if (!integrator_.retake(tau, y)) return false;
    if constexpr (Model::projects) model.project(y);
    return true;
  };

  Outcome outcome;
  const State<D> release = model.rolling(design.release_angle, design.release_spin);
  Sample<double> force = normal_force_at(release), spin = spin_at(release);
  if (force.value <= 0.0) {
    outcome.status = Status::airborne_at_release;
    return outcome;
  }
  if (spin.value < 0.0 || (spin.value == 0.0 && spin.rate <= 0.0)) {
    outcome.status = Status::stalled;
    return outcome;
  }

  // How long after the start of the step the hoop, rolling forwards, comes to an angle.
  const auto time_at = [&](double angle, double latest) {
    const auto angle_at = [&](double tau) {
      State<D> y;
      return retake(tau, y) ? Sample<double>{model.angle(y) - angle, model.spin(y)}
                            : Sample<double>{NAN, 0.0};
    };
    return polish_root(angle_at, 0.0, latest, 0.5 * latest, true, 1e-15 * latest);
  };

  const double energy = rolling_energy(hoop, design.release_angle, design.release_spin);
  const auto believable = [&](const State<D>& y) {
    const Trig<double> phi = trig(model.angle(y));
    const double kinetic = kinetic_energy(hoop, phi, model.spin(y));
    const double drift = kinetic + potential_energy(hoop, model.angle(y), phi) - energy;
    return std::abs(drift) <= most_energy_drift * (1.0 + kinetic);
  };

  const double runway_end = design.release_angle + two_pi * scene.runway;
  if (!integrator_.start(release, 0.01 / (1.0 + spin.value))) return failed_outcome(no_step);
  for (long taken = 0; taken < options_.max_steps; ++taken) {
    if (!integrator_.advance()) return failed_outcome(no_step);
    if constexpr (Model::projects) {
      State<D> y = integrator_.step().y1;
      model.project(y);
      if (!integrator_.replace(y)) return failed_outcome(no_step);
    }
    const Step<D>& step = integrator_.step();
    const double turned_to = model.angle(step.y1);
    // A look every 22.5 degrees: the normal force swings once or twice a revolution.
    const int looks =
        1 + static_cast<int>(std::min(std::abs(turned_to - model.angle(step.y0)) * (16.0 / two_pi), 1000.0));
    force = find_falls(step, looks, force, normal_force_at, retake, lift_offs_);
    spin = find_falls(step, looks, spin, spin_at, retake, stalls_);
    if (lift_offs_.failed || stalls_.failed) return failed_outcome(no_event);

    const double stall = stalls_.falls.empty() ? step.h : stalls_.falls.front().tau;
    const double stall_angle = stalls_.falls.empty() ? turned_to : model.angle(stalls_.falls.front().state);
    const auto tell_grazes = [&](double end) {
      if (!observer.graze) return;
      for (const NearMiss& miss : lift_offs_.near_misses)
        if (State<D> y; miss.tau <= end && retake(miss.tau, y) && model.angle(y) <= runway_end)
          observer.graze({step.t0 + miss.tau, model.angle(y), miss.value, miss.minimum});
    };

    for (const Fall<D>& fall : lift_offs_.falls) {
      const LiftOff<double> lift_off{step.t0 + fall.tau, model.angle(fall.state), model.spin(fall.state)};
      if (fall.tau > stall || lift_off.angle > runway_end) break;
      if (!believable(fall.state) || lift_off.spin < 0.0) return failed_outcome(energy_lost);
      const Flight<double> flight = fly(hoop, lift_off);
      const bool is_jump = consider(outcome, scene, design, lift_off, flight);
      if (observer.step && is_jump) observer.step(integrator_, fall.tau);
      if (observer.lift_off) observer.lift_off(lift_off, flight);
      if (is_jump) {
        // The minimum that made this fall lies just after it.
        const auto made_by = std::ranges::find_if(lift_offs_.near_misses, [&](const NearMiss& miss) {
          return miss.minimum && miss.tau >= fall.tau;
        });
        tell_grazes(made_by == lift_offs_.near_misses.end() ? fall.tau : made_by->tau);
        return outcome;
      }
    }
    if (!believable(step.y1)) return failed_outcome(energy_lost);
    tell_grazes(stall);
    if (observer.step)
      observer.step(integrator_, stall_angle > runway_end ? time_at(runway_end, stall) : stall);
    if (stall_angle >= runway_end) {
      outcome.status = Status::no_jump;
      return outcome;
    }
    if (!stalls_.falls.empty()) {
      outcome.status = Status::stalled;
      return outcome;
    }
  }
  return failed_outcome(out_of_steps);
}

template class Integration<OneCoordinate>;
template class Integration<Multipliers<false, false>>;
template class Integration<Multipliers<false, true>>;
template class Integration<Multipliers<true, false>>;
template class Integration<Multipliers<true, true>>;

}  // namespace leapmap
