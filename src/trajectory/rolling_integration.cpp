// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/rolling_integration.hpp"

#include <gsl/gsl_errno.h>

#include <algorithm>
#include <cmath>

#include "physics/flight_search.hpp"
#include "physics/rolling.hpp"

namespace leapmap {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Rolling conserves energy: a method that is off by more than this share of it has lost the motion. Far
/// looser than any tolerance worth having, it catches fixed steps and tolerances that are too long.
constexpr double most_energy_drift = 0.05;

int rolling_rhs(double, const double y[], double f[], void* params) {
  auto& system = *static_cast<RollingIntegration::System*>(params);
  ++system.evaluations;
  f[0] = y[1];
  f[1] = angular_acceleration(system.hoop, trig(y[0]), y[1]);
  return GSL_SUCCESS;
}

int rolling_jacobian(double, const double y[], double* dfdy, double dfdt[], void* params) {
  const Hoop<double>& hoop = static_cast<const RollingIntegration::System*>(params)->hoop;
  const Trig<double> phi = trig(y[0]);
  const auto gradient = acceleration_gradient(hoop, phi, y[1], angular_acceleration(hoop, phi, y[1]));
  dfdy[0] = 0.0, dfdy[1] = 1.0;
  dfdy[2] = gradient.by_angle, dfdy[3] = gradient.by_spin;
  dfdt[0] = dfdt[1] = 0.0;
  return GSL_SUCCESS;
}

/// The normal force and its rate: a lift-off is where this falls through zero.
Sample<double> normal_force_guard(const Hoop<double>& hoop, const RollingState& y) {
  const Trig<double> phi = trig(y[0]);
  const double acceleration = angular_acceleration(hoop, phi, y[1]);
  return {normal_force(hoop, phi, y[1], acceleration), normal_force_rate(hoop, phi, y[1], acceleration)};
}

/// The spin and its rate: the hoop stalls where this falls through zero.
Sample<double> spin_guard(const Hoop<double>& hoop, const RollingState& y) {
  return {y[1], angular_acceleration(hoop, trig(y[0]), y[1])};
}

}  // namespace

IntegrationOptions adaptive(std::string_view stepper, double tolerance) {
  IntegrationOptions options;
  options.stepper = find_gsl_stepper(stepper);
  options.control.relative = options.control.absolute = tolerance;
  return options;
}

RollingIntegration::RollingIntegration(const IntegrationOptions& options)
    : options_(options),
      system_{derive<double>(Design{})},
      integrator_(*options.stepper, options.control, {&rolling_rhs, &rolling_jacobian, 2, &system_}) {}

Outcome RollingIntegration::solve(const Design& design, const Scene& scene, const RollingObserver& observer) {
  const Hoop<double>& hoop = system_.hoop = derive<double>(design);
  const auto normal_force_at = [&](const RollingState& y) {
    ++system_.evaluations;
    return normal_force_guard(hoop, y);
  };
  const auto spin_at = [&](const RollingState& y) {
    ++system_.evaluations;
    return spin_guard(hoop, y);
  };
  const auto retake = [&](double tau, RollingState& y) { return integrator_.retake(tau, y); };

  Outcome outcome;
  const RollingState release{design.release_angle, design.release_spin};
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
      RollingState y;
      return retake(tau, y) ? Sample<double>{y[0] - angle, y[1]} : Sample<double>{NAN, 0.0};
    };
    return polish_root(angle_at, 0.0, latest, 0.5 * latest, true, 1e-15 * latest);
  };

  const double energy = rolling_energy(hoop, release[0], release[1]);
  const auto believable = [&](const RollingState& y) {
    const Trig<double> phi = trig(y[0]);
    const double kinetic = kinetic_energy(hoop, phi, y[1]);
    const double drift = kinetic + potential_energy(hoop, y[0], phi) - energy;
    return std::abs(drift) <= most_energy_drift * (1.0 + kinetic);
  };

  const double runway_end = design.release_angle + two_pi * scene.runway;
  if (!integrator_.start(release, 0.01 / (1.0 + spin.value))) return failed_outcome();
  for (long taken = 0; taken < options_.max_steps; ++taken) {
    if (!integrator_.advance()) return failed_outcome();
    const Step<2>& step = integrator_.step();
    // A look every 22.5 degrees: the normal force swings once or twice a revolution.
    const int looks =
        1 + static_cast<int>(std::min(std::abs(step.y1[0] - step.y0[0]) * (16.0 / two_pi), 1000.0));
    force = find_falls(step, looks, force, normal_force_at, retake, lift_offs_);
    spin = find_falls(step, looks, spin, spin_at, retake, stalls_);
    if (lift_offs_.failed || stalls_.failed) return failed_outcome();

    const double stall = stalls_.falls.empty() ? step.h : stalls_.falls.front().tau;
    const double stall_angle = stalls_.falls.empty() ? step.y1[0] : stalls_.falls.front().state[0];
    const auto tell_grazes = [&](double end) {
      if (!observer.graze) return;
      for (const NearMiss& miss : lift_offs_.near_misses)
        if (RollingState y; miss.tau <= end && retake(miss.tau, y) && y[0] <= runway_end)
          observer.graze({step.t0 + miss.tau, y[0], miss.value, miss.minimum});
    };

    for (const Fall<2>& fall : lift_offs_.falls) {
      if (fall.tau > stall || fall.state[0] > runway_end) break;
      const LiftOff<double> lift_off{step.t0 + fall.tau, fall.state[0], fall.state[1]};
      if (!believable(fall.state) || lift_off.spin < 0.0) return failed_outcome();
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
    if (!believable(step.y1)) return failed_outcome();
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
  return failed_outcome();
}

}  // namespace leapmap
