// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaits/return_map.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace leapmap {
namespace {

StateVector vector_of(const Landed& at) { return {at.angle, at.spin, at.slip, at.normal}; }

}  // namespace

double largest_eigenvalue(const StateMatrix& slope) {
  const auto values = slope.eigenvalues();
  double largest = 0.0;
  for (const auto& value : values)
    if (std::abs(value) > std::abs(largest))
      largest = std::abs(value.imag()) <= 1e-12 * std::abs(value) ? value.real() : std::abs(value);
  return largest;
}

Scene each_jump_alone(Scene scene) {
  scene.jumps = 1, scene.settle = 0;
  return scene;
}

ContactState<StateDual> by_state(const Landed& at) {
  ContactState<StateDual> dual{.angle = StateDual::parameter(at.angle, 0),
                               .spin = StateDual::parameter(at.spin, 1),
                               .slip = StateDual(at.slip),
                               .normal = StateDual(at.normal)};
  if (at.slip != 0.0) dual.slip = StateDual::parameter(at.slip, 2);
  if (at.normal != 0.0) dual.normal = StateDual::parameter(at.normal, 3);
  return dual;
}

StateMatrix slope_of(const ContactState<StateDual>& at) {
  const std::array numbers{&at.angle, &at.spin, &at.slip, &at.normal};
  StateMatrix slope;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      slope(row, column) = numbers[static_cast<std::size_t>(row)]->by[static_cast<std::size_t>(column)];
  return slope;
}

Landed moved(const Landed& at, const StateVector& by) {
  Landed to = at;
  to.angle += by[0], to.spin += by[1];
  if (at.slip != 0.0) to.slip += by[2];
  if (at.normal != 0.0) to.normal += by[3];
  return to;
}

StateVector between(const Landed& a, const Landed& b) {
  StateVector difference = vector_of(b) - vector_of(a);
  if (std::abs(difference[0]) > std::numbers::pi)  // which is seldom, and the remainder takes long
    difference[0] = std::remainder(difference[0], 2.0 * std::numbers::pi);
  return difference;
}

JumpSolvers jump_solvers(const Scene& scene, double tolerance) {
  const Scene alone = each_jump_alone(scene);
  const Model& model = model_of(alone);
  const auto jumps = need(model, &Model::jumps, "semi-analytic solver of later jumps");
  const auto state_jumps = need(model, &Model::state_jumps, "derivatives of later jumps");
  return {model.long_jumps ? model.long_jumps(alone, tolerance, untimed)
                           : in_rounds(jumps(alone, tolerance, untimed)),
          jumps(alone, tolerance, {}), state_jumps(alone, tolerance), tolerance};
}

void ReturnMap::follow(Start start, std::span<const Design> designs, std::span<Landed> states,
                       std::vector<Outcome>& outcomes, const GoesOn& goes_on) {
  outcomes.resize(designs.size());
  solvers_.jumps(start, designs, states, outcomes, [&](std::size_t i) {
    if (is_beyond(scene_, states[i]))
      outcomes[i].status = Status::no_jump;
    else if (is_of_no_flight(outcomes[i]))
      outcomes[i].status = Status::indeterminate;
    states[i] = reduced(states[i]);
    return outcomes[i].status == Status::jumped && goes_on(i);
  });
}

bool ReturnMap::go_round(const Design& design, int period, Landed& at, StateMatrix& slope) {
  ContactState<StateDual> dual = by_state(at);
  for (int k = 0; k < period; ++k) {
    if (solvers_.duals(Start::landing, design, dual, {}).status != Status::jumped) return false;
    if (is_beyond(scene_, plain(dual))) return false;
    set_values(dual, reduced(plain(dual)));
  }
  at = plain(dual);
  slope = slope_of(dual);
  return slope.allFinite();
}

bool ReturnMap::close(const Design& design, int period, const Landed& near, Orbit& orbit) {
  constexpr int most_steps = 40, most_idle = 8;
  constexpr double farthest = 0.3;  // [rad, sqrt(g/R)] that one step may go
  constexpr double exact = 1e-10;   // of a slope
  Landed at = near;
  StateMatrix slope, slope_before = StateMatrix::Zero();
  double before = std::numeric_limits<double>::infinity(), least = before;
  int idle = 0;  // steps since the length was last halved; in chaos it wanders
  for (int step = 0; step < most_steps; ++step) {
    Landed there = at;
    if (!go_round(design, period, there, slope)) return false;
    const StateVector gap = between(at, there);
    StateVector move = (StateMatrix::Identity() - slope).fullPivLu().solve(gap);
    const double length = move.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(length)) return false;
    if (length > farthest) move *= farthest / length;
    at = reduced(moved(at, move));
    // The slope is that of the place before the move: it is off by as much as it changes along there.
    const bool is_known = length <= 1e-9 && step > 0 &&
                          (slope - slope_before).lpNorm<Eigen::Infinity>() * length <= exact * before;
    const bool is_rounding = length == 0.0 || (length <= 1e-9 && length >= 0.25 * before);
    if (is_known || is_rounding) return describe(design, period, at, slope, orbit);
    before = length, slope_before = slope;
    ++idle;
    if (length < 0.5 * least) least = length, idle = 0;
    if (idle == most_idle) return false;
  }
  return false;
}

bool go_once_round(const JumpSolver<double>& jumps, const Scene& scene, const Design& design, int period,
                   const Landed& start, Orbit& orbit, double near) {
  orbit = {};
  const double second = time_unit(scene);
  const Hoop<double> hoop = reduce<double>(design, scene);
  Landed at = start;
  double time = 0.0, travel = 0.0, work = 0.0;
  for (int k = 0; k < period; ++k) {
    const Landed from = reduced(at);
    at = from;
    Outcome outcome;
    jumps(Start::landing, {&design, 1}, {&at, 1}, {&outcome, 1});
    if (outcome.status != Status::jumped) return false;
    orbit.jumps.push_back(jump_of(outcome, at.spin));
    orbit.landings.push_back(reduced(at));
    work += hoop.motor() * ((at.angle - from.angle) - at.turned_in_flight);
    orbit.height += outcome.jump_height / period;
    time += at.time * second, travel += at.travel;
    const bool is_back = between(start, orbit.landings.back()).lpNorm<Eigen::Infinity>() < near;
    if (is_back && k + 1 < period) return false;  // it is of a shorter period
  }
  orbit.speed = travel * scene.radius / time;
  orbit.jump_time = time / period;
  orbit.energy_lost = (travel * hoop.sin_slope + work) / period;
  return true;
}

bool ReturnMap::describe(const Design& design, int period, const Landed& start, const StateMatrix& slope,
                         Orbit& orbit) {
  const double near = std::max(1e-8, nearness());
  if (!go_once_round(solvers_.timed_jumps, scene_, design, period, start, orbit, near)) return false;
  orbit.multiplier = largest_eigenvalue(slope);
  return true;
}

}  // namespace leapmap
