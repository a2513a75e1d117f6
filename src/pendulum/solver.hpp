// SPDX-License-Identifier: GPL-3.0-or-later
/// One robot from its release to its jump, by integration: without slip, where it rolls on through N < 0 as
/// the paper's hoop does, or with friction, as contact_phases.hpp has it for hoops. New is that the motor's
/// pieces end as well, and with one the forces jump: a torque that lifts the robot the moment it is switched
/// on, or over, makes a lift-off there, at t = 0 too.
#pragma once

#include <functional>

#include "friction/contact_phases.hpp"
#include "hoop/flight.hpp"
#include "leapmap/outcome.hpp"
#include "pendulum/integration.hpp"

namespace leapmap::pendulum {

/// Looks on while a robot is solved; unset functions cost nothing. Times since release in sqrt(R/g).
struct Observer {
  std::function<void(Phase, int direction, double time, const Y&)> phase;
  std::function<void(double time, const Y&, const Flight<double>&)> lift_off;  ///< after the flight's steps
  StepObserver contact_step, flight_step;
};

/// Why designs fail.
inline constexpr const char* no_phase = "a phase could not be solved to the tolerance";
inline constexpr const char* too_many = "more phases than a design may go through";

/// Of a motor's torque in one phase, or of a contact.
inline constexpr int most_pieces = 2'000;

/// The state at release.
Y released(const Design& design);

/// A thread's own workspace.
class Solver {
 public:
  explicit Solver(const IntegrationOptions& options) : contact_(options), flight_(options) {}

  /// Never throws for a bad design: what cannot be solved has status failed and a reason. Times in seconds.
  Outcome solve(const Design& design, const Scene& scene, const Observer& observer = {});

 private:
  void begin(const Design& design, const Scene& scene);
  void ended(Status status, const char* reason = nullptr);
  static void decide_motor(System& system, const Y& at, bool at_speed);
  static void pass_motor_event(System& system, Y& at, Watch watch);
  void show_release() const;
  bool is_at_rest() const;
  bool rocks(Watch watch);
  bool is_held_down_without_motor() const;

  void solve_sticking();
  bool take_motor_event(Watch watch);
  bool take_lift_off(double time, const Y& at);

  enum class Next { rolls, slides_forwards, slides_backwards, leaves };
  void solve_sliding();
  Next next_contact(Leaving leaving);
  bool begin_contact(Next next);
  Next follow_contact();
  Next after(Watch watch);
  Next fly_and_land();
  double held_down() const;
  bool lifts_off() const;
  bool has_too_many_phases();

  bool fly(double time, const Y& at, Flight<double>& flight);
  void fly_steadily(double time, const Y& at, double torque, Flight<double>& flight);
  bool consider_flight(double time, const Y& at, const Flight<double>& flight);
  double land();
  void land_jump(const Y& lift_off);

  PhaseIntegration contact_, flight_;
  const Scene* scene_ = nullptr;
  const Observer* observer_ = nullptr;
  Contact<double> friction_{};
  Outcome outcome_;
  PhaseSequence sequence_;
  int pieces_ = 0;  ///< that the contact has gone through
  int turns_ = 0;   ///< of the piece that is followed
  bool over_ = false;
  bool stays_held_ = false;  ///< by the motor, through the last landing
  bool is_begun_ = false;    ///< a contact, whose phase may go on
  double time_ = 0.0, released_energy_ = 0.0, slipped_ = 0.0;
  Y at_{}, landed_{};
};

}  // namespace leapmap::pendulum
