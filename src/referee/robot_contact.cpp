// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/robot_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace leapmap::referee {

double RobotRun::runway_left(const RobotMotion& at) const {
  return 2.0 * std::numbers::pi * scene_.runway * scene_.radius - std::abs(at.x);
}

bool RobotRun::rests() const {
  if (at_.spin != 0.0 || at_.swing != 0.0) return false;
  const RobotForces a = forces_of(robot_, mode_, at_);
  const double unit = robot_.weight() * robot_.R;
  const double arm = robot_.m_p * robot_.g * robot_.L, push = unit * std::abs(std::sin(robot_.slope));
  const double hoop = robot_.I + (robot_.m + robot_.m_p) * robot_.R * robot_.R,
               pendulum = robot_.I_p + robot_.m_p * robot_.L * robot_.L;
  const double size = robot_rounding * (arm + push + std::abs(a.torque));
  return a.normal > 0.0 && std::abs(a.phi) * hoop <= size * (1.0 + hoop / pendulum) &&
         std::abs(a.psi) * pendulum <= size * (1.0 + hoop / pendulum);
}

Outcome RobotRun::without_slip() {
  if (rests()) return finish(Status::stalled);
  bool pulls = !(forces_of(robot_, mode_, at_).normal > 0.0);
  if (pulls) {
    RobotMode idle = mode_;
    idle.motor = Motored::idles;
    if (!(forces_of(robot_, idle, at_).normal > 0.0)) return finish(Status::airborne_at_release);
  }
  std::optional<Status> ends;
  const auto lifts_off = [&] {
    at_.y = scene_.radius, at_.y_rate = 0.0;  // but for robot_rounding they are
    const Flown flown = fly();
    if (flown.failed)
      ends = Status::failed;
    else if (count_lift_off(flown))
      ends = Status::jumped;
    return ends.has_value();
  };
  if (pulls && lifts_off()) return finish(*ends);
  for (int piece = 0; piece < most_robot_pieces; ++piece) {
    const std::vector<Guard> guards{
        [&](const RobotMotion& at) { return forces_of(robot_, mode_, at).normal; },
        [&](const RobotMotion& at) { return runway_left(at); }};
    const RobotMode mode = mode_;
    const int ended = follow(
        integrator_, guards, [&](int guard) { return guard == 1 || lifts_off(); }, patience());
    if (ends) return finish(*ends);
    if (ended == -1) return finish(Status::failed);
    if (ended == -2) return finish(Status::stalled);
    if (ended == 1) return finish(Status::no_jump);
    const double before = forces_of(robot_, mode, at_).normal;
    if (before > 0.0 && !(forces_of(robot_, mode_, at_).normal > 0.0) && lifts_off()) return finish(*ends);
  }
  return finish(Status::failed);
}

double RobotRun::slip_of(const RobotMotion& at) const {
  const double slip = at.x_rate - robot_.R * at.spin;
  return std::abs(slip) > robot_rounding * std::abs(at.x_rate) ? slip : 0.0;
}

double RobotRun::free_rise(const RobotMotion& at) const {
  RobotMode free = mode_;
  free.kind = RobotMode::flies;
  return forces_of(robot_, free, at).y;
}

double RobotRun::hold(const RobotMotion& at, double sign) const {
  RobotMode rolling = mode_;
  rolling.kind = RobotMode::rolls;
  const RobotForces f = forces_of(robot_, rolling, at);
  const double slack = robot_rounding * (mu_static_ * std::abs(f.normal) + std::abs(f.friction) +
                                         std::abs(f.torque) / robot_.R);
  return mu_static_ * f.normal - sign * f.friction + slack;
}

auto RobotRun::next_of(Leaving leaving) -> Next {
  const double slip = slip_of(at_);
  const bool would_leave = leaving != Leaving::never && free_rise(at_) >= 0.0;
  if (would_leave && (leaving == Leaving::always || slip != 0.0)) return Next::flies;
  if (slip != 0.0) return slip > 0.0 ? Next::slides_forwards : Next::slides_backwards;
  RobotMode rolling = mode_;
  rolling.kind = RobotMode::rolls;
  const double forwards = hold(at_, -1.0), backwards = hold(at_, 1.0);
  if (forces_of(robot_, rolling, at_).normal > 0.0 && forwards >= 0.0 && backwards >= 0.0) return Next::rolls;
  if (would_leave) return Next::flies;
  return forwards > backwards ? Next::slides_backwards : Next::slides_forwards;
}

Outcome RobotRun::with_friction() {
  const bool at_rest = rests();
  Next next = next_of(Leaving::unless_it_sticks);
  if (at_rest && next == Next::rolls) return finish(Status::stalled);
  RobotMode idle = mode_;
  idle.motor = Motored::idles, idle.kind = RobotMode::flies;
  if (next == Next::flies && forces_of(robot_, idle, at_).y >= 0.0)
    return finish(Status::airborne_at_release);
  Next before = Next::ended;
  for (int piece = 0; piece < most_robot_pieces && next != Next::ended; ++piece) {
    if (next != before || next == Next::flies) {
      if (phases_ < 32)
        outcome_.phase_sequence |= static_cast<std::uint64_t>(next == Next::rolls   ? Phase::rolling
                                                              : next == Next::flies ? Phase::flight
                                                                                    : Phase::sliding)
                                   << (2 * phases_);
      ++phases_;
    }
    const bool is_new = next != before;
    before = next;
    next = next == Next::flies ? fly_and_land() : touch(next, is_new);
  }
  return finish(next == Next::ended ? end_ : Status::failed);
}

auto RobotRun::end(Status status) -> Next {
  end_ = status;
  return Next::ended;
}

auto RobotRun::touch(Next now, bool is_new) -> Next {
  const double sign = now == Next::slides_forwards ? 1.0 : -1.0;
  mode_.kind = now == Next::rolls ? RobotMode::rolls : RobotMode::slides;
  mode_.drag = now == Next::rolls ? 0.0 : -sign * mu_kinetic_;
  if (is_new) decide_motor(mode_.motor == Motored::holds);
  std::vector<Guard> guards{[&](const RobotMotion& at) { return runway_left(at); }};
  if (now == Next::rolls) {
    guards.push_back([&](const RobotMotion& at) { return hold(at, -1.0); });
    guards.push_back([&](const RobotMotion& at) { return hold(at, 1.0); });
  } else {
    if (sliding_determinant(robot_, mode_, at_) <= 0.0) return end(Status::indeterminate);
    guards.push_back([&](const RobotMotion& at) { return -free_rise(at); });
    guards.push_back([&, sign](const RobotMotion& at) { return sign * (at.x_rate - robot_.R * at.spin); });
    guards.push_back([&](const RobotMotion& at) { return sliding_determinant(robot_, mode_, at); });
  }
  const RobotMotion from = at_;
  const std::size_t of_contact = guards.size();
  const int ended = follow(
      integrator_, guards, [](int) { return true; }, patience());
  if (now != Next::rolls) slipped_ += std::abs((at_.x - from.x) - robot_.R * (at_.phi - from.phi));
  at_.y = scene_.radius, at_.y_rate = 0.0;
  if (now == Next::rolls) at_.x_rate = robot_.R * at_.spin;
  if (ended == -1) return end(Status::failed);
  if (ended == -2) return end(Status::stalled);
  if (ended == 0) return end(Status::no_jump);
  if (static_cast<std::size_t>(ended) >= of_contact) return next_of(Leaving::unless_it_sticks);
  if (now == Next::rolls) {
    if (free_rise(at_) >= 0.0) return Next::flies;
    return ended == 1 ? Next::slides_forwards : Next::slides_backwards;
  }
  if (ended == 1) return Next::flies;
  if (ended == 3) return end(Status::indeterminate);
  at_.x_rate = robot_.R * at_.spin;
  return next_of(Leaving::unless_it_sticks);
}

auto RobotRun::fly_and_land() -> Next {
  RobotMode idle = mode_;
  idle.motor = Motored::idles, idle.kind = RobotMode::flies;
  if (!scene_.motor_in_flight && !(at_.y_rate > 0.0) &&
      forces_of(robot_, idle, at_).y < -1e-9 * scene_.gravity)
    return end(Status::indeterminate);
  const Flown flown = fly();
  if (flown.failed) return end(Status::failed);
  if (flown.landing == 0.0 && flown.holds && mode_.motor != Motored::holds) return end(Status::indeterminate);
  if (count_lift_off(flown)) return end(Status::jumped);
  time_ += flown.landing;
  if (!(time_ < patience())) return end(Status::stalled);
  at_ = flown.before, brakes_ = after_flight_, way_ = flown.way;
  if (!(runway_left(at_) > 0.0)) return end(Status::no_jump);
  stays_held_ = mode_.motor == Motored::holds;
  if (flown.landing > 0.0) at_ = landing_of(flown).after;
  decide_motor(stays_held_);
  if (at_.y_rate > 0.0) return Next::flies;
  return next_of(flown.landing > 0.0 ? Leaving::always : Leaving::never);
}

}  // namespace leapmap::referee
