// SPDX-License-Identifier: GPL-3.0-or-later
/// A phase of rolling at times in ascending order, whichever way the hoop rolls and wherever it turns round.
#pragma once

#include <optional>
#include <span>

#include "hoop/contact_state.hpp"
#include "noslip/roll_panels.hpp"

namespace leapmap {

/// S: double, or a dual.
template <class S>
class RollAtTimes {
 public:
  /// turns: the angles where it turns round, in order. end: the angle where the phase ends, beyond which
  /// no time is asked for; infinite: it never ends, and turns after those given are found here. accuracy: of
  /// times (RollPanels). hoop and turns must outlive this.
  RollAtTimes(const Hoop<S>& hoop, const ContactState<S>& from, std::span<const double> turns, double end,
              double accuracy);

  struct At {
    ContactState<S> state;
    double acceleration;  ///< phi''
  };
  /// No earlier than the time before. NaN: it is not known there.
  At at(double time);

 private:
  void begin_leg();
  std::optional<double> next_turn(const Roll<S>& roll) const;
  At seen_back(const typename RollPanels<S>::At& on_roll, const S& angle, double way, double time) const;

  const Hoop<S>& hoop_;
  std::span<const double> turns_;  // those ahead
  double end_, accuracy_;
  ContactState<S> from_;  // where the leg begins
  bool rests_ = false;    // there, and stays
  bool is_known_ = true;
  double way_ = 1.0;  // of the leg
  S length_{0.0};     // to the phase's end, or half of the way to rest
  S rest_angle_{0.0};
  std::optional<RollPanels<S>> ahead_;  // from the leg's begin over that length
  std::optional<RollPanels<S>> back_;   // from where it comes to rest, backwards in time; or it does not
};

}  // namespace leapmap
