// SPDX-License-Identifier: GPL-3.0-or-later
/// Jump after jump: from a landing on to the next one, whatever the model and the method.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
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
using LongJumpSolver =
    std::function<void(Start, std::span<const Design>, std::span<ContactState<double>> states,
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
inline LongJumpSolver in_rounds(JumpSolver<double> next) {
  return [next = std::move(next), going = std::vector<std::size_t>(), some = std::vector<Design>(),
          at = std::vector<ContactState<double>>(), found = std::vector<Outcome>()](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes, const GoesOn& goes_on) mutable {
    going.resize(designs.size());
    std::iota(going.begin(), going.end(), std::size_t{0});
    for (; !going.empty(); start = Start::landing) {
      some.clear(), at.clear(), found.resize(going.size());
      for (const std::size_t i : going) some.push_back(designs[i]), at.push_back(states[i]);
      next(start, some, at, found);
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
  explicit Sequences(JumpSolver<S> next) : next_(std::move(next)) {}

  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes) {
    states_.clear(), going_.clear();
    for (const Design& design : designs) states_.push_back(released<S>(design));
    next_(Start::release, designs, states_, outcomes);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      outcomes[i].sequence_end = outcomes[i].status;
      if (outcomes[i].status == Status::jumped) going_.push_back(i);
    }
    for (long jump = 2; jump <= scene.jumps && !going_.empty(); ++jump) go_on(designs, scene, outcomes);
  }

 private:
  /// One jump more of those that still go on.
  void go_on(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes) {
    std::erase_if(going_, [&](std::size_t i) {
      const bool is_over = is_beyond(scene, states_[i]);
      if (is_over) outcomes[i].sequence_end = Status::no_jump;
      return is_over;
    });
    if (going_.empty()) return;
    some_.clear(), some_states_.clear(), found_.resize(going_.size());
    for (const std::size_t i : going_) some_.push_back(designs[i]), some_states_.push_back(states_[i]);
    next_(Start::landing, some_, some_states_, found_);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < going_.size(); ++k) {
      const std::size_t i = going_[k];
      if (found_[k].status == Status::jumped && is_of_no_flight(found_[k]))
        found_[k].status = Status::indeterminate;
      outcomes[i].sequence_end = found_[k].status;
      if (found_[k].status != Status::jumped) continue;
      states_[i] = some_states_[k];
      outcomes[i].later_jumps.push_back(jump_of(found_[k], static_cast<double>(states_[i].spin)));
      going_[kept++] = i;
    }
    going_.resize(kept);
  }

  JumpSolver<S> next_;
  std::vector<ContactState<S>> states_, some_states_;
  std::vector<std::size_t> going_;
  std::vector<Design> some_;
  std::vector<Outcome> found_;
};

/// A solver of whole sequences.
inline Solver in_sequence(JumpSolver<double> next, const Scene& scene) {
  return [sequences = std::make_shared<Sequences<double>>(std::move(next)), scene](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    sequences->solve(designs, scene, outcomes);
  };
}

}  // namespace leapmap
