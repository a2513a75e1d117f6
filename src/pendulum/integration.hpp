// SPDX-License-Identifier: GPL-3.0-or-later
/// One phase of a robot's motion, rolling, sliding or flying, by one of GSL's steppers, until an event ends
/// it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "integrate/guarded_steps.hpp"
#include "integrate/integration_options.hpp"
#include "numerics/maximum.hpp"
#include "pendulum/motor.hpp"
#include "pendulum/robot.hpp"

namespace leapmap::pendulum {

/// Where a robot is and how it moves: phi, psi, their rates w and u; the centre's travel and its rate, the
/// height of the hoop's lowest point and its rate; and the work that the motor has done.
inline constexpr std::size_t dimension = 9;
template <class T>
using Vector = std::array<T, dimension>;
using Y = Vector<double>;
enum Coordinate : std::size_t { phi, psi, w, u, x, vx, y, vy, work };

template <class T>
Turning<T> turning(const Vector<T>& at) {
  return {at[psi], at[w], at[u]};
}

enum class ContactMode { rolls, slides, flies };

/// What holds during a phase.
struct System {
  Robot robot{};
  Motor motor{};
  ContactMode mode = ContactMode::rolls;
  double direction = 0.0;  ///< of sliding: 1 downhill, -1 uphill
  double drag = 0.0;       ///< F / N of sliding
  bool idles = false;      ///< the motor

  template <class T>
  Drive<T> drive(const Vector<T>& at) const {
    return idles ? Drive<T>{} : motor.drive(turning(at));
  }
  template <class T>
  Forces<T> forces(const Vector<T>& at) const {
    return forces(at, drive(at));
  }
  template <class T>
  Forces<T> forces(const Vector<T>& at, const Drive<T>& drive) const {
    const SinCos<T> angle = sincos_of(at[psi]);
    switch (mode) {
      case ContactMode::rolls:
        return rolling(robot, angle, at[u], drive);
      case ContactMode::slides:
        return sliding(robot, angle, at[u], drive, drag);
      case ContactMode::flies:
        break;
    }
    return flying(robot, angle, at[u], drive);
  }
  /// The rates of all coordinates; the last is the motor's power.
  template <class T>
  Vector<T> rates(const Vector<T>& at) const {
    const Forces<T> f = forces(at);
    return {at[w], at[u], f.hoop, f.pendulum, at[vx], f.along, at[vy], f.across, f.torque * (at[u] - at[w])};
  }
  /// A state whose derivative is its rate in time.
  Vector<Rated> rated(const Y& at) const {
    const Y rate = rates(at);
    Vector<Rated> state;
    for (std::size_t i = 0; i < dimension; ++i) state[i].value = at[i], state[i].by[0] = rate[i];
    return state;
  }
};

/// Kinetic and potential energy over (m + m_p) g R, but for a constant.
double energy(const Robot& robot, const Y& at);

/// What a phase looks for; each is a fall through zero of a smooth function of the state.
enum class Watch {
  normal_force,    ///< N of rolling
  hold_forwards,   ///< mu_static N + F
  hold_backwards,  ///< mu_static N - F
  lift,            ///< the free normal force of sliding
  slip,            ///< towards zero
  pivot,           ///< Painleve's edge
  runway,
  stops_forwards,  ///< the hoop's spin, of a robot that is held together: it turns round
  stops_backwards,
  height,
  climb,    ///< of a flight, up to its highest place
  descent,  ///< down to its lowest
  reach,    ///< of a flight: how high it may still come
  motor_target,
  motor_speed,
  motor_high,
  motor_low
};
constexpr Watch watch_of(MotorEvent event) {
  return static_cast<Watch>(static_cast<int>(Watch::motor_target) + static_cast<int>(event));
}
static_assert(watch_of(MotorEvent::low_is_passed) == Watch::motor_low);
constexpr bool is_of_motor(Watch watch) { return watch >= Watch::motor_target; }
constexpr MotorEvent motor_event(Watch watch) {
  return static_cast<MotorEvent>(static_cast<int>(watch) - static_cast<int>(Watch::motor_target));
}

/// Bounds of what is watched.
struct Bounds {
  double mu_static = 0.0;
  double runway = 0.0;    ///< of |x|
  double patience = 0.0;  ///< of the time since release
};

/// A step as it was taken, for whoever looks on: only [0, end] of it was gone through.
struct TakenStep {
  const System& system;
  double began;  ///< time since release at its start
  double end;
  const Y& from;
  std::function<bool(double tau, Y& at)> state_at;  ///< by the method itself; false: it fails
};
using StepObserver = std::function<void(const TakenStep&)>;

enum class Followed { stopped, out_of_time, failed };

/// A thread's own workspace.
class PhaseIntegration {
 public:
  explicit PhaseIntegration(const IntegrationOptions& options);
  PhaseIntegration(const PhaseIntegration&) = delete;
  PhaseIntegration& operator=(const PhaseIntegration&) = delete;

  System system;
  Bounds bounds;
  StepObserver observer;  ///< unset: nobody looks on
  long steps = 0;         ///< taken since it was set to zero

  /// Moves the state and its time through the phase. happens(Watch, time, state) of every event, in order;
  /// true: the phase ends there.
  template <class Happens>
  Followed follow(double& time, Y& at, const Happens& happens);

  /// What the phase watches.
  std::vector<Watch> watches;
  /// Adds what may end the motor's piece.
  void watch_motor();

 private:
  Sample<double> sample(Watch watch, const Y& at) const;
  Rated value(Watch watch, const Vector<Rated>& at) const;

  IntegrationOptions options_;
  GslIntegrator<dimension> integrator_;
  GuardedSteps<dimension> guarded_;
};

template <class Happens>
Followed PhaseIntegration::follow(double& time, Y& at, const Happens& happens) {
  const auto sampled = [&](std::size_t number, const Y& y) { return sample(watches[number], y); };
  const auto angle = [](const Y& y) { return y[psi]; };
  const double began = time;
  if (!(began < bounds.patience)) return Followed::out_of_time;
  guarded_.begin(at, watches.size(), sampled);
  if (!integrator_.start(at, 0.1 / (1.0 + std::abs(at[u]) + std::abs(at[w])))) return Followed::failed;
  for (;;) {
    constexpr double looks = 8.0;
    if (++steps > options_.max_steps || guarded_.take(integrator_, angle, looks, sampled) != Stepped::taken)
      return Followed::failed;
    const Step<dimension>& step = integrator_.step();
    const auto tell = [&](double end) {
      if (observer)
        observer({system, began + step.t0, end, step.y0,
                  [&](double tau, Y& y) { return integrator_.retake(tau, y); }});
    };
    for (const Event<dimension>& event : guarded_.events()) {
      const double when = began + step.t0 + event.tau;
      if (when > bounds.patience) break;
      if (!happens(watches[event.guard], when, event.state)) continue;
      tell(event.tau);
      time = when, at = event.state;
      return Followed::stopped;
    }
    if (began + step.t0 + step.h > bounds.patience) {
      const double rest = bounds.patience - (began + step.t0);
      tell(rest);
      time = bounds.patience;
      return integrator_.retake(rest, at) ? Followed::out_of_time : Followed::failed;
    }
    tell(step.h);
    time = began + step.t0 + step.h, at = step.y1;
  }
}

}  // namespace leapmap::pendulum
