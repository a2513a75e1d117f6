// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/robot_run.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace leapmap::referee {

bool RobotRun::follows() const {
  return robot_.law == MotorLaw::angle || (robot_.law == MotorLaw::speed && std::isfinite(robot_.gain));
}

bool RobotRun::seeks_speed() const { return brakes_ || (robot_.law == MotorLaw::speed && !follows()); }

double RobotRun::way_to_target(const RobotMotion& at) const {
  const double here = robot_.law == MotorLaw::until_angle ? at.psi : at.swing - at.spin;
  return std::copysign(1.0, robot_.stall) * (robot_.target - here);
}

double RobotRun::needed(const RobotMotion& at) const {
  RobotMode holding = mode_;
  holding.motor = Motored::holds;
  return forces_of(robot_, holding, at).torque;
}

void RobotRun::decide_motor(bool at_speed) {
  if (is_until() && way_to_target(at_) <= 0.0) brakes_ = true;
  const MotorRange range = motor_range(robot_, at_);
  if (follows()) {
    mode_.motor = range.wanted > range.up     ? Motored::up
                  : range.wanted < range.down ? Motored::down
                                              : Motored::follows;
  } else if (seeks_speed()) {
    const double missing = sought() - (at_.swing - at_.spin);
    mode_.motor = missing > 0.0 ? Motored::up : Motored::down;
    const double near =
        2.0 * robot_rounding * (std::abs(at_.swing) + std::abs(at_.spin) + std::abs(sought()));
    if (!at_speed && std::abs(missing) > near) return;
    const double torque = needed(at_);
    mode_.motor = torque > range.up + slack()     ? Motored::up
                  : torque < range.down - slack() ? Motored::down
                                                  : Motored::holds;
  } else {
    mode_.motor = robot_.stall < 0.0 ? Motored::down : Motored::up;
  }
}

auto RobotRun::motor_guards() -> std::vector<MotorGuard> {
  std::vector<MotorGuard> guards;
  if (mode_.motor == Motored::idles) return guards;
  if (is_until() && !brakes_) {
    guards.push_back({[this](const RobotMotion& at) { return way_to_target(at); },
                      [this] { brakes_ = true, decide_motor(false); }});
  } else if (mode_.motor == Motored::holds) {
    guards.push_back(
        {[this](const RobotMotion& at) { return motor_range(robot_, at).up + slack() - needed(at); },
         [this] { mode_.motor = Motored::up; }});
    guards.push_back(
        {[this](const RobotMotion& at) { return needed(at) - motor_range(robot_, at).down + slack(); },
         [this] { mode_.motor = Motored::down; }});
  } else if (seeks_speed()) {
    const double sign = mode_.motor == Motored::up ? 1.0 : -1.0;
    guards.push_back(
        {[this, sign](const RobotMotion& at) { return sign * (sought() - (at.swing - at.spin)); },
         [this] {
           at_.swing = at_.spin + sought();
           decide_motor(true);
         }});
  } else if (follows()) {
    const Motored now = mode_.motor;
    if (now != Motored::down)
      guards.push_back({[this, now](const RobotMotion& at) {
                          const MotorRange range = motor_range(robot_, at);
                          return (now == Motored::up ? -1.0 : 1.0) * (range.up - range.wanted);
                        },
                        [this, now] { mode_.motor = now == Motored::up ? Motored::follows : Motored::up; }});
    if (now != Motored::up)
      guards.push_back(
          {[this, now](const RobotMotion& at) {
             const MotorRange range = motor_range(robot_, at);
             return (now == Motored::down ? -1.0 : 1.0) * (range.wanted - range.down);
           },
           [this, now] { mode_.motor = now == Motored::down ? Motored::follows : Motored::down; }});
  }
  return guards;
}

}  // namespace leapmap::referee
