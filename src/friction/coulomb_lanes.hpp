// SPDX-License-Identifier: GPL-3.0-or-later
/// Many designs with Coulomb friction at once: each goes through its phases (coulomb_automaton.hpp), and
/// those that slide, roll or fly do so side by side in lanes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "friction/coulomb_automaton.hpp"
#include "friction/edge_looks.hpp"
#include "friction/rolling_lanes.hpp"
#include "friction/sliding_lanes.hpp"
#include "numerics/wide.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// A thread's own workspace. An outcome depends on the design and the scene alone.
template <class T>
class CoulombLanes {
 public:
  using S = ScalarOf<T>;

  /// tolerance: relative, of times; angles, spins and heights follow. Without the times before jumps rolling
  /// takes none, jump_time and first_jump_time are NaN, and states have no times; other numbers may differ in
  /// digits beyond the tolerance.
  explicit CoulombLanes(double tolerance, const Wanted& wanted = {})
      : with_times_(wanted.first_jump_time || wanted.jump_time),
        with_dips_(wanted.descent),
        followed_(wanted.landing   ? Followed::to_measured_landing
                  : wanted.descent ? Followed::to_landing
                                   : Followed::to_lift_off),
        rolling_(tolerance, most_on_their_way, with_times_),
        sliding_(tolerance, most_on_their_way) {}

  /// Solves designs[i] into outcomes[i]. Without the landing its measures are NaN, without the descent dip
  /// is, and without both flight_time and landing_spin are, too.
  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  /// The same from where states[i] have designs[i], which have just landed there or are released; moves each
  /// to just after the landing of its jump, and goes on from there if goes_on is set and says so. flight_time
  /// and landing_spin are there in any case.
  void solve(Start start, std::span<const Design> designs, std::span<ContactState<S>> states,
             const Scene& scene, std::span<Outcome> outcomes, const GoesOn& goes_on = {});

 private:
  using W = WideOf<T>;  ///< two batches as one, for iterations whose steps wait for each other
  static constexpr std::size_t most_on_their_way = 64;

  struct OnItsWay {
    std::size_t design;
    std::optional<PhaseMachine<S>> machine;
  };
  struct Flown {
    std::uint32_t place;
    Flight<S> flight;
  };
  void run(Start start, std::span<const Design> designs, std::span<ContactState<S>> states,
           const Scene& scene, std::span<Outcome> outcomes, Followed followed, const GoesOn& goes_on);
  void look_at_pivots(std::span<const Design> designs, const Scene& scene);
  void go_on(std::uint32_t place, NextPhase next);
  /// Lets some of flying_ fly, and adds them to flown_.
  void fly_some(const FlightAsked<T>& asked);

  bool with_times_, with_dips_;
  Followed followed_;
  RollingLanes<T> rolling_;
  SlidingLanes<T> sliding_;
  std::vector<OnItsWay> on_their_way_ = std::vector<OnItsWay>(most_on_their_way);
  std::vector<std::uint32_t> free_, flying_, rebounding_;  // places; rebounds fly by themselves
  std::vector<EndedPhase<S>> ended_;
  std::vector<Flown> flown_;
  std::vector<ContactState<S>> releases_;
  EdgeLooks<W> edge_looks_;
  std::vector<typename SlidingLanes<T>::Pivot> pivots_;  // of the designs
};

}  // namespace leapmap
