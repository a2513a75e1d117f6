// SPDX-License-Identifier: GPL-3.0-or-later
/// The way of a hoop without slip from its release to its jump, for all designs of a box: its legs from turn
/// to turn, the falls of the normal force on each, and the flights that begin there.
#pragma once

#include "leapmap/prove.hpp"
#include "proof/apex.hpp"
#include "proof/travel_time.hpp"

namespace leapmap {

template <std::size_t N>
class Walk {
 public:
  /// varying: the parameters that vary. times: of the lift-offs, asked for.
  Walk(const DesignBox& box, const std::array<double Design::*, N>& varying, const Scene& scene, bool times)
      : box_(box), varying_(varying), scene_(scene), times_(times) {
    for (std::size_t k = 0; k < N; ++k) {
      const double from = box.from.*varying[k], to = box.to.*varying[k], middle = from + 0.5 * (to - from);
      forms_.reach[k] = Ball::between(from, to) - Ball(middle);
    }
  }

  /// Throws Undecided.
  Proof prove();

 private:
  using D = BoxDual<N>;
  using BothHoops = Both<Hoop, N>;
  using BothRolls = Both<Roll, N>;

  /// How one leg ends.
  enum class End { jump, runway, back };
  struct Leg {
    BothRolls roll;
    BothNumbers<N> length;  ///< to the runway's end, or of the last leg to where it set out
    int number = 1;
  };

  template <class T>
  T value_of_parameter(double Design::*member) const;
  template <class T>
  Hoop<T> hoop_of(int resists) const;
  /// 1: it sets out downhill, -1: uphill, 0: it rests.
  int sets_out(const BothHoops& hoop) const;
  bool is_airborne(const BothHoops& hoop) const;
  int resists() const;
  Leg first_leg(const BothHoops& hoop, int way) const;
  Leg next_leg(const Leg& leg, const BothNumbers<N>& turn) const;
  /// Where it turns round, if it does so before the leg's end.
  std::optional<BothNumbers<N>> turn_of(const Leg& leg) const;
  End look_for_jump(const Leg& leg, const Ball& end);
  Both<TakingOff, N> taking_off(const Leg& leg, const BothNumbers<N>& x) const;
  BothNumbers<N> flight_at(const Leg& leg, const BothNumbers<N>& x) const;
  void note_jump(const Ball& height, const char* event);
  void may_jump(const Leg& leg, double from, double to, const char* event);
  bool may_be_passed_over(const Leg& leg, double from, double to) const;
  Enclosure time_at(const Leg& leg, const BothNumbers<N>& x);

  const DesignBox& box_;
  std::array<double Design::*, N> varying_;
  const Scene& scene_;
  bool times_;
  Forms<N> forms_{};
  Proof ended(Status status);

  Proof proof_;
  Ball release_ = Ball(0);          ///< where the leg begins, as lift-offs are told apart there
  std::optional<Ball> may_jump_{};  ///< heights of jumps that some designs make, and others pass over
  const char* event_ = nullptr;     ///< of the last of them
  bool counts_ = true;              ///< all designs have as many lift-offs
  Ball time_ = Ball(0);             ///< from the release to where it was told last
  Ball timed_ = Ball(0);            ///< where that is, past the beginning of the leg
};

inline Enclosure enclosure_of(const Ball& ball) { return {ball.lower(), ball.upper()}; }

}  // namespace leapmap
