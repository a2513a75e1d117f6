// SPDX-License-Identifier: GPL-3.0-or-later
/// The rolling phases of many designs, as many at once as there are lanes.
///
/// In lanes a phase comes to its end if it does not turn round, if neighbouring angles show one place where
/// it may end, and if the panels resolve its time. Any other is rolled by itself (friction/rolling_leg.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "friction/ended_phase.hpp"
#include "friction/rolling_leg.hpp"
#include "friction/timed_rolls.hpp"
#include "numerics/rows.hpp"

namespace leapmap {

template <class T>
class RollingLanes {
 public:
  using S = ScalarOf<T>;

  /// tolerance: as of RollingLeg. most: phases at once, and places. timed: otherwise a phase takes no time.
  RollingLanes(double tolerance, std::size_t most, bool timed = true);

  /// Adds a phase to those that the passes to come roll.
  void begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_static, const ContactState<S>& at,
             const S& runway);
  std::size_t waiting() const { return waiting_.size() + timed_rolls_.waiting(); }
  void clear() { waiting_.clear(), timed_rolls_.clear(); }
  /// Takes some a step further, and adds those that end to `ended`.
  void pass(std::vector<EndedPhase<S>>& ended);

 private:
  static constexpr std::size_t width = Lanes<T>::count;

  struct Phase {
    Hoop<S> hoop;
    S mu_static;
    ContactState<S> at;
    S runway;
  };
  /// Some phases as they begin, seen on their legs. Lanes to spare repeat the first.
  struct Begun {
    std::size_t count;
    typename TimedRolls<T>::Places place;
    T way;  ///< 1 or -1
    T mu_static, travel;
    Roll<T> roll;
  };
  /// Between which angles a phase ends, on its leg.
  struct Bracket {
    PhaseEnd end;
    S from, to;  ///< the same where the end is there; both at the beginning: it is to be rolled by itself
    S from_value, to_value;
  };
  /// A phase whose end is known, up to which it is to be timed.
  struct Untimed {
    PhaseEnd end;
    ContactState<S> at;  ///< there; its time is that of the phase's beginning
  };
  Begun take();
  /// The phase in a lane, as take() has left it there.
  Bracket bracket(std::uint32_t lane) const;
  void alone(std::uint32_t place, std::vector<EndedPhase<S>>& ended) const;
  /// Finds where some phases end that wait.
  void find_ends(std::vector<EndedPhase<S>>& ended);
  /// To their last digits.
  void polish_ends(const Begun& begun, const std::array<Bracket, width>& brackets,
                   std::vector<EndedPhase<S>>& ended);
  /// Times some phases a panel further.
  void time_some(std::vector<EndedPhase<S>>& ended);

  bool with_times_;
  RollingLeg<S> leg_;
  RollingWalk<S> walk_;
  TimedRolls<T> timed_rolls_;
  std::vector<Phase> phases_;           // by place
  std::vector<std::uint32_t> waiting_;  // places
  // Of the phases in the lanes: their hoops; release, its sine, cosine and versine, E there, level and push;
  // the look there: E, both guards and their rates; mu_static, and where the runway ends.
  PackedRows<S, 9> hoops_{width};
  PackedRows<S, 7> rolls_{width};
  PackedRows<S, 8> looks_{width};
  std::vector<Untimed> untimed_;  // by place
  std::vector<typename TimedRolls<T>::Timed> timed_;
};

}  // namespace leapmap
