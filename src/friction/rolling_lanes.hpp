// SPDX-License-Identifier: GPL-3.0-or-later
/// The rolling phases of many designs, as many at once as there are lanes.
///
/// A lane takes a phase that ends without turning round, at one place that its neighbours tell, and whose
/// time the panels resolve; any other is rolled by itself (friction/rolling_leg.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "friction/ended_phase.hpp"
#include "friction/rolling_leg.hpp"
#include "friction/timed_rolls.hpp"

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
  /// A phase whose end is known to lie between two angles, as seen on its leg.
  struct Bracketed {
    std::uint32_t place;
    S way;
    Roll<S> roll;
    PhaseEnd end;
    S from, to;  ///< the same where the end is there
    S from_value, to_value;
  };
  /// A phase whose end is known, up to which it is to be timed.
  struct Untimed {
    PhaseEnd end;
    ContactState<S> at;  ///< there; its time is that of the phase's beginning
  };
  bool bracket(std::uint32_t place, Bracketed& found) const;
  void alone(std::uint32_t place, std::vector<EndedPhase<S>>& ended) const;
  /// Finds where some phases end that wait.
  void find_ends(std::vector<EndedPhase<S>>& ended);
  /// To their last digits, of those in bracketed_.
  void polish_ends(std::vector<EndedPhase<S>>& ended);
  /// Times some phases a panel further.
  void time_some(std::vector<EndedPhase<S>>& ended);

  bool with_times_;
  RollingLeg<S> leg_;
  RollingWalk<S> walk_;
  TimedRolls<T> timed_rolls_;
  std::vector<Phase> phases_;           // by place
  std::vector<std::uint32_t> waiting_;  // places
  std::vector<Bracketed> bracketed_;
  std::vector<Untimed> untimed_;  // by place
  std::vector<typename TimedRolls<T>::Timed> timed_;
};

}  // namespace leapmap
