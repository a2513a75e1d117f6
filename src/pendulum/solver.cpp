// SPDX-License-Identifier: GPL-3.0-or-later
#include "pendulum/solver.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "hoop/flight_search.hpp"
#include "hoop/jump_rule.hpp"
#include "hoop/landing.hpp"
#include "hoop/units.hpp"

namespace leapmap::pendulum {
namespace {

/// A dip that is none but for roundings.
void forget_rounding(Flight<double>& flight) {
  if (flight.dip > -1e-14) flight.dip = 0.0;
}

/// Where a robot is some time after a lift-off, under a steady torque.
Y flown(const Robot& r, const Y& at, double torque, double t) {
  const double of_hoop = -torque / r.J, of_pendulum = torque / r.A_free;
  Y there = at;
  there[phi] += t * (at[w] + 0.5 * of_hoop * t), there[w] += of_hoop * t;
  there[psi] += t * (at[u] + 0.5 * of_pendulum * t), there[u] += of_pendulum * t;
  const SinCos<double> from = sincos_of(at[psi]), to = sincos_of(there[psi]);
  // The centre of mass, at x - rho s and y - rho c, falls freely.
  const double along = at[vx] - r.rho * from.cos * at[u], across = at[vy] + r.rho * from.sin * at[u];
  there[x] += t * (along + 0.5 * r.sin_slope * t) + r.rho * (to.sin - from.sin);
  there[y] += t * (across - 0.5 * r.cos_slope * t) + r.rho * (to.cos - from.cos);
  there[vx] = along + r.sin_slope * t + r.rho * to.cos * there[u];
  there[vy] = across - r.cos_slope * t - r.rho * to.sin * there[u];
  there[work] += torque * ((there[psi] - at[psi]) - (there[phi] - at[phi]));
  return there;
}

}  // namespace

Y released(const Design& design) {
  Y at{};
  at[phi] = design.release_angle, at[w] = at[vx] = design.release_spin;
  at[psi] = design.pendulum_angle, at[u] = design.pendulum_spin;
  return at;
}

void Solver::begin(const Design& design, const Scene& scene) {
  scene_ = &scene;
  outcome_ = {}, sequence_ = {}, over_ = is_begun_ = false;
  time_ = slipped_ = 0.0, pieces_ = 0, contact_.steps = flight_.steps = 0;
  at_ = released(design);
  friction_ = contact_of<double>(design, scene);
  contact_.system = {.robot = reduce(design), .motor = Motor(design, scene)};
  contact_.bounds = {friction_.mu_static, 2.0 * std::numbers::pi * scene.runway, scene.patience};
  flight_.bounds = {.patience = HUGE_VAL};
  contact_.observer = observer_->contact_step, flight_.observer = observer_->flight_step;
  released_energy_ = energy(contact_.system.robot, at_);
}

Outcome Solver::solve(const Design& design, const Scene& scene, const Observer& observer) {
  observer_ = &observer;
  begin(design, scene);
  if (!contact_.system.robot.is_sound())
    ended(Status::indeterminate);
  else
    scene.friction == Friction::coulomb ? solve_sliding() : solve_sticking();
  to_seconds(outcome_, time_unit(scene));
  return outcome_;
}

/// What is not known of a design that has no answer is not told.
void Solver::ended(Status status, const char* reason) {
  if (status == Status::failed || status == Status::indeterminate) outcome_ = {};
  outcome_.status = status, outcome_.failure = reason;
  over_ = true;
}

/// The motor's piece at a state, in contact or in flight as the system is.
void Solver::decide_motor(System& system, const Y& at, bool at_speed) {
  system.motor.decide(turning(at), at_speed, [&] {
    return system.forces(at, Drive<double>{0.0, true}).torque;
  });
}

/// Goes on to the motor's next piece, at the state where an event ended the last one.
void Solver::pass_motor_event(System& system, Y& at, Watch watch) {
  const MotorEvent event = motor_event(watch);
  const bool at_speed = event == MotorEvent::reaches_speed;
  if (at_speed) at[u] = at[w] + system.motor.speed_to_hold();
  if (!system.motor.pass(event)) decide_motor(system, at, at_speed);
}

/// Lets whoever looks on see the release, which may be all there is before a lift-off.
void Solver::show_release() const {
  if (!contact_.observer) return;
  contact_.observer({contact_.system, 0.0, 0.0, at_, [this](double, Y& at) {
                       at = at_;
                       return true;
                     }});
}

/// Whether all moments cancel, but for roundings of their own size.
bool Solver::is_at_rest() const {
  if (at_[w] != 0.0 || at_[u] != 0.0 || at_[vx] != 0.0) return false;
  const System& system = contact_.system;
  const Robot& r = system.robot;
  const SinCos<double> angle = sincos_of(at_[psi]);
  const Drive<double> drive = system.drive(at_);
  const double slope = r.sin_slope, weight = -r.rho * (r.sin_slope * angle.cos + r.cos_slope * angle.sin);
  const auto cancel = [](double a, double b, double size) {
    return std::abs(a + b) <= 4.0 * std::numeric_limits<double>::epsilon() * size;
  };
  const double torque = drive.torque;
  const bool rests = drive.holds ? cancel(slope, weight, std::abs(slope) + r.rho)
                                 : cancel(slope, -torque, std::abs(slope) + std::abs(torque)) &&
                                       cancel(torque, weight, std::abs(torque) + r.rho);
  return rests && system.forces(at_).normal > 0.0;
}

/// Counts how often a robot that is held together turns round. One that rolls keeps its energy: when it has
/// turned at one end, at the other and at the first again, it has gone through all there is, both ways.
bool Solver::rocks(Watch watch) {
  constexpr int all = 3;
  return (watch == Watch::stops_forwards || watch == Watch::stops_backwards) && ++turns_ == all;
}

/// Whether the plane would push here without slip if the motor gave no torque.
bool Solver::is_held_down_without_motor() const {
  return contact_.system.forces(at_, Drive<double>{}).normal > 0.0;
}

void Solver::solve_sticking() {
  System& system = contact_.system;
  decide_motor(system, at_, false);
  if (is_at_rest()) return ended(Status::stalled);
  show_release();
  if (observer_->phase) observer_->phase(Phase::rolling, 0, 0.0, at_);
  if (!(system.forces(at_).normal > 0.0)) {
    if (!is_held_down_without_motor()) return ended(Status::airborne_at_release);
    if (take_lift_off(0.0, at_)) return;
  }
  for (int piece = 0; piece < most_pieces; ++piece) {
    contact_.watches = {Watch::normal_force, Watch::runway};
    contact_.watch_motor();
    turns_ = 0;
    Watch ended_by{};
    const Followed followed = contact_.follow(time_, at_, [&](Watch watch, double time, const Y& at) {
      ended_by = watch;
      if (watch == Watch::normal_force) return take_lift_off(time, at);
      return watch == Watch::runway || is_of_motor(watch) || rocks(watch);
    });
    if (over_) return;
    if (followed == Followed::failed) return ended(Status::failed, no_phase);
    const bool repeats = followed == Followed::stopped && ended_by != Watch::runway && !is_of_motor(ended_by);
    if (followed == Followed::out_of_time || repeats) return ended(Status::stalled);
    if (ended_by == Watch::runway) return ended(Status::no_jump);
    if (take_motor_event(ended_by)) return;
    if (is_at_rest()) return ended(Status::stalled);
  }
  ended(Status::failed, too_many);
}

/// Goes on to the motor's next piece. A normal force that falls to zero or below with it is a lift-off. True:
/// the jump.
bool Solver::take_motor_event(Watch watch) {
  System& system = contact_.system;
  const double before = system.forces(at_).normal;
  pass_motor_event(system, at_, watch);
  return before > 0.0 && !(system.forces(at_).normal > 0.0) && take_lift_off(time_, at_);
}

/// Looks at a lift-off without slip. True: it ends the design, by a jump or a failure.
bool Solver::take_lift_off(double time, const Y& at) {
  Flight<double> flight;
  if (!fly(time, at, flight)) {
    ended(Status::failed, no_phase);
    return true;
  }
  if (!consider_flight(time, at, flight)) return false;
  land_jump(at);
  over_ = true;
  return true;
}

bool Solver::consider_flight(double time, const Y& at, const Flight<double>& flight) {
  if (observer_->lift_off) observer_->lift_off(time, at, flight);
  return consider(outcome_, *scene_, {time, at[phi], at[w]}, flight, at[x]);
}

/// A flight under a steady torque, of which nothing is integrated: the same as a hoop's with its motor on.
void Solver::fly_steadily(double time, const Y& at, double torque, Flight<double>& flight) {
  const System& system = flight_.system;
  const Robot& r = system.robot;
  const Hoop<double> hoop{.sin_slope = r.sin_slope,
                          .cos_slope = r.cos_slope,
                          .rho = r.rho,
                          .clearance = 1.0 - r.rho,
                          .Ic = r.A_free,
                          .J_min = r.A_free + (1.0 - r.rho) * (1.0 - r.rho),
                          .drive = torque,
                          .thrust = r.sin_slope + torque,
                          .aloft = torque / r.A_free};
  const LiftOff<double> lift_off{time, at[psi], at[u]};
  flight = at[vy] > 0.0 ? fly_off(hoop, lift_off, at[vy]) : leapmap::fly(hoop, lift_off);
  const auto state_at = [&](double t, Y& there) {
    there = flown(r, at, torque, t);
    return true;
  };
  if (flight_.observer) flight_.observer({system, time, flight.flight_time, at, state_at});
  state_at(flight.flight_time, landed_);
  landed_[y] = 0.0;
  forget_rounding(flight);
}

/// Follows a flight to its landing, which landed_ is just before. False: the method fails.
bool Solver::fly(double time, const Y& at, Flight<double>& flight) {
  const double began = time;
  double best = 0.0;
  bool landed = false, sinks = false;
  flight = {};
  landed_ = at;
  flight_.system = contact_.system;
  System& system = flight_.system;
  system.mode = ContactMode::flies, system.idles = !scene_->motor_in_flight;
  if (!system.idles) decide_motor(system, at, false);
  if (const auto torque = system.idles ? 0.0 : system.motor.steady_torque()) {
    fly_steadily(time, at, *torque, flight);
    return true;
  }
  for (int piece = 0; piece < most_pieces; ++piece) {
    flight_.watches = {Watch::height, Watch::climb, Watch::descent, Watch::reach};
    flight_.watch_motor();
    Watch ended_by{};
    const Followed followed = flight_.follow(time, landed_, [&](Watch watch, double when, const Y& there) {
      ended_by = watch;
      if (watch == Watch::climb && there[y] > best) best = there[y], flight.apex_time = when - began;
      if (watch == Watch::descent && best == 0.0) flight.dip = std::min(flight.dip, 0.5 * there[y]);
      landed = watch == Watch::height && best > 0.0;
      sinks = watch == Watch::reach && best == 0.0;
      return landed || sinks || is_of_motor(watch);
    });
    if (followed != Followed::stopped) return false;
    if (landed || sinks) break;
    pass_motor_event(system, landed_, ended_by);
  }
  if (!landed) {
    landed_ = at, flight = {};  // it never clears the plane
    return sinks;
  }
  landed_[y] = 0.0;
  flight.height = 0.5 * best, flight.flight_time = time - began;
  forget_rounding(flight);
  return true;
}

/// Lands from the end of a flight: landed_ becomes the state just after it. Returns the normal impulse. The
/// motor's torque is finite, so that hoop and pendulum each take what they are given; with friction a motor
/// that holds them together goes on to hold where they would part more slowly than rest_speed, or each
/// landing would lift them off again, ever less.
double Solver::land() {
  const Robot& r = contact_.system.robot;
  const auto [s, c] = sincos_of(landed_[psi]);
  const double along = r.rho * c / r.A_free, across = -r.rho * s / r.A_free;  // what impulses make of u
  const ContactResponse<double> W{1.0 + r.rho * c * along + 1.0 / r.J, -r.rho * s * along,
                                  1.0 - r.rho * s * across};
  const double slip = landed_[vx] - landed_[w], normal = landed_[vy];
  const bool slips = scene_->friction == Friction::coulomb;
  RouthEnd<double> end{};
  if (slips) {
    end = routh_path(W, slip, normal, friction_.mu_kinetic, friction_.restitution, friction_.rest_speed);
  } else {  // both directions are stopped
    const double determinant = W.tt * W.nn - W.tn * W.tn;
    end.impulse = {(W.tn * normal - W.nn * slip) / determinant, (W.tn * slip - W.tt * normal) / determinant};
  }
  double hoop = -end.impulse.friction / r.J,
         pendulum = along * end.impulse.friction + across * end.impulse.normal;
  stays_held_ =
      slips && flight_.system.motor.is_holding() && std::abs(pendulum - hoop) < friction_.rest_speed;
  if (stays_held_) {
    const double inertia = r.A_free + r.J, arm = 1.0 - r.rho * c, lever = r.rho * s;
    const ContactResponse<double> one{1.0 + arm * arm / inertia, arm * lever / inertia,
                                      1.0 + lever * lever / inertia};
    end = routh_path(one, slip, normal, friction_.mu_kinetic, friction_.restitution, friction_.rest_speed);
    hoop = pendulum = -(arm * end.impulse.friction + lever * end.impulse.normal) / inertia;
  }
  landed_[w] += hoop, landed_[u] += pendulum;
  landed_[vx] = end.slip + landed_[w], landed_[vy] = end.normal;
  return end.impulse.normal;
}

/// The same of the jump, from its lift-off on, with what its landing comes to.
void Solver::land_jump(const Y& lift_off) {
  const Robot& robot = contact_.system.robot;
  const Y before = landed_;
  outcome_.jump_range = before[x] - lift_off[x];
  outcome_.landing_normal_speed = -before[vy];
  outcome_.landing_tangential_speed = before[vx] - before[w];
  outcome_.landing_impulse = land();
  outcome_.landing_energy_lost = energy(robot, before) - energy(robot, landed_);
}

}  // namespace leapmap::pendulum
