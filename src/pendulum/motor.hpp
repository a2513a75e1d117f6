// SPDX-License-Identifier: GPL-3.0-or-later
/// The motor between hoop and pendulum, by one of a few laws (MotorLaw). What it can give falls with its
/// speed rel = u - w, on a line for each direction:
///
///   high(rel) = T (1 - rel / n),   low(rel) = -T (1 + rel / n),   T = |motor_torque|, n = no_load_speed
///
/// A law goes through pieces, in each of which the torque is smooth, and which events end:
///
// clang-format off
///   piece       | torque               | ends where
///   ------------+----------------------+----------------------------------------------------------------
///   high, low   | on that line         | the target is reached (until_); the speed to hold is reached
///               |                      |   (braking, speed); less is wanted than the line gives (angle)
///   regulated   | what the law wants   | the line gives less
///   held        | what keeps rel       | that is more than the line gives
// clang-format on
///
/// A brake holds the pendulum where it has stopped it: the two are then one body, but for landings, whose
/// impulses no motor holds against.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "pendulum/robot.hpp"

namespace leapmap::pendulum {

enum class Piece { high, low, regulated, held };

/// Whatever can end a piece.
enum class MotorEvent { reaches_target, reaches_speed, high_is_passed, low_is_passed };

/// The angles and spins that a motor knows.
template <class T>
struct Turning {
  T psi, w, u;
};

class Motor {
 public:
  Motor() = default;
  Motor(const Design& design, const Scene& scene)
      : law_(scene.motor_law),
        most_(std::abs(design.motor_torque)),
        way_(std::copysign(1.0, design.motor_torque)),
        slope_(most_ / design.no_load_speed),
        target_(design.motor_target),
        gain_(design.motor_gain),
        damping_(design.motor_damping) {}

  /// Finds the piece at a state. needed: the torque with which it would hold; at_speed: the speed to hold was
  /// just reached, as it counts as reached within some roundings.
  template <class Needed>
  void decide(const Turning<double>& at, bool at_speed, const Needed& needed) {
    if (is_until() && !brakes_ && until(at) <= 0.0) brakes_ = true;
    if (regulates()) {
      const double wanted = this->wanted(at);
      piece_ = wanted > high(at) ? Piece::high : wanted < low(at) ? Piece::low : Piece::regulated;
    } else if (holds()) {
      const double missing = speed_to_hold() - (at.u - at.w);
      const double rounding = 64.0 * std::numeric_limits<double>::epsilon() *
                              (std::abs(at.u) + std::abs(at.w) + std::abs(speed_to_hold()));
      piece_ = missing > 0.0 ? Piece::high : Piece::low;
      if (at_speed || std::abs(missing) <= rounding) {
        const double torque = needed();
        piece_ = torque > high(at) + slack()  ? Piece::high
                 : torque < low(at) - slack() ? Piece::low
                                              : Piece::held;
      }
    } else {
      piece_ = way_ > 0.0 ? Piece::high : Piece::low;
    }
  }

  /// Calls tell(MotorEvent) of each event that may end the piece; distance_to() then falls through zero.
  template <class Tell>
  void tell_events(const Tell& tell) const {
    if (is_until() && !brakes_) return tell(MotorEvent::reaches_target);
    if (holds() && piece_ != Piece::held) return tell(MotorEvent::reaches_speed);
    if (!holds() && !regulates()) return;
    if (piece_ != Piece::low) tell(MotorEvent::high_is_passed);
    if (piece_ != Piece::high) tell(MotorEvent::low_is_passed);
  }

  /// Falls through zero where the event is. torque: that the motor gives.
  template <class T>
  T distance_to(MotorEvent event, const Turning<T>& at, const T& torque) const {
    switch (event) {
      case MotorEvent::reaches_target:
        return until(at);
      case MotorEvent::reaches_speed: {
        const T missing = speed_to_hold() - (at.u - at.w);
        return piece_ == Piece::high ? missing : -missing;
      }
      case MotorEvent::high_is_passed:  // from below, or back again
        if (piece_ == Piece::held) return high(at) + slack() - torque;
        return piece_ == Piece::high ? wanted(at) - high(at) : high(at) - wanted(at);
      case MotorEvent::low_is_passed:
        break;
    }
    if (piece_ == Piece::held) return torque - low(at) + slack();
    return piece_ == Piece::low ? low(at) - wanted(at) : wanted(at) - low(at);
  }

  /// Goes on to the piece after an event, where that does not depend on forces; false: decide() has to.
  bool pass(MotorEvent event) {
    if (event == MotorEvent::reaches_target || event == MotorEvent::reaches_speed) {
      brakes_ = brakes_ || event == MotorEvent::reaches_target;
      return false;
    }
    const Piece edge = event == MotorEvent::high_is_passed ? Piece::high : Piece::low;
    piece_ = piece_ == edge ? Piece::regulated : edge;
    return true;
  }

  template <class T>
  Drive<T> drive(const Turning<T>& at) const {
    switch (piece_) {
      case Piece::high:
        return {high(at)};
      case Piece::low:
        return {low(at)};
      case Piece::regulated:
        return {wanted(at)};
      case Piece::held:
        break;
    }
    return {T(0.0), true};
  }

  /// The torque of a flight that does not change in it; nothing: it does, or may.
  std::optional<double> steady_torque() const {
    if (piece_ == Piece::held) return 0.0;  // nothing turns the two against each other
    if (law_ != MotorLaw::constant || slope_ != 0.0) return {};
    return way_ * most_;
  }

  bool is_holding() const { return piece_ == Piece::held; }
  /// That it holds, or comes to hold.
  double speed_to_hold() const { return law_ == MotorLaw::speed ? target_ : 0.0; }

 private:
  /// By how much a motor that holds may give more than it has: when it then lets go, it is clear which way
  /// the speed changes. Without it a torque that only just touches the line would be decided by roundings.
  double slack() const { return 1e-9 * most_; }
  bool is_until() const { return law_ == MotorLaw::until_angle || law_ == MotorLaw::until_speed; }
  bool holds() const { return brakes_ || (law_ == MotorLaw::speed && !std::isfinite(gain_)); }
  bool regulates() const {
    return law_ == MotorLaw::angle || (law_ == MotorLaw::speed && std::isfinite(gain_));
  }
  template <class T>
  T high(const Turning<T>& at) const {
    return most_ - slope_ * (at.u - at.w);
  }
  template <class T>
  T low(const Turning<T>& at) const {
    return -slope_ * (at.u - at.w) - most_;
  }
  template <class T>
  T wanted(const Turning<T>& at) const {
    if (law_ == MotorLaw::angle) return gain_ * (target_ - at.psi) - damping_ * at.u;
    return gain_ * (target_ - (at.u - at.w));
  }
  template <class T>
  T until(const Turning<T>& at) const {
    return law_ == MotorLaw::until_angle ? way_ * (target_ - at.psi) : way_ * (target_ - (at.u - at.w));
  }

  MotorLaw law_ = MotorLaw::constant;
  double most_ = 0.0, way_ = 1.0, slope_ = 0.0, target_ = 0.0, gain_ = 0.0, damping_ = 0.0;
  bool brakes_ = false;
  Piece piece_ = Piece::high;
};

}  // namespace leapmap::pendulum
