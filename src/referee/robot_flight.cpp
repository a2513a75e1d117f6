// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/robot_run.hpp"

#include <algorithm>
#include <cmath>

namespace leapmap::referee {

auto RobotRun::fly() -> Flown {
  const RobotMotion from = at_;
  const RobotMode contact = mode_;
  const double began = time_;
  const bool braked = brakes_;
  const Look way = way_;
  mode_.kind = RobotMode::flies;
  if (scene_.motor_in_flight)
    decide_motor(false);
  else
    mode_.motor = Motored::idles;
  Flown flown;
  const double R = scene_.radius, arm = robot_.m_p * robot_.L / (robot_.m + robot_.m_p);
  const std::vector<Guard> guards{
      [&](const RobotMotion& at) { return at.y - R; }, [](const RobotMotion& at) { return at.y_rate; },
      [](const RobotMotion& at) { return -at.y_rate; },
      [&](const RobotMotion& at) { return at.y - R + arm * (1.0 - std::cos(at.psi)); }};
  bool over = false;
  for (int piece = 0; !over; ++piece) {
    const int ended = follow(
        aloft_, guards,
        [&](int guard) {
          const double y = at_.y - R;
          if (guard == 1 && y > flown.height) flown.height = y, flown.apex = time_ - began;
          if (guard == 2 && flown.height == 0.0) flown.dip = std::min(flown.dip, y);
          return over = (guard == 0 && flown.height > 0.0) || (guard == 3 && flown.height == 0.0);
        },
        HUGE_VAL);
    flown.failed = ended < 0 || piece > most_robot_pieces;
    if (flown.failed) break;
  }
  if (flown.height > 0.0) {
    flown.landing = time_ - began, flown.before = at_;
    flown.before.y = R;
  } else {
    flown.dip = 0.0, flown.before = from;
  }
  after_flight_ = brakes_, flown.holds = mode_.motor == Motored::holds;
  at_ = from, time_ = began, mode_ = contact, brakes_ = braked;
  flown.way = way_, way_ = way;
  return flown;
}

RobotLanded RobotRun::landing_of(const Flown& flown) {
  const bool slips = scene_.friction == Friction::coulomb;
  const double mu = slips ? mu_kinetic_ : -1.0, rest_speed = scene_.rest_speed * scene_.radius / second_;
  const RobotLanded apart = land(robot_, flown.before, Motored::idles, mu, restitution_, rest_speed);
  const double parted =
      std::abs((apart.after.swing - apart.after.spin) - (flown.before.swing - flown.before.spin));
  stays_held_ = slips && flown.holds && parted * second_ < scene_.rest_speed;
  return stays_held_ ? land(robot_, flown.before, Motored::holds, mu, restitution_, rest_speed) : apart;
}

bool RobotRun::count_lift_off(const Flown& flown) {
  const double diameter = 2.0 * scene_.radius, height = flown.height / diameter;
  const bool jumps = height >= scene_.hop_height;
  if (outcome_.candidates < Outcome::most_candidates) ++outcome_.candidates;
  if (outcome_.spurious_first_jump == Outcome::no_lift_off) {
    outcome_.spurious_first_jump = jumps ? 0 : 1;
    outcome_.first_jump_height = height, outcome_.first_jump_time = time_;
  }
  if (!jumps) return false;
  const double R = scene_.radius, speed = R / second_, unit = robot_.weight() * R;
  outcome_.jump_height = height, outcome_.jump_time = time_;
  outcome_.jump_angle = at_.phi, outcome_.jump_spin = at_.spin * second_;
  outcome_.jump_distance = at_.x / R;
  outcome_.apex_time = flown.apex, outcome_.flight_time = flown.landing, outcome_.dip = flown.dip / diameter;
  outcome_.motor_energy = at_.work / unit;
  if (meets_forces_) {
    outcome_.max_normal_force = way_.force / robot_.weight(), outcome_.motor_max_torque = way_.torque / unit;
    outcome_.motor_max_spin = way_.speed * second_, outcome_.motor_max_power = way_.power * second_ / unit;
  }
  if (at_.work > 1e-9 * unit) outcome_.efficiency = robot_.weight() * flown.height / at_.work;
  const bool slips = scene_.friction == Friction::coulomb;
  if (slips) outcome_.energy_lost = (released_ + at_.work - energy(robot_, at_)) / unit;
  const RobotLanded landed = landing_of(flown);
  outcome_.jump_range = (flown.before.x - at_.x) / R;
  outcome_.landing_normal_speed = -flown.before.y_rate / speed;
  outcome_.landing_tangential_speed = (flown.before.x_rate - R * flown.before.spin) / speed;
  outcome_.landing_impulse = landed.impulse / ((robot_.m + robot_.m_p) * speed);
  outcome_.landing_energy_lost = (energy(robot_, flown.before) - energy(robot_, landed.after)) / unit;
  if (slips) outcome_.landing_spin = landed.after.spin * second_;
  return true;
}

}  // namespace leapmap::referee
