// SPDX-License-Identifier: GPL-3.0-or-later
/// A robot with friction: rolling, sliding, flying and landing.
#include <cmath>

#include "hoop/units.hpp"
#include "pendulum/solver.hpp"
#include "support/stop.hpp"

namespace leapmap::pendulum {

/// n0 without the motor's torque: above zero contact would be consistent.
double Solver::held_down() const {
  const Robot& robot = contact_.system.robot;
  return robot.cos_slope + robot.rho * sincos_of(at_[psi]).cos * at_[u] * at_[u];
}

/// Whether n0 is not above zero.
bool Solver::lifts_off() const {
  const System& system = contact_.system;
  return free_normal_force(system.robot, sincos_of(at_[psi]), at_[u], system.drive(at_)) <= 0.0;
}

/// How the contact goes on at at_, and with it the motor: at v != 0 it slides, at v = 0 the forces decide.
auto Solver::next_contact(Leaving leaving) -> Next {
  System& system = contact_.system;
  const double slip = at_[vx] - at_[w];
  const bool would_leave = leaving != Leaving::never && lifts_off();
  if (would_leave && (leaving == Leaving::always || slip != 0.0)) return Next::leaves;
  if (slip != 0.0) return slip > 0.0 ? Next::slides_forwards : Next::slides_backwards;
  system.mode = ContactMode::rolls;
  const Forces<double> f = system.forces(at_);
  if (f.normal > 0.0 && std::abs(f.friction) <= static_friction(f, friction_.mu_static)) return Next::rolls;
  if (would_leave) return Next::leaves;
  return f.friction > 0.0 ? Next::slides_backwards : Next::slides_forwards;
}

/// True: it has ended, as it goes through more phases than a design may.
bool Solver::has_too_many_phases() {
  if (sequence_.count() < most_phases) return false;
  const bool rebounds = friction_.restitution > 0.0 && friction_.rest_speed < 1e-12;
  ended(Status::failed, rebounds ? endless_rebounds : too_many);
  return true;
}

/// Puts the contact into its next phase; a phase that merely goes on with another torque is none. False: it
/// has ended.
bool Solver::begin_contact(Next next) {
  System& system = contact_.system;
  const double direction = next == Next::slides_forwards ? 1.0 : next == Next::slides_backwards ? -1.0 : 0.0;
  const ContactMode mode = next == Next::rolls ? ContactMode::rolls : ContactMode::slides;
  const bool goes_on = is_begun_ && system.mode == mode && system.direction == direction;
  system.mode = mode, system.direction = direction, system.drag = -friction_.mu_kinetic * direction;
  if (!goes_on)
    decide_motor(system, at_, system.motor.is_holding());  // another phase may take another torque
  const bool has_answer = mode == ContactMode::rolls || pivot(system.robot, sincos_of(at_[psi]), system.drag,
                                                              system.motor.is_holding()) > 0.0;
  if (goes_on && has_answer) return true;
  if (!goes_on && has_too_many_phases()) return false;
  is_begun_ = true;
  const Phase phase = mode == ContactMode::rolls ? Phase::rolling : Phase::sliding;
  if (!goes_on) {
    sequence_.append(phase);
    if (observer_->phase) observer_->phase(phase, static_cast<int>(direction), time_, at_);
  }
  if (!has_answer) ended(Status::indeterminate);
  return has_answer;
}

/// Through one piece of the phase, and what comes after it.
auto Solver::follow_contact() -> Next {
  const System& system = contact_.system;
  if (system.mode == ContactMode::rolls)
    contact_.watches = {Watch::hold_forwards, Watch::hold_backwards, Watch::normal_force, Watch::runway};
  else
    contact_.watches = {Watch::lift, Watch::slip, Watch::runway, Watch::pivot};
  contact_.watch_motor();
  const Y from = at_;
  Watch ended_by{};
  turns_ = 0;
  if (++pieces_ > most_pieces) {
    ended(Status::failed, too_many);
    return {};
  }
  const Followed followed = contact_.follow(time_, at_, [&](Watch watch, double, const Y&) {
    ended_by = watch;
    const bool turns = watch == Watch::stops_forwards || watch == Watch::stops_backwards;
    return !turns || rocks(watch);
  });
  if (system.mode == ContactMode::slides) slipped_ += std::abs((at_[x] - from[x]) - (at_[phi] - from[phi]));
  if (followed == Followed::stopped) return after(ended_by);
  followed == Followed::failed ? ended(Status::failed, no_phase) : ended(Status::stalled);
  return {};
}

auto Solver::after(Watch watch) -> Next {
  switch (watch) {
    case Watch::hold_forwards:
      return lifts_off() ? Next::leaves : Next::slides_forwards;
    case Watch::hold_backwards:
      return lifts_off() ? Next::leaves : Next::slides_backwards;
    case Watch::normal_force:
    case Watch::lift:
      return Next::leaves;
    case Watch::slip:
      at_[vx] = at_[w];
      return next_contact(Leaving::unless_it_sticks);
    case Watch::runway:
      ended(Status::no_jump);
      return {};
    case Watch::stops_forwards:
    case Watch::stops_backwards:
      ended(Status::stalled);
      return {};
    case Watch::pivot:
      ended(Status::indeterminate);
      return {};
    default:
      break;
  }
  pass_motor_event(contact_.system, at_, watch);
  return next_contact(Leaving::unless_it_sticks);
}

/// A flight from at_, and the landing after it, unless it is the jump.
auto Solver::fly_and_land() -> Next {
  const Robot& robot = contact_.system.robot;
  // A motor that lifts the robot and idles as soon as it is off: neither contact nor flight is consistent.
  if (!scene_->motor_in_flight && !(at_[vy] > 0.0) && held_down() > 1e-9) {
    ended(Status::indeterminate);
    return {};
  }
  if (has_too_many_phases()) return {};
  sequence_.append(Phase::flight);
  is_begun_ = false;
  if (observer_->phase) observer_->phase(Phase::flight, 0, time_, at_);
  Flight<double> flight;
  if (!fly(time_, at_, flight)) {
    ended(Status::failed, no_phase);
    return {};
  }
  // In contact the motor cannot hold the two together, and in flight, where it can, the robot would sink.
  if (flight.flight_time == 0.0 && flight_.system.motor.is_holding() && !contact_.system.motor.is_holding()) {
    ended(Status::indeterminate);
    return {};
  }
  const Y from = at_;
  const bool jumps = consider_flight(time_, from, flight);
  if (jumps) {
    outcome_.energy_lost = released_energy_ + from[work] - energy(robot, from);
    land_jump(from);
    outcome_.landing_spin = landed_[w];
    over_ = true;
    return {};
  }
  time_ += flight.flight_time;
  if (!(time_ < contact_.bounds.patience)) {
    ended(Status::stalled);
    return {};
  }
  if (!(std::abs(landed_[x]) < contact_.bounds.runway)) {
    ended(Status::no_jump);
    return {};
  }
  stays_held_ = contact_.system.motor.is_holding();
  if (flight.flight_time > 0.0) land();
  at_ = landed_;
  contact_.system.motor = flight_.system.motor;
  decide_motor(contact_.system, at_, stays_held_);
  if (at_[vy] > 0.0) return Next::leaves;
  return next_contact(flight.flight_time > 0.0 ? Leaving::always : Leaving::never);
}

void Solver::solve_sliding() {
  decide_motor(contact_.system, at_, false);
  const bool from_rest = is_at_rest();
  show_release();
  Next next = next_contact(Leaving::unless_it_sticks);
  if (from_rest && next == Next::rolls) return ended(Status::stalled);
  if (next == Next::leaves && !(held_down() > 0.0)) return ended(Status::airborne_at_release);
  while (!over_) {
    throw_if_stopped();
    if (next == Next::leaves) {
      next = fly_and_land();
    } else if (begin_contact(next)) {
      next = follow_contact();
    }
  }
  outcome_.phase_sequence = sequence_.code();
  if (outcome_.status != Status::failed && outcome_.status != Status::indeterminate)
    outcome_.slip_distance = slipped_;
}

}  // namespace leapmap::pendulum
