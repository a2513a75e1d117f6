// SPDX-License-Identifier: GPL-3.0-or-later
/// One robot by its referee: what the motor does, what the contact does, and flights, as they follow one
/// another.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "integrate/guarded_steps.hpp"
#include "numerics/gsl_integrator.hpp"
#include "referee/largest.hpp"
#include "referee/robot.hpp"

namespace leapmap::referee {
namespace two_bodies {
namespace {

constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();
constexpr int most_pieces = 2'000;
using Y = State<9>;
using Guard = std::function<double(const RobotMotion&)>;
enum class Next { rolls, slides_forwards, slides_backwards, flies, ended };
enum class Leaving { unless_it_sticks, always, never };

RobotMotion motion_of(const Y& y) { return {y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7], y[8]}; }
Y state_of(const RobotMotion& at) {
  return {at.x, at.y, at.phi, at.psi, at.x_rate, at.y_rate, at.spin, at.swing, at.work};
}

/// One design on its way.
class Run {
 public:
  Run(const Scene& scene, const Design& design, double tolerance, long most_steps, bool meets_forces)
      : scene_(scene),
        meets_forces_(meets_forces),
        robot_(robot_of(design, scene)),
        second_(std::sqrt(scene.radius / scene.gravity)),
        mu_kinetic_(std::isnan(design.mu_kinetic) ? design.mu_static : design.mu_kinetic),
        mu_static_(std::max(design.mu_static, mu_kinetic_)),
        restitution_(design.restitution),
        least_(tolerance * std::min({1.0, scene.radius, 1.0 / second_, scene.radius / second_})),
        integrator_(*find_gsl_stepper("gsl-rk8pd"), {.relative = tolerance, .absolute = least_},
                    {&rates, nullptr, 9, this}),
        aloft_(*find_gsl_stepper("gsl-rk8pd"), {.relative = tolerance, .absolute = least_},
               {&rates, nullptr, 9, this}),
        most_steps_(most_steps) {
    const double w = design.release_spin / second_;
    at_ = {0.0,
           scene.radius,
           design.release_angle,
           design.pendulum_angle,
           scene.radius * w,
           0.0,
           w,
           design.pendulum_spin / second_,
           0.0};
    released_ = energy(robot_, at_);
  }

  Outcome solve() {
    const bool has_motion = robot_.m_p * robot_.L > 0.0 && robot_.I > 0.0;
    if (!has_motion) return finish(Status::indeterminate);
    decide_motor(false);
    way_ = look_at(at_);
    way_.force = std::max(way_.force, 0.0);  // of a torque that lifts it at once
    return scene_.friction == Friction::coulomb ? with_friction() : without_slip();
  }

 private:
  static int rates(double, const double y[], double f[], void* params) {
    const Run& run = *static_cast<const Run*>(params);
    Y state;
    std::copy_n(y, 9, state.begin());
    const RobotMotion at = motion_of(state);
    const RobotForces a = forces_of(run.robot_, run.mode_, at);
    const Y rate{
        at.x_rate, at.y_rate, at.spin, at.swing, a.x, a.y, a.phi, a.psi, a.torque * (at.swing - at.spin)};
    std::ranges::copy(rate, f);
    return GSL_SUCCESS;
  }

  // The motor.

  bool is_until() const { return robot_.law == MotorLaw::until_angle || robot_.law == MotorLaw::until_speed; }
  bool follows() const {
    return robot_.law == MotorLaw::angle || (robot_.law == MotorLaw::speed && std::isfinite(robot_.gain));
  }
  bool seeks_speed() const { return brakes_ || (robot_.law == MotorLaw::speed && !follows()); }
  /// As the solver has it: a torque that only touches its limit lets nothing go.
  double slack() const { return 1e-9 * std::abs(robot_.stall); }
  double sought() const { return robot_.law == MotorLaw::speed ? robot_.target : 0.0; }
  double way_to_target(const RobotMotion& at) const {
    const double here = robot_.law == MotorLaw::until_angle ? at.psi : at.swing - at.spin;
    return std::copysign(1.0, robot_.stall) * (robot_.target - here);
  }
  double needed(const RobotMotion& at) const {
    RobotMode holding = mode_;
    holding.motor = Motored::holds;
    return forces_of(robot_, holding, at).torque;
  }

  void decide_motor(bool at_speed) {
    if (is_until() && way_to_target(at_) <= 0.0) brakes_ = true;
    const MotorRange range = motor_range(robot_, at_);
    if (follows()) {
      mode_.motor = range.wanted > range.up     ? Motored::up
                    : range.wanted < range.down ? Motored::down
                                                : Motored::follows;
    } else if (seeks_speed()) {
      const double missing = sought() - (at_.swing - at_.spin);
      mode_.motor = missing > 0.0 ? Motored::up : Motored::down;
      const double near = 2.0 * rounding * (std::abs(at_.swing) + std::abs(at_.spin) + std::abs(sought()));
      if (!at_speed && std::abs(missing) > near) return;
      const double torque = needed(at_);
      mode_.motor = torque > range.up + slack()     ? Motored::up
                    : torque < range.down - slack() ? Motored::down
                                                    : Motored::holds;
    } else {
      mode_.motor = robot_.stall < 0.0 ? Motored::down : Motored::up;
    }
  }

  struct MotorGuard {
    Guard guard;
    std::function<void()> passes;
  };
  std::vector<MotorGuard> motor_guards() {
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
        guards.push_back(
            {[this, now](const RobotMotion& at) {
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

  // The event loop.

  /// On to the first guard for which happens(number) is true; of the motor's guards it always is. -1: it
  /// could not be followed. -2: its time is over.
  int follow(GslIntegrator<9>& integrator, const std::vector<Guard>& contact,
             const std::function<bool(int)>& happens, double ends) {
    const std::vector<MotorGuard> motor = motor_guards();
    std::vector<Guard> guards = contact;
    for (const MotorGuard& one : motor) guards.push_back(one.guard);
    const auto sample = [&](std::size_t number, const Y& y) {
      const Guard& guard = guards[number];
      Y f;
      rates(0.0, y.data(), f.data(), this);
      const double d = 1e-5 / (std::abs(y[6]) + std::abs(y[7]) + 1.0 / second_);
      Y ahead = y, behind = y;
      for (std::size_t i = 0; i < 9; ++i) ahead[i] += d * f[i], behind[i] -= d * f[i];
      return Sample<double>{guard(motion_of(y)),
                            (guard(motion_of(ahead)) - guard(motion_of(behind))) / (2.0 * d)};
    };
    const Y start = state_of(at_);
    const double began = time_;
    if (!(began < ends)) return -2;
    GuardedSteps<9> steps;
    steps.begin(start, guards.size(), sample);
    if (!integrator.start(start, 0.01 / (1.0 / second_ + std::abs(at_.swing)))) return -1;
    for (;;) {
      if (++steps_ > most_steps_ ||
          steps.take(
              integrator, [](const Y& y) { return y[3]; }, 16.0, sample) != Stepped::taken)
        return -1;
      const Step<9>& step = integrator.step();
      for (const Event<9>& event : steps.events()) {
        if (began + step.t0 + event.tau > ends) break;
        at_ = motion_of(event.state), time_ = began + step.t0 + event.tau;
        const std::size_t number = event.guard;
        // The way so far counts before whatever ends it.
        const bool of_motor = number >= contact.size();
        if (meets_forces_ && (of_motor || &integrator == &integrator_)) meet(integrator, event.tau);
        if (of_motor) {
          motor[number - contact.size()].passes();
          return static_cast<int>(number);
        }
        if (!happens(static_cast<int>(number))) continue;
        if (meets_forces_ && &integrator == &aloft_) meet(integrator, event.tau);
        return static_cast<int>(number);
      }
      if (meets_forces_) meet(integrator, std::min(step.h, ends - (began + step.t0)));
      const double left = ends - (began + step.t0);
      Y last = step.y1;
      if (step.h > left && !integrator.retake(left, last)) return -1;
      at_ = motion_of(last), time_ = began + step.t0 + std::min(step.h, left);
      if (step.h > left) return -2;
    }
  }

  // The way.

  struct Look {
    double force = 0.0, power = -HUGE_VAL, speed = 0.0, torque = 0.0;
  };

  Look look_at(const RobotMotion& at) const {
    const RobotForces forces = forces_of(robot_, mode_, at);
    const double speed = at.swing - at.spin;
    return {forces.normal, forces.torque * speed, std::abs(speed), std::abs(forces.torque)};
  }

  void meet(const GslIntegrator<9>& integrator, double end) {
    raise_to_largest(
        integrator, end, [&](const Y& y) { return look_at(motion_of(y)); },
        std::array{&Look::force, &Look::power, &Look::speed, &Look::torque}, way_);
  }

  // Flights.

  struct Flown {
    double height = 0.0, apex = 0.0, landing = 0.0, dip = 0.0;
    bool failed = false, holds = false;
    RobotMotion before{};
    Look way;  ///< with the flight
  };

  /// A flight from at_, which stays where it is.
  Flown fly() {
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
      flown.failed = ended < 0 || piece > most_pieces;
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

  /// A motor that holds goes on to hold where the two would part more slowly than rest_speed.
  RobotLanded landing_of(const Flown& flown) {
    const bool slips = scene_.friction == Friction::coulomb;
    const double mu = slips ? mu_kinetic_ : -1.0, rest_speed = scene_.rest_speed * scene_.radius / second_;
    const RobotLanded apart = land(robot_, flown.before, Motored::idles, mu, restitution_, rest_speed);
    const double parted =
        std::abs((apart.after.swing - apart.after.spin) - (flown.before.swing - flown.before.spin));
    stays_held_ = slips && flown.holds && parted * second_ < scene_.rest_speed;
    return stays_held_ ? land(robot_, flown.before, Motored::holds, mu, restitution_, rest_speed) : apart;
  }

  bool count_lift_off(const Flown& flown) {
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
    outcome_.apex_time = flown.apex, outcome_.flight_time = flown.landing,
    outcome_.dip = flown.dip / diameter;
    outcome_.motor_energy = at_.work / unit;
    if (meets_forces_) {
      outcome_.max_normal_force = way_.force / robot_.weight(),
      outcome_.motor_max_torque = way_.torque / unit;
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

  Outcome finish(Status status) {
    const std::uint64_t sequence = outcome_.phase_sequence;
    if (status == Status::failed) outcome_ = failed_outcome("the reference solver failed");
    if (status == Status::indeterminate) outcome_ = {};
    if (status != Status::failed && status != Status::indeterminate && scene_.friction == Friction::coulomb)
      outcome_.slip_distance = slipped_ / scene_.radius;
    outcome_.phase_sequence = sequence;
    outcome_.status = status;
    return outcome_;
  }

  /// Whether every body's moments cancel, but for roundings of their own size.
  bool rests() const {
    if (at_.spin != 0.0 || at_.swing != 0.0) return false;
    const RobotForces a = forces_of(robot_, mode_, at_);
    const double unit = robot_.weight() * robot_.R;
    const double arm = robot_.m_p * robot_.g * robot_.L, push = unit * std::abs(std::sin(robot_.slope));
    const double hoop = robot_.I + (robot_.m + robot_.m_p) * robot_.R * robot_.R,
                 pendulum = robot_.I_p + robot_.m_p * robot_.L * robot_.L;
    const double size = rounding * (arm + push + std::abs(a.torque));
    return a.normal > 0.0 && std::abs(a.phi) * hoop <= size * (1.0 + hoop / pendulum) &&
           std::abs(a.psi) * pendulum <= size * (1.0 + hoop / pendulum);
  }
  double runway_left(const RobotMotion& at) const {
    return 2.0 * std::numbers::pi * scene_.runway * scene_.radius - std::abs(at.x);
  }
  double patience() const { return scene_.patience * second_; }

  // Without slip.

  Outcome without_slip() {
    if (rests()) return finish(Status::stalled);
    bool pulls = !(forces_of(robot_, mode_, at_).normal > 0.0);
    if (pulls) {
      RobotMode idle = mode_;
      idle.motor = Motored::idles;
      if (!(forces_of(robot_, idle, at_).normal > 0.0)) return finish(Status::airborne_at_release);
    }
    std::optional<Status> ends;
    const auto lifts_off = [&] {
      at_.y = scene_.radius, at_.y_rate = 0.0;  // but for rounding they are
      const Flown flown = fly();
      if (flown.failed)
        ends = Status::failed;
      else if (count_lift_off(flown))
        ends = Status::jumped;
      return ends.has_value();
    };
    if (pulls && lifts_off()) return finish(*ends);
    for (int piece = 0; piece < most_pieces; ++piece) {
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

  // With friction.

  double slip_of(const RobotMotion& at) const {
    const double slip = at.x_rate - robot_.R * at.spin;
    return std::abs(slip) > rounding * std::abs(at.x_rate) ? slip : 0.0;
  }
  double free_rise(const RobotMotion& at) const {
    RobotMode free = mode_;
    free.kind = RobotMode::flies;
    return forces_of(robot_, free, at).y;
  }
  double hold(const RobotMotion& at, double sign) const {
    RobotMode rolling = mode_;
    rolling.kind = RobotMode::rolls;
    const RobotForces f = forces_of(robot_, rolling, at);
    const double slack =
        rounding * (mu_static_ * std::abs(f.normal) + std::abs(f.friction) + std::abs(f.torque) / robot_.R);
    return mu_static_ * f.normal - sign * f.friction + slack;
  }

  Next next_of(Leaving leaving) {
    const double slip = slip_of(at_);
    const bool would_leave = leaving != Leaving::never && free_rise(at_) >= 0.0;
    if (would_leave && (leaving == Leaving::always || slip != 0.0)) return Next::flies;
    if (slip != 0.0) return slip > 0.0 ? Next::slides_forwards : Next::slides_backwards;
    RobotMode rolling = mode_;
    rolling.kind = RobotMode::rolls;
    const double forwards = hold(at_, -1.0), backwards = hold(at_, 1.0);
    if (forces_of(robot_, rolling, at_).normal > 0.0 && forwards >= 0.0 && backwards >= 0.0)
      return Next::rolls;
    if (would_leave) return Next::flies;
    return forwards > backwards ? Next::slides_backwards : Next::slides_forwards;
  }

  Outcome with_friction() {
    const bool at_rest = rests();
    Next next = next_of(Leaving::unless_it_sticks);
    if (at_rest && next == Next::rolls) return finish(Status::stalled);
    RobotMode idle = mode_;
    idle.motor = Motored::idles, idle.kind = RobotMode::flies;
    if (next == Next::flies && forces_of(robot_, idle, at_).y >= 0.0)
      return finish(Status::airborne_at_release);
    Next before = Next::ended;
    for (int piece = 0; piece < most_pieces && next != Next::ended; ++piece) {
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

  Next end(Status status) {
    end_ = status;
    return Next::ended;
  }

  Next touch(Next now, bool is_new) {
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

  Next fly_and_land() {
    RobotMode idle = mode_;
    idle.motor = Motored::idles, idle.kind = RobotMode::flies;
    if (!scene_.motor_in_flight && !(at_.y_rate > 0.0) &&
        forces_of(robot_, idle, at_).y < -1e-9 * scene_.gravity)
      return end(Status::indeterminate);
    const Flown flown = fly();
    if (flown.failed) return end(Status::failed);
    if (flown.landing == 0.0 && flown.holds && mode_.motor != Motored::holds)
      return end(Status::indeterminate);
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

  Scene scene_;
  bool meets_forces_;
  Look way_;  ///< to here
  Robot robot_;
  double second_, mu_kinetic_, mu_static_, restitution_, least_;
  RobotMode mode_{};
  bool brakes_ = false, after_flight_ = false, stays_held_ = false;
  GslIntegrator<9> integrator_, aloft_;  ///< a flight may begin within a step of the contact's
  long most_steps_, steps_ = 0;
  RobotMotion at_{};
  double time_ = 0.0, released_ = 0.0, slipped_ = 0.0;
  int phases_ = 0;
  Status end_ = Status::failed;
  Outcome outcome_;
};

}  // namespace
}  // namespace two_bodies

Outcome solve_robot(const Design& design, const Scene& scene, double tolerance, long most_steps,
                    bool meets_forces) {
  return two_bodies::Run(scene, design, tolerance, most_steps, meets_forces).solve();
}

}  // namespace leapmap::referee
