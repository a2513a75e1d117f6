// SPDX-License-Identifier: GPL-3.0-or-later
/// One robot on its way, by its referee: what the motor does (robot_motor.cpp), what the contact does
/// (robot_contact.cpp), and flights (robot_flight.cpp), as they follow one another (robot_run.cpp).
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "integrate/guarded_steps.hpp"
#include "numerics/gsl_integrator.hpp"
#include "referee/robot.hpp"
#include "referee/sampled.hpp"

namespace leapmap::referee {

/// Relative, of sums of a few terms.
inline constexpr double robot_rounding = 32.0 * std::numeric_limits<double>::epsilon();
inline constexpr int most_robot_pieces = 2'000;

class RobotRun {
 public:
  RobotRun(const Scene& scene, const Design& design, double tolerance, long most_steps, bool meets_forces);
  // The integrators keep its address.
  RobotRun(const RobotRun&) = delete;
  RobotRun& operator=(const RobotRun&) = delete;

  Outcome solve();

 private:
  using Y = State<9>;
  using Guard = GuardOf<RobotMotion>;
  enum class Next { rolls, slides_forwards, slides_backwards, flies, ended };
  enum class Leaving { unless_it_sticks, always, never };
  struct Moving;
  /// Of a state, as GSL asks for them.
  static int rates(double time, const double y[], double f[], void* params);

  // The motor.
  bool is_until() const { return robot_.law == MotorLaw::until_angle || robot_.law == MotorLaw::until_speed; }
  bool follows() const;
  bool seeks_speed() const;
  /// As the solver has it: a torque that only touches its limit lets nothing go.
  double slack() const { return 1e-9 * std::abs(robot_.stall); }
  double sought() const { return robot_.law == MotorLaw::speed ? robot_.target : 0.0; }
  double way_to_target(const RobotMotion& at) const;
  double needed(const RobotMotion& at) const;
  void decide_motor(bool at_speed);
  struct MotorGuard {
    Guard guard;
    std::function<void()> passes;
  };
  std::vector<MotorGuard> motor_guards();

  // The event loop.
  /// On to the first guard for which happens(number) is true; of the motor's guards it always is. -1: it
  /// could not be followed. -2: its time is over.
  int follow(GslIntegrator<9>& integrator, const std::vector<Guard>& contact,
             const std::function<bool(int)>& happens, double ends);

  // The way.
  struct Look {
    double force = 0.0, power = -HUGE_VAL, speed = 0.0, torque = 0.0;
  };
  Look look_at(const RobotMotion& at) const;
  void meet(const GslIntegrator<9>& integrator, double end);

  // Flights.
  struct Flown {
    double height = 0.0, apex = 0.0, landing = 0.0, dip = 0.0;
    bool failed = false, holds = false;
    RobotMotion before{};
    Look way;  ///< with the flight
  };
  /// A flight from at_, which stays where it is.
  Flown fly();
  /// A motor that holds goes on to hold where the two would part more slowly than rest_speed.
  RobotLanded landing_of(const Flown& flown);
  bool count_lift_off(const Flown& flown);

  // The contact.
  double patience() const { return scene_.patience * second_; }
  double runway_left(const RobotMotion& at) const;
  /// Whether every body's moments cancel, but for roundings of their own size.
  bool rests() const;
  Outcome without_slip();
  double slip_of(const RobotMotion& at) const;
  double free_rise(const RobotMotion& at) const;
  double hold(const RobotMotion& at, double sign) const;
  Next next_of(Leaving leaving);
  Outcome with_friction();
  Next end(Status status);
  Next touch(Next now, bool is_new);
  Next fly_and_land();
  Outcome finish(Status status);

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

}  // namespace leapmap::referee
