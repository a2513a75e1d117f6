// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling, sliding, flying and landing, one after the other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "referee/referee.hpp"

namespace leapmap::referee {
namespace {

constexpr int most_phases = 2'000;
constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();

enum class Next { rolls, slides_forwards, slides_backwards, flies };

/// Upwards acceleration of the hoop's centre if the plane were not there [m/s^2].
double free_rise(const Body& body, const Motion& at) { return forces_of(body, {Mode::flies}, at).y; }

/// What static friction has left to hold with, one way (sign 1: against sliding backwards) or the other [N].
double hold(const Body& body, const Motion& at, double mu, double sign) {
  const Forces forces = forces_of(body, {Mode::rolls}, at);
  const double slack = rounding * (mu * std::abs(forces.normal) + std::abs(forces.friction) +
                                   body.mass() * body.g * std::abs(std::sin(body.slope)));
  return mu * forces.normal - sign * forces.friction + slack;
}

/// Whether a hoop that would leave the plane, were it not held, does.
enum class Leaving { unless_it_sticks, always, never };

Next next_of(const Body& body, const Motion& at, double mu_static, Leaving leaving) {
  const double slip = slip_of(body, at);
  const bool would_leave = leaving != Leaving::never && free_rise(body, at) >= 0.0;
  if (would_leave && (leaving == Leaving::always || slip != 0.0)) return Next::flies;
  if (slip != 0.0) return slip > 0.0 ? Next::slides_forwards : Next::slides_backwards;
  const double forwards = hold(body, at, mu_static, -1.0), backwards = hold(body, at, mu_static, 1.0);
  if (forces_of(body, {Mode::rolls}, at).normal > 0.0 && forwards >= 0.0 && backwards >= 0.0)
    return Next::rolls;
  if (would_leave) return Next::flies;
  return forwards > backwards ? Next::slides_backwards : Next::slides_forwards;
}

}  // namespace

Outcome Referee::solve_coulomb(const Design& design) {
  const Body& body = system_.body;
  const double R = scene_.radius;
  const double mu_kinetic = std::isnan(design.mu_kinetic) ? design.mu_static : design.mu_kinetic;
  const double mu_static = std::max(design.mu_static, mu_kinetic);
  const double runway = 2.0 * std::numbers::pi * scene_.runway * R;
  const double rest_speed = scene_.rest_speed * std::sqrt(scene_.gravity * R);
  const double released = energy(body, at_);
  double slipped = 0.0, driven = 0.0;
  int phases = 0;
  const auto begin = [&](Phase phase) {
    if (phases < 32) outcome_.phase_sequence |= static_cast<std::uint64_t>(phase) << (2 * phases);
    ++phases;
  };
  const auto ended = [&](Status status) {
    if (status == Status::failed || status == Status::indeterminate) {
      const std::uint64_t sequence = outcome_.phase_sequence;
      outcome_ = failed_outcome("the referee gave up");
      outcome_.status = status;
      outcome_.phase_sequence = sequence;
      return outcome_;
    }
    outcome_.status = status;
    outcome_.slip_distance = slipped / R;
    return outcome_;
  };
  const Guard runway_left = [&](const Motion& at) { return runway - std::abs(at.x); };
  std::size_t happened = 0;
  const auto first_event = [&](std::size_t guard) {
    happened = guard;
    return true;
  };

  Next next = next_of(body, at_, mu_static, Leaving::unless_it_sticks);
  if (next == Next::flies) return ended(Status::airborne_at_release);
  while (phases < most_phases) {
    if (next == Next::rolls) {
      begin(Phase::rolling);
      const Motion from = at_;
      for (int turns = 0; turns < 2; ++turns) {  // who has turned twice has seen every angle there is
        const double sets_out = at_.spin != 0.0 ? at_.spin : forces_of(body, {Mode::rolls}, at_).phi;
        if (sets_out == 0.0) return ended(Status::stalled);
        const double way = std::copysign(1.0, sets_out);
        const std::vector<Guard> guards{[&](const Motion& at) { return hold(body, at, mu_static, 1.0); },
                                        [&](const Motion& at) { return hold(body, at, mu_static, -1.0); },
                                        [&](const Motion& at) { return way * at.spin; }, runway_left};
        if (!follow({Mode::rolls}, guards, first_event)) return ended(Status::failed);
        if (happened != 2) break;
        at_.spin = at_.x_rate = 0.0;
      }
      driven += body.motor * (at_.phi - from.phi);
      if (happened == 2) return ended(Status::stalled);
      if (happened == 3) return ended(Status::no_jump);
      next = free_rise(body, at_) >= 0.0 ? Next::flies
             : happened == 0             ? Next::slides_backwards
                                         : Next::slides_forwards;
      continue;
    }
    if (next != Next::flies) {
      begin(Phase::sliding);
      const double sign = next == Next::slides_forwards ? 1.0 : -1.0;
      const Mode slides{Mode::slides, -sign * mu_kinetic};
      if (sliding_determinant(body, slides, at_) <= 0.0) return ended(Status::indeterminate);
      const std::vector<Guard> guards{
          [&](const Motion& at) { return -free_rise(body, at); },
          [&](const Motion& at) { return sign * slip_of(body, at); }, runway_left,
          [&](const Motion& at) { return sliding_determinant(body, slides, at); }};
      const Motion from = at_;
      const bool followed = follow(slides, guards, first_event);
      driven += body.motor * (at_.phi - from.phi);
      slipped += std::abs((at_.x - from.x) - R * (at_.phi - from.phi));
      if (!followed) return ended(Status::failed);
      if (happened == 3) return ended(Status::indeterminate);
      if (happened == 2) return ended(Status::no_jump);
      if (happened == 1) {
        at_.x_rate = R * at_.spin;
        next = next_of(body, at_, mu_static, Leaving::unless_it_sticks);
        continue;
      }
    }
    const Flown flown = fly(body, at_);
    if (flown.failed) return ended(Status::failed);
    const double held_down = body.mass() * body.g * std::cos(body.slope) +
                             body.m_p * body.L * std::cos(at_.phi) * at_.spin * at_.spin;
    if (body.motor != 0.0 && !(flown.landing_time > 0.0) && held_down > 1e-9 * body.mass() * body.g)
      return ended(Status::indeterminate);  // the motor alone lifted it off, and idles in flight
    begin(Phase::flight);
    const bool jumps = count_lift_off(flown);
    if (jumps) outcome_.energy_lost = (released + driven - energy(body, at_)) / (body.mass() * body.g * R);
    Motion landed = flying(body, at_, flown.landing_time);
    landed.y = R;
    time_ += flown.landing_time;
    at_ = after_landing(body, landed, mu_kinetic, design.restitution, rest_speed);
    if (jumps) {
      outcome_.landing_spin = at_.spin * second_;
      return ended(Status::jumped);
    }
    if (!(std::abs(at_.x) < runway)) return ended(Status::no_jump);
    next = at_.y_rate > 0.0
               ? Next::flies
               : next_of(body, at_, mu_static, flown.landing_time > 0.0 ? Leaving::always : Leaving::never);
  }
  return ended(Status::failed);
}

}  // namespace leapmap::referee
