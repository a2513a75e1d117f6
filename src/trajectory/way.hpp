// SPDX-License-Identifier: GPL-3.0-or-later
/// What the way from a release to a jump's lift-off asks of hoop and motor: the largest normal force, and the
/// motor's energy, power and spin. Maxima lie between samples: each that samples show is closed in on.
#pragma once

#include <functional>
#include <limits>

#include "leapmap/outcome.hpp"
#include "physics/rolling_by_angle.hpp"

namespace leapmap {

/// In the units of Outcome. Without a motor energy and power are 0.
struct Way {
  double normal_force = 0.0;
  double energy = 0.0;
  double power = -std::numeric_limits<double>::infinity();
  double spin = 0.0;
};

/// Follows a way, piece after piece.
class WayMeter {
 public:
  explicit WayMeter(const Hoop<double>& hoop) : hoop_(hoop) {}

  /// Rolling from one angle to another without turning round.
  void roll(const Roll<double>& roll, double from, double to);
  /// Sliding: force and spin at a place of a piece, from 0 to 1.
  struct Sliding {
    double normal_force, spin;
  };
  void slide(const std::function<Sliding(double)>& at);
  /// A flight, in which a motor that is on turns the hoop steadily.
  void fly(double spin, double time);
  /// The motor turned the hoop so far.
  void turn(double angle) { way_.energy += hoop_.drive * angle; }

  const Way& way() const { return way_; }

 private:
  void meet_spin(double spin);

  Hoop<double> hoop_;
  Way way_;
};

inline void keep(const Way& way, Outcome& outcome) {
  outcome.max_normal_force = way.normal_force, outcome.motor_energy = way.energy;
  outcome.motor_max_power = way.power, outcome.motor_max_spin = way.spin;
}

}  // namespace leapmap
