// SPDX-License-Identifier: GPL-3.0-or-later
/// Jump after jump: from a landing on to the next one, whatever the model and the method.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <type_traits>
#include <vector>

#include "hoop/contact_state.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "trajectory/later_jump.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// Where a way to a jump begins: at a release, where N <= 0 means that it is airborne, or just after a
/// landing, where it means that the hoop lifts off again at once.
enum class Start { release, landing };

/// Takes designs[i] from states[i] to their next jump, told in outcomes[i] (times in seconds since release),
/// and states[i] of those that jump to just after its landing. Owns its workspace: one a thread.
template <class S>
using JumpSolver = std::function<void(Start, std::span<const Design>, std::span<ContactState<S>> states,
                                      std::span<Outcome>)>;

/// Whether designs[i], which has just landed from a jump, goes on. Its outcome and its state are in place;
/// the state may be changed.
using GoesOn = std::function<bool(std::size_t i)>;
/// As a JumpSolver, jump after jump: each design as long as it jumps and goes on.
template <class S>
using LongJumpSolver = std::function<void(Start, std::span<const Design>, std::span<ContactState<S>> states,
                                          std::span<Outcome>, const GoesOn&)>;

/// A jump solver that takes one design after another, by anything that solves one.
template <class S, class One>
JumpSolver<S> jumps_one_by_one(std::shared_ptr<One> one, const Scene& scene) {
  return [one, scene](Start start, std::span<const Design> designs, std::span<ContactState<S>> states,
                      std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i)
      outcomes[i] = one->solve(start, designs[i], states[i], scene);
  };
}

template <class S>
ContactState<S> released(const Design& design) {
  return {.angle = S(design.release_angle), .spin = S(design.release_spin)};
}

/// Whether the hoop has come farther than the runway, either way.
template <class S>
bool is_beyond(const Scene& scene, const ContactState<S>& at) {
  return !(std::abs(at.travel) < S(2) * std::numbers::pi_v<S> * S(scene.runway));
}

/// Whether a jump is none: where hop_height is zero, a flight of no time, after which the hoop is where it
/// was and would make it again. The plane would have to pull.
inline bool is_of_no_flight(const Outcome& outcome) { return outcome.flight_time == 0.0; }

/// All designs make their first jump, then all that go on their second one.
template <class S = double>
LongJumpSolver<S> in_rounds(std::type_identity_t<JumpSolver<S>> next) {
  return [next = std::move(next), going = std::vector<std::size_t>(), some = std::vector<Design>(),
          at = std::vector<ContactState<S>>(), found = std::vector<Outcome>()](
             Start start, std::span<const Design> designs, std::span<ContactState<S>> states,
             std::span<Outcome> outcomes, const GoesOn& goes_on) mutable {
    next(start, designs, states, outcomes);
    going.clear();
    for (std::size_t i = 0; i < designs.size(); ++i)
      if (outcomes[i].status == Status::jumped && goes_on(i)) going.push_back(i);
    while (!going.empty()) {
      some.clear(), at.clear(), found.resize(going.size());
      for (const std::size_t i : going) some.push_back(designs[i]), at.push_back(states[i]);
      next(Start::landing, some, at, found);
      std::size_t kept = 0;
      for (std::size_t k = 0; k < going.size(); ++k) {
        const std::size_t i = going[k];
        outcomes[i] = found[k], states[i] = at[k];
        if (outcomes[i].status == Status::jumped && goes_on(i)) going[kept++] = i;
      }
      going.resize(kept);
    }
  };
}

/// Follows designs through as many jumps as their scene asks for. A thread's own workspace.
template <class S>
class Sequences {
 public:
  explicit Sequences(LongJumpSolver<S> jumps) : jumps_(std::move(jumps)) {}
  explicit Sequences(JumpSolver<S> next) : Sequences(in_rounds<S>(std::move(next))) {}

  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes) {
    states_.clear(), last_.resize(designs.size());
    for (const Design& design : designs) states_.push_back(released<S>(design));
    // All else is overwritten; the room for later jumps stays.
    for (Outcome& outcome : outcomes) outcome.status = Status::not_computed;
    jumps_(Start::release, designs, states_, last_,
           [&](std::size_t i) { return goes_on(scene, states_[i], last_[i], outcomes[i]); });
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const Status end = last_[i].status;
      if (outcomes[i].jumps() == 0) outcomes[i] = last_[i];
      outcomes[i].sequence_end = end;
    }
  }

 private:
  /// Keeps a jump that has just landed. Where no further one follows, last.status is the reason.
  static bool goes_on(const Scene& scene, const ContactState<S>& landed, Outcome& last, Outcome& outcome) {
    if (outcome.jumps() == 0) {
      outcome = last;
    } else if (is_of_no_flight(last)) {
      last.status = Status::indeterminate;
      return false;
    } else {
      outcome.later_jumps.push_back(jump_of(last, static_cast<double>(landed.spin)));
    }
    if (outcome.jumps() >= static_cast<std::size_t>(scene.jumps)) return false;
    if (is_beyond(scene, landed)) last.status = Status::no_jump;
    return last.status == Status::jumped;
  }

  LongJumpSolver<S> jumps_;
  std::vector<ContactState<S>> states_;
  std::vector<Outcome> last_;  // of each design: its last jump, or why there was none
};

/// A solver of whole sequences.
inline Solver in_sequence(LongJumpSolver<double> jumps, const Scene& scene) {
  return [sequences = std::make_shared<Sequences<double>>(std::move(jumps)), scene](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    sequences->solve(designs, scene, outcomes);
  };
}
inline Solver in_sequence(JumpSolver<double> next, const Scene& scene) {
  return in_sequence(in_rounds(std::move(next)), scene);
}

}  // namespace leapmap
