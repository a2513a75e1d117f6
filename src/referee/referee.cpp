// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/referee.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "referee/largest.hpp"
#include "referee/robot.hpp"

namespace leapmap::referee {
namespace {

using Y = State<6>;

Motion motion_of(const Y& y) { return {y[0], y[1], y[2], y[3], y[4], y[5]}; }
Y state_of(const Motion& at) { return {at.x, at.y, at.phi, at.x_rate, at.y_rate, at.spin}; }

Y derivative(const Body& body, const Mode& mode, const Motion& at) {
  const Forces forces = forces_of(body, mode, at);
  return {at.x_rate, at.y_rate, at.spin, forces.x, forces.y, forces.phi};
}

/// Errors below the tolerance, relative; components that pass through zero, to that part of the least of
/// their units.
StepControl control_of(const Scene& scene, double tolerance) {
  const double R = scene.radius, g = scene.gravity;
  return {.relative = tolerance,
          .absolute = tolerance * std::min({1.0, R, std::sqrt(g * R), std::sqrt(g / R)})};
}

}  // namespace

struct Referee::Moving {
  using Y = State<6>;
  using Motion = referee::Motion;
  const Body& body;
  const Mode& mode;
  double unit_of_spin;

  Motion motion(const Y& y) const { return motion_of(y); }
  Y rates(const Motion& at) const { return derivative(body, mode, at); }
  double moment(const Motion& at) const { return 1e-5 / (std::abs(at.spin) + unit_of_spin); }
};

Referee::Referee(const Scene& scene, double tolerance, long most_steps)
    : scene_(scene),
      tolerance_(tolerance),
      second_(std::sqrt(scene.radius / scene.gravity)),
      integrator_(
          *find_gsl_stepper("gsl-rk8pd"), control_of(scene, tolerance),
          {[](double, const double y[], double f[], void* params) -> int {
             const auto& system = *static_cast<const System*>(params);
             const Y rates = derivative(system.body, system.mode, {y[0], y[1], y[2], y[3], y[4], y[5]});
             std::ranges::copy(rates, f);
             return GSL_SUCCESS;
           },
           nullptr, 6, &system_}),
      most_steps_(most_steps) {}

bool Referee::follow(const Mode& mode, const std::vector<Guard>& guards,
                     const std::function<bool(std::size_t)>& happens) {
  system_.mode = mode;
  const double began = time_;
  const Moving moving{system_.body, mode, 1.0 / second_};
  const Sampled<Moving> sample(moving, guards);
  const Y start = state_of(at_);
  guarded_.begin(start, guards.size(), sample);
  if (!integrator_.start(start, 0.01 / (1.0 / second_ + std::abs(at_.spin)))) return false;
  const auto angle = [](const Y& y) { return y[2]; };
  for (;;) {
    if (++steps_ > most_steps_ || guarded_.take(integrator_, angle, 16.0, sample) != Stepped::taken)
      return false;
    const Step<6>& step = integrator_.step();
    for (const Event<6>& event : guarded_.events()) {
      if (meets_forces) meet(mode, event.tau);
      at_ = motion_of(event.state);
      // but for rounding they are
      at_.y = scene_.radius, at_.y_rate = 0.0;
      if (mode.kind == Mode::rolls) at_.x_rate = scene_.radius * at_.spin;
      time_ = began + step.t0 + event.tau;
      if (happens(event.guard)) return true;
    }
    if (meets_forces) meet(mode, step.h);
  }
}

void Referee::meet(const Mode& mode, double end) {
  raise_to_largest(
      integrator_, end,
      [&](const Y& y) -> Met {
        const Motion at = motion_of(y);
        return {forces_of(system_.body, mode, at).normal, std::abs(at.spin), system_.body.motor * at.spin};
      },
      std::array{&Met::force, &Met::spin, &Met::power}, met_);
}

Outcome Referee::solve(const Design& design) {
  if (scene_.model == Mechanism::pendulum)
    return solve_robot(design, scene_, tolerance_, most_steps_, meets_forces);
  system_.body = body_of(design, scene_);
  const double w = design.release_spin / second_;
  at_ = {0.0, scene_.radius, design.release_angle, scene_.radius * w, 0.0, w};
  time_ = 0.0;
  wall_ = scene_.clear_height_in_metres ? scene_.clear_height / design.size
                                        : 2.0 * scene_.radius * scene_.clear_height;
  steps_ = 0;
  met_ = {0.0, 0.0, system_.body.motor * at_.spin};
  outcome_ = {};
  return scene_.friction == Friction::coulomb ? solve_coulomb(design) : solve_sticking();
}

bool Referee::count_lift_off(const Flown& flown) {
  const double diameter = 2.0 * scene_.radius, height = flown.height / diameter;
  const bool jumps = height >= scene_.hop_height;
  if (outcome_.candidates < Outcome::most_candidates) ++outcome_.candidates;
  if (outcome_.spurious_first_jump == Outcome::no_lift_off) {
    outcome_.spurious_first_jump = jumps ? 0 : 1;
    outcome_.first_jump_height = height;
    outcome_.first_jump_time = time_;
  }
  if (!jumps) return false;
  outcome_.status = Status::jumped;
  outcome_.jump_height = height;
  outcome_.jump_time = time_;
  outcome_.jump_angle = at_.phi;
  outcome_.jump_spin = at_.spin * second_;
  outcome_.jump_distance = at_.x / scene_.radius;
  outcome_.apex_time = flown.apex_time;
  outcome_.flight_time = flown.landing_time;
  outcome_.dip = flown.dip / diameter;
  if (meets_forces) {
    const double weight = system_.body.mass() * system_.body.g;
    outcome_.max_normal_force = met_.force / weight;
    outcome_.motor_max_spin = met_.spin * second_;
    outcome_.motor_max_power = met_.power * second_ / (weight * scene_.radius);
  }
  return true;
}

void Referee::measure(const Motion& lift_off, const Motion& before, const Landed& landed) {
  const Body& body = system_.body;
  const double R = scene_.radius, speed = R / second_, weight = body.mass() * body.g;
  outcome_.jump_range = (before.x - lift_off.x) / R;
  outcome_.landing_normal_speed = -before.y_rate / speed;
  outcome_.landing_tangential_speed = (before.x_rate - R * before.spin) / speed;
  outcome_.landing_impulse = landed.impulse / (body.mass() * speed);
  outcome_.landing_energy_lost = (energy(body, before) - energy(body, landed.after)) / (weight * R);
  if (wall_ > 0.0) clear(lift_off);
}

/// Looks along the flight in small steps, and between the best one's neighbours by thirds.
void Referee::clear(const Motion& lift_off) {
  constexpr int looks = 4'000;
  const double R = scene_.radius;
  const double way = outcome_.jump_range < 0.0 ? -1.0 : 1.0;
  if (!(2.0 * R * outcome_.jump_height > wall_)) return;
  // side 1: how far the circle reaches ahead on its way up; -1: how far behind, with the other sign, down
  const auto farthest = [&](double side, double from, double to) {
    const auto reach = [&](double time) {
      const Motion at = flying(system_.body, lift_off, time);
      if (!(at.y - R < wall_)) return -HUGE_VAL;
      const double above = std::max(0.0, at.y - wall_);
      return side * way * (at.x - lift_off.x) + std::sqrt(R * R - above * above);
    };
    const double step = (to - from) / looks;
    int best = 0;
    double most = -HUGE_VAL;
    for (int k = 0; k <= looks; ++k)
      if (const double here = reach(from + step * k); here > most) most = here, best = k;
    double low = from + step * std::max(best - 1, 0), high = from + step * std::min(best + 1, looks);
    while (high - low > 1e-10 * (to - from)) {
      const double third = (high - low) / 3.0;
      if (reach(low + third) < reach(high - third))
        low += third;
      else
        high -= third;
    }
    return std::max(reach(low), reach(high));
  };
  const double from = farthest(1.0, 0.0, outcome_.apex_time) / R,
               to = -farthest(-1.0, outcome_.apex_time, outcome_.flight_time) / R;
  if (!(from <= to)) return;
  outcome_.clears_from = way < 0.0 ? -to : from;
  outcome_.clears_to = way < 0.0 ? -from : to;
}

Outcome Referee::solve_sticking() {
  const Body& body = system_.body;
  const Mode rolls{Mode::rolls};
  const Forces released = forces_of(body, rolls, at_);
  const auto ended = [&](Status status) {
    outcome_.status = status;
    return outcome_;
  };
  if (released.normal <= 0.0) return ended(Status::airborne_at_release);
  const bool from_rest = at_.spin == 0.0;
  const double released_phi = at_.phi;
  if (rests(body, at_)) return ended(Status::stalled);
  const double runway = 2.0 * std::numbers::pi * scene_.runway * scene_.radius;
  double side = 0.0;  // where it turned first
  for (int turns = 0;; ++turns) {
    if (turns > 0 && body.resisting > 0.0 && rests(body, at_)) return ended(Status::stalled);
    const double sets_out = at_.spin != 0.0 ? at_.spin : forces_of(body, rolls, at_).phi;
    const double way = std::copysign(1.0, sets_out);
    std::vector<Guard> guards{[&](const Motion& at) { return forces_of(body, rolls, at).normal; },
                              [&](const Motion& at) { return way * at.spin; },
                              [&](const Motion& at) { return runway - std::abs(at.x); }};
    if (turns == 2) guards.push_back([&](const Motion& at) { return -way * at.x; });  // back at the release
    bool gave_up = false, turned = false;
    const auto happens = [&](std::size_t guard) {
      turned = guard == 1;
      if (guard > 1) outcome_.status = guard == 2 ? Status::no_jump : Status::stalled;
      if (guard > 0) return true;
      const Flown flown = fly(body, at_);
      gave_up = flown.failed;
      if (gave_up) return true;
      if (!count_lift_off(flown)) return false;
      if (meets_forces)
        outcome_.motor_energy = body.motor * (at_.phi - released_phi) / (body.mass() * body.g * body.R);
      Motion before = flying(body, at_, flown.landing_time);
      before.y = scene_.radius;
      measure(at_, before, land_without_slip(body, before));
      return true;
    };
    if (!follow(rolls, guards, happens) || gave_up) return failed_outcome("the reference solver failed");
    if (!turned) return outcome_;
    at_.spin = 0.0;
    // From rest, or nearly, the second or third turn is at the release, or short of it by the method's error.
    if (turns == 0) side = at_.x;
    if (turns == 2 || (turns == 1 && (from_rest || (at_.x > 0.0) == (side > 0.0))))
      return ended(Status::stalled);
  }
}

}  // namespace leapmap::referee
