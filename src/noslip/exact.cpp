// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/exact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hoop/units.hpp"
#include "noslip/leg.hpp"
#include "noslip/prepare.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

/// A time that the quadrature could not tell makes the design failed: no field of it is to be believed.
template <class S>
void note_time(Outcome& outcome, double Outcome::*time, const S& told) {
  if (std::isfinite(told)) {
    outcome.*time = static_cast<double>(told);
  } else {
    outcome = failed_outcome("time integral did not converge: the hoop nearly stalls");
  }
}

}  // namespace

template <class T>
void ExactSolver<T>::solve(Start start, std::span<const Design> designs,
                           std::span<ContactState<ScalarOf<T>>> states, const Scene& scene,
                           std::span<Outcome> outcomes, FoundLiftOffs* told) {
  take_off_.told = told;
  for (std::size_t first = 0; first < designs.size(); first += Block<T>::most_designs) {
    const std::size_t count = std::min(Block<T>::most_designs, designs.size() - first);
    solve_block(start, designs.subspan(first, count), states.empty() ? states : states.subspan(first, count),
                scene, outcomes.subspan(first, count));
  }
}

template <class T>
void ExactSolver<T>::solve_block(Start start, std::span<const Design> designs,
                                 std::span<ContactState<ScalarOf<T>>> states, const Scene& scene,
                                 std::span<Outcome> outcomes) {
  const bool lands = wanted_.descent || wanted_.landing || !states.empty();
  take_off_.keeps_flights = lands;
  std::span<const ContactState<ScalarOf<T>>> landed;
  if (start == Start::landing) landed = states;
  prepare(designs, landed, scene, block_, outcomes);
  take_off_.bounce(block_, scene, outcomes, block_.searching);
  unscanned_ = block_.searching;
  while (!block_.searching.empty()) {
    throw_if_stopped();
    scan_.run(block_, unscanned_);
    pick_intervals(outcomes);
    classify_.run(block_, take_off_.falls, going_on_);
    take_off_.run(block_, scene, outcomes, going_on_);
    turn_round(block_, turning_, scene);
    std::swap(block_.searching, going_on_);
  }
  lifted_.clear(), jumped_.clear();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].candidates > 0) lifted_.push_back(static_cast<std::uint32_t>(i));
    if (outcomes[i].status == Status::jumped) jumped_.push_back(static_cast<std::uint32_t>(i));
  }
  if (wanted_.first_jump_time || wanted_.jump_time) take_times(outcomes);
  std::erase_if(jumped_, [&](std::uint32_t i) { return outcomes[i].status == Status::failed; });
  if (start == Start::landing)
    for (const std::uint32_t i : lifted_) {
      outcomes[i].first_jump_time += static_cast<double>(states[i].time);
      outcomes[i].jump_time += static_cast<double>(states[i].time);
    }
  if (lands) land(block_, jumped_, scene, outcomes, states, wanted_.landing);
  const double second = time_unit(scene);
  for (const std::uint32_t i : lifted_) to_seconds(outcomes[i], second);
}

/// The next interval of each design still searching; without one it is to be scanned on, or its search is
/// over.
template <class T>
void ExactSolver<T>::pick_intervals(std::span<Outcome> outcomes) {
  unscanned_.clear(), going_on_.clear(), turning_.clear(), classify_.intervals.clear(),
      take_off_.falls.clear();
  for (const std::uint32_t design : block_.searching) {
    IntervalSearch<ScalarOf<T>>& search = block_.searches[design];
    Interval<ScalarOf<T>> look;
    SureFall<ScalarOf<T>> fall;
    const Next next = search.next(design, look, fall);
    if (next == Next::fall) {
      take_off_.falls.push_back(fall);
    } else if (next == Next::look) {
      classify_.intervals.push_back(look);
    } else if (search.scan_on()) {
      unscanned_.push_back(design);
      going_on_.push_back(design);
    } else {
      end_leg(design, outcomes[design]);
    }
  }
}

/// At the end of a leg the design turns round, or its way is over.
template <class T>
void ExactSolver<T>::end_leg(std::uint32_t design, Outcome& outcome) {
  auto& found = block_.found[design];
  if (found.returns() || !found.turns) {
    outcome.status = found.returns() ? Status::stalled : Status::no_jump;
    return;
  }
  if (const auto path = block_.template load_path<ScalarOf<T>>(&design);
      path.hoop.resistance != ScalarOf<T>(0)) {
    // Its energy is another function of the angle on the way back.
    if (take_off_.told)
      take_off_.told->turns.push_back(static_cast<double>(found.way * found.turn + found.turned_back));
    if (is_held(path.hoop, trig(found.turn)))
      outcome.status = Status::stalled;
    else
      outcome = failed_outcome(reverses_against_resistance);
    return;
  }
  if (outcome.candidates > 0 && found.first_on_leg) {
    if (wanted_.first_jump_time) found.first_time = clock_.time(block_, design, found.first_angle);
    found.first_on_leg = false;
  }
  if (take_off_.told)
    take_off_.told->turns.push_back(static_cast<double>(found.way * found.turn + found.turned_back));
  found.jump_angle = std::numeric_limits<ScalarOf<T>>::quiet_NaN();
  turning_.push_back(design), unscanned_.push_back(design), going_on_.push_back(design);
}

/// The times of first lift-offs and jumps. A jump that is the first lift-off is timed with those; a first
/// lift-off on a leg before the last was timed when the hoop turned round.
template <class T>
void ExactSolver<T>::take_times(std::span<Outcome> outcomes) {
  clock_.start(block_, wanted_.first_jump_time ? lifted_ : jumped_);
  const auto& found = block_.found;
  const auto jumps_first = [&](std::uint32_t design) {
    return outcomes[design].status == Status::jumped && outcomes[design].candidates == 1;
  };
  readings_.clear();
  for (const std::uint32_t design : lifted_) {
    if (!wanted_.first_jump_time && !jumps_first(design)) continue;
    if (found[design].first_on_leg)
      readings_.push_back({design, found[design].first_angle, 0});
    else
      note_time(outcomes[design], &Outcome::first_jump_time, found[design].first_time);
  }
  clock_.read(block_, readings_);
  for (const auto& reading : readings_) {
    note_time(outcomes[reading.design], &Outcome::first_jump_time, reading.time);
    block_.found[reading.design].first_time = reading.time;
  }

  readings_.clear();
  for (const std::uint32_t design : jumped_) {
    if (outcomes[design].status == Status::failed) continue;
    if (jumps_first(design)) {
      outcomes[design].jump_time = outcomes[design].first_jump_time;
    } else if (wanted_.jump_time) {
      readings_.push_back({design, found[design].jump_angle, 0});
    }
  }
  clock_.read(block_, readings_);
  for (const auto& reading : readings_) {
    note_time(outcomes[reading.design], &Outcome::jump_time, reading.time);
    block_.found[reading.design].jump_time = reading.time;
  }
}

#ifdef LEAPMAP_KERNELS
template class ExactSolver<Batch>;
#endif
#ifdef LEAPMAP_SCALARS
template class ExactSolver<double>;
template class ExactSolver<long double>;
#endif

}  // namespace leapmap
