// SPDX-License-Identifier: GPL-3.0-or-later
#include "pendulum/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "pendulum/solver.hpp"

namespace leapmap::pendulum {
namespace {

/// What is largest on the way, with its rate in time.
struct Extremes {
  Rated normal_force, power, speed, torque;
};

Extremes extremes_at(const System& system, const Y& at) {
  const Vector<Rated> there = system.rated(at);
  const Forces<Rated> f = system.forces(there);
  const Rated speed = there[u] - there[w];
  return {f.normal, f.torque * speed, abs(speed), abs(f.torque)};
}

/// Follows the way step by step: looks at parts of each, and closes in on every maximum between them.
class WayMeter {
 public:
  double normal_force = 0.0, power = -HUGE_VAL, speed = 0.0, torque = 0.0;

  void meet(const TakenStep& step) {
    constexpr int parts = 8;
    std::array<Extremes, parts + 1> looks;
    Y at;
    const auto look = [&](double tau) {
      return step.state_at(tau, at) ? extremes_at(step.system, at) : Extremes{};
    };
    for (int k = 0; k <= parts; ++k) looks[static_cast<std::size_t>(k)] = look(step.end * k / parts);
    const auto take = [&](Rated Extremes::*of, double& most) {
      for (std::size_t k = 0; k <= parts; ++k) most = std::max(most, (looks[k].*of).value);
      for (std::size_t k = 0; k < parts; ++k) {
        const Rated &from = looks[k].*of, &to = looks[k + 1].*of;
        if (!(from.by[0] > 0.0 && to.by[0] < 0.0)) continue;
        const auto f = [&](double tau) { return look(tau).*of; };
        const double low = step.end * static_cast<double>(k) / parts, high = low + step.end / parts;
        most = std::max(most, f(top_between(f, low, high, from.by[0], to.by[0])).value);
      }
    };
    take(&Extremes::normal_force, normal_force);
    take(&Extremes::power, power);
    take(&Extremes::speed, speed);
    take(&Extremes::torque, torque);
  }
};

/// One design with its way. Steps of flights count if the flight is on the way, which is known after it only.
Outcome solve_with_way(Solver& solver, const Design& design, const Scene& scene) {
  WayMeter way, ahead;
  double energy = 0.0;
  const bool flies_on = scene.friction == Friction::coulomb;
  Observer observer;
  observer.contact_step = [&](const TakenStep& step) { way.meet(step), ahead = way; };
  observer.flight_step = [&](const TakenStep& step) { ahead.meet(step); };
  observer.lift_off = [&](double, const Y& at, const Flight<double>& flight) {
    const bool jumps = flight.height >= scene.hop_height;
    if (!jumps && flies_on) way = ahead;
    ahead = way, energy = at[work];
  };
  const Outcome found = solver.solve(design, scene, observer);
  if (found.status != Status::jumped) return found;
  Outcome outcome = found;
  outcome.max_normal_force = way.normal_force, outcome.motor_max_spin = way.speed;
  outcome.motor_energy = energy, outcome.motor_max_power = way.power, outcome.motor_max_torque = way.torque;
  constexpr double least = 1e-9;  // less is a rounding of no work
  if (energy > least) outcome.efficiency = 2.0 * outcome.jump_height / energy;
  return outcome;
}

}  // namespace

leapmap::Solver integration(const Scene& scene, const IntegrationOptions& options) {
  return one_by_one(std::make_shared<Solver>(options), scene);
}

JumpSolver<double> ways(const Scene& scene, double tolerance) {
  return [scene, solver = std::make_shared<Solver>(adaptive(usual_stepper, tolerance))](
             Start, std::span<const Design> designs, std::span<ContactState<double>>,
             std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) outcomes[i] = solve_with_way(*solver, designs[i], scene);
  };
}

}  // namespace leapmap::pendulum
