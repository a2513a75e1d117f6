// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/exact.hpp"

#include <algorithm>
#include <cmath>

#include "rolling/prepare.hpp"
#include "trajectory/units.hpp"

namespace leapmap {
namespace {

/// A time that the quadrature could not tell makes the design failed: no field of it is to be believed.
template <class S>
void note_time(Outcome& outcome, double Outcome::*time, const Reading<S>& reading) {
  if (std::isfinite(reading.time)) {
    outcome.*time = static_cast<double>(reading.time);
  } else {
    outcome = failed_outcome("a time could not be told: too near a stall");
  }
}

}  // namespace

template <class T>
void ExactSolver<T>::solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
                           std::vector<LiftOff<double>>* lift_offs) {
  take_off_.told = lift_offs;
  for (std::size_t first = 0; first < designs.size(); first += Block<T>::most_designs) {
    const std::size_t count = std::min(Block<T>::most_designs, designs.size() - first);
    solve_block(designs.subspan(first, count), scene, outcomes.subspan(first, count));
  }
}

template <class T>
void ExactSolver<T>::solve_block(std::span<const Design> designs, const Scene& scene,
                                 std::span<Outcome> outcomes) {
  prepare(designs, scene, block_, outcomes);
  unscanned_ = block_.searching;
  while (!block_.searching.empty()) {
    scan_.run(block_, unscanned_);
    pick_intervals(outcomes);
    classify_.run(block_, take_off_.falls, going_on_);
    take_off_.run(block_, designs, scene, outcomes, going_on_);
    std::swap(block_.searching, going_on_);
  }
  lifted_.clear(), jumped_.clear();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].candidates > 0) lifted_.push_back(static_cast<std::uint32_t>(i));
    if (outcomes[i].status == Status::jumped) jumped_.push_back(static_cast<std::uint32_t>(i));
  }
  if (wanted_.descent) land(block_, jumped_, outcomes);
  if (wanted_.first_jump_time || wanted_.jump_time) take_times(outcomes);
  const double second = time_unit(scene);
  for (Outcome& outcome : outcomes) to_seconds(outcome, second);
}

/// The next interval of each design still searching; without one it is to be scanned on, or its search is
/// over.
template <class T>
void ExactSolver<T>::pick_intervals(std::span<Outcome> outcomes) {
  unscanned_.clear(), going_on_.clear(), classify_.intervals.clear(), take_off_.falls.clear();
  for (const std::uint32_t design : block_.searching) {
    IntervalSearch<ScalarOf<T>>& search = block_.searches[design];
    Interval<ScalarOf<T>> interval;
    if (search.next(design, interval)) {
      (interval.falls ? take_off_.falls : classify_.intervals).push_back(interval);
    } else if (search.scan_on()) {
      unscanned_.push_back(design);
      going_on_.push_back(design);
    } else {
      outcomes[design].status = block_.found[design].stalls ? Status::stalled : Status::no_jump;
    }
  }
}

/// The times of first lift-offs and jumps. A jump that is the first lift-off is timed with those.
template <class T>
void ExactSolver<T>::take_times(std::span<Outcome> outcomes) {
  clock_.start(block_, lifted_);
  const auto& found = block_.found;
  const auto is_first = [&](std::uint32_t design) {
    return !(found[design].jump_angle > found[design].first_angle);
  };
  readings_.clear();
  for (const std::uint32_t design : lifted_)
    if (wanted_.first_jump_time || (outcomes[design].status == Status::jumped && is_first(design)))
      readings_.push_back({design, found[design].first_angle, 0});
  clock_.read(block_, readings_);
  for (const auto& reading : readings_)
    note_time(outcomes[reading.design], &Outcome::first_jump_time, reading);

  readings_.clear();
  for (const std::uint32_t design : jumped_) {
    if (outcomes[design].status == Status::failed) continue;
    if (is_first(design)) {
      outcomes[design].jump_time = outcomes[design].first_jump_time;
    } else if (wanted_.jump_time) {
      readings_.push_back({design, found[design].jump_angle, 0});
    }
  }
  clock_.read(block_, readings_);
  for (const auto& reading : readings_) note_time(outcomes[reading.design], &Outcome::jump_time, reading);
}

#ifdef LEAPMAP_KERNELS
template class ExactSolver<Batch>;
#endif
#ifdef LEAPMAP_SCALARS
template class ExactSolver<double>;
template class ExactSolver<long double>;
#endif

}  // namespace leapmap
