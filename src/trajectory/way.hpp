// SPDX-License-Identifier: GPL-3.0-or-later
/// What the way from a release to a jump's lift-off asks of hoop and motor: the largest normal force, and the
/// motor's energy, power and spin. Maxima lie between samples: each that samples show is closed in on.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>

#include "hoop/rolling_by_angle.hpp"
#include "leapmap/outcome.hpp"
#include "numerics/maximum.hpp"

namespace leapmap {

/// In the units of Outcome. Without a motor energy and power are 0.
template <class S>
struct Way {
  S normal_force = S(0.0);
  S energy = S(0.0);
  S power = S(-std::numeric_limits<double>::infinity());
  S spin = S(0.0);
};

/// Where outcomes keep them.
template <class S>
struct WayRow {
  S Way<S>::*number;
  double Outcome::*kept;
};
template <class S>
inline constexpr std::array way_rows{WayRow<S>{&Way<S>::normal_force, &Outcome::max_normal_force},
                                     WayRow<S>{&Way<S>::energy, &Outcome::motor_energy},
                                     WayRow<S>{&Way<S>::power, &Outcome::motor_max_power},
                                     WayRow<S>{&Way<S>::spin, &Outcome::motor_max_spin}};

/// Whether a number of an outcome is one of its way.
constexpr bool is_of_way(const OutcomeNumber& number) {
  for (const WayRow<double>& row : way_rows<double>)
    if (number == row.kept) return true;
  return false;
}

/// put(member of Outcome, number) of each.
template <class S, class Put>
void put_way(const Way<S>& way, const Put& put) {
  for (const WayRow<S>& row : way_rows<S>) put(row.kept, way.*row.number);
}

/// At one place of a slide.
template <class S>
struct ForceAndSpin {
  S normal_force, spin;
};

/// Follows a way, piece after piece. S: double, or a dual: a maximum depends on where it lies to second order
/// only, so that its derivatives are those at that place; at a piece's end those of the end as it moves.
template <class S>
class WayMeter {
 public:
  /// spin: with which the way begins.
  WayMeter(const Hoop<S>& hoop, const S& spin);

  /// Rolling from where the roll begins, with that spin, to an angle, turning round at `turns`, in order.
  void roll(const Roll<S>& roll, const S& spin, std::span<const double> turns, const S& to);
  /// Sliding: at a place of a piece, from 0 to 1. known: in plain numbers, with rates by time.
  void slide(const std::function<ForceAndSpin<Rated>(double)>& known,
             const std::function<ForceAndSpin<S>(double)>& at);
  /// One place of a slide.
  void meet(const ForceAndSpin<S>& at);
  /// A flight, in which a motor that is on turns the hoop steadily.
  void fly(const S& spin, const S& time);
  /// The motor turned the hoop so far.
  void turn(const S& angle) { way_.energy += hoop_.motor() * angle; }

  const Way<S>& way() const { return way_; }

 private:
  void meet_spin(const S& spin);
  void roll_on(const Roll<S>& roll, const S& from, const S& spin, const S& to);

  Hoop<S> hoop_;
  bool turns_on_;  ///< the motor, in flight
  Way<S> way_;
};

}  // namespace leapmap
