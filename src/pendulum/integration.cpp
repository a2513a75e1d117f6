// SPDX-License-Identifier: GPL-3.0-or-later
#include "pendulum/integration.hpp"

#include <algorithm>
#include <cmath>

namespace leapmap::pendulum {
namespace {

int right_hand_side(double, const double state[], double rate[], void* params) {
  Y at;
  std::copy_n(state, dimension, at.begin());
  std::ranges::copy(static_cast<const System*>(params)->rates(at), rate);
  return GSL_SUCCESS;
}

/// By dual numbers, column by column: for implicit steppers.
int jacobian(double, const double state[], double* by_state, double by_time[], void* params) {
  for (std::size_t j = 0; j < dimension; ++j) {
    Vector<Rated> at;
    for (std::size_t i = 0; i < dimension; ++i) at[i] = Rated(state[i]);
    at[j].by[0] = 1.0;
    const Vector<Rated> rate = static_cast<const System*>(params)->rates(at);
    for (std::size_t i = 0; i < dimension; ++i) by_state[dimension * i + j] = rate[i].by[0];
  }
  std::fill_n(by_time, dimension, 0.0);
  return GSL_SUCCESS;
}

}  // namespace

double energy(const Robot& r, const Y& at) {
  const auto [s, c] = sincos_of(at[psi]);
  const double along = at[vx] - r.lambda * c * at[u], across = at[vy] + r.lambda * s * at[u];
  const double kinetic =
      r.hub * (at[vx] * at[vx] + at[vy] * at[vy]) + r.J * at[w] * at[w] +
      r.alpha * (along * along + across * across + r.own * r.lambda * r.lambda * at[u] * at[u]);
  return 0.5 * kinetic - r.sin_slope * at[x] + r.cos_slope * at[y] -
         r.rho * (r.cos_slope * c - r.sin_slope * s);
}

PhaseIntegration::PhaseIntegration(const IntegrationOptions& options)
    : options_(options),
      integrator_(*options.stepper, options.control, {&right_hand_side, &jacobian, dimension, &system}) {}

void PhaseIntegration::watch_motor() {
  if (system.mode == ContactMode::rolls && system.motor.is_holding() && system.motor.speed_to_hold() == 0.0)
    watches.insert(watches.end(), {Watch::stops_forwards, Watch::stops_backwards});
  if (!system.idles) system.motor.tell_events([&](MotorEvent event) { watches.push_back(watch_of(event)); });
}

/// Of what hangs on forces.
Rated PhaseIntegration::value(Watch watch, const Vector<Rated>& at) const {
  switch (watch) {
    case Watch::normal_force:
      return system.forces(at).normal;
    case Watch::hold_forwards:
    case Watch::hold_backwards: {
      const Forces<Rated> f = system.forces(at);
      const Rated held = static_friction(f, bounds.mu_static);
      return watch == Watch::hold_forwards ? held + f.friction : held - f.friction;
    }
    case Watch::lift:
      return free_normal_force(system.robot, sincos_of(at[psi]), at[u], system.drive(at));
    case Watch::slip:
      return system.direction * (at[vx] - at[w]);
    case Watch::pivot:
      return pivot(system.robot, sincos_of(at[psi]), system.drag, system.drive(at).holds);
    case Watch::stops_forwards:
      return at[w];
    case Watch::stops_backwards:
      return -at[w];
    case Watch::climb:
      return at[vy];
    case Watch::descent:
      return -at[vy];
    case Watch::reach:  // the centre of mass falls, and the pendulum lifts the hoop by 2 rho at most
      return at[y] + system.robot.rho * (1.0 - sincos_of(at[psi]).cos);
    default:
      break;
  }
  const bool by_force = system.motor.is_holding();
  return system.motor.distance_to(motor_event(watch), turning(at),
                                  by_force ? system.forces(at).torque : Rated(0.0));
}

Sample<double> PhaseIntegration::sample(Watch watch, const Y& at) const {
  // Of places alone: no forces are needed.
  if (watch == Watch::runway)
    return {bounds.runway - std::abs(at[x]), -std::copysign(at[vx], at[vx] * at[x])};
  if (watch == Watch::height) return {at[y], at[vy]};
  const Rated there = value(watch, system.rated(at));
  return {there.value, there.by[0]};
}

}  // namespace leapmap::pendulum
