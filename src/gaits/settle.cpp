// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaits/settle.hpp"

#include <array>
#include <cmath>

#include "support/stop.hpp"

namespace leapmap {

namespace {

void tell(const Orbit& orbit, Outcome& outcome) {
  outcome.gait_period = static_cast<std::uint8_t>(orbit.jumps.size());
  outcome.gait_multiplier = orbit.multiplier;
  outcome.gait_height = orbit.height;
  outcome.gait_speed = orbit.speed;
  outcome.gait_jump_time = orbit.jump_time;
  outcome.gait_energy_lost = orbit.energy_lost;
}

}  // namespace

void GaitSolver::solve(std::span<const Design> designs, std::span<Outcome> outcomes) {
  std::vector<bool> found(designs.size());
  settle(designs, [&](std::size_t i, const Orbit& orbit) { tell(orbit, outcomes[i]), found[i] = true; });
  look_on();
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const bool unknown = ends_[i] == Status::failed || ends_[i] == Status::indeterminate;
    if (!found[i]) outcomes[i].gait_period = unknown ? Outcome::no_gait : 0;
  }
  Orbit orbit;
  for (std::size_t k = 0; k < going_.size(); ++k) {
    Outcome& outcome = outcomes[going_[k]];
    outcome.gait_period = Outcome::no_gait;
    if (find_orbit(some_[k], seen_[k], orbit)) tell(orbit, outcome);
  }
}

bool GaitSolver::orbit_of(const Design& design, Orbit& orbit) {
  bool found = false;
  settle({&design, 1}, [&](std::size_t, const Orbit& early) { orbit = early, found = true; });
  if (found) return true;
  look_on();
  return !going_.empty() && find_orbit(design, seen_[0], orbit);
}

/// Leaves those designs that go on for so many jumps, and whose orbit is not plain before: a transient that
/// shrinks by the same factor from round to round need not be followed to its end.
void GaitSolver::settle(std::span<const Design> designs,
                        const std::function<void(std::size_t, const Orbit&)>& found) {
  going_.clear(), states_.clear(), ends_.assign(designs.size(), Status::jumped);
  some_.assign(designs.begin(), designs.end());
  for (std::size_t i = 0; i < designs.size(); ++i)
    going_.push_back(i), states_.push_back(released<double>(designs[i]));
  seen_.assign(designs.size(), {});
  constexpr long first_look = 24, most_seen = 16;
  long next_look = first_look;
  for (long jump = 1; jump <= scene_.settle && !going_.empty(); ++jump) {
    throw_if_stopped();
    jump_on(jump == 1 ? Start::release : Start::landing);
    if (jump > next_look - most_seen)
      for (std::size_t k = 0; k < going_.size(); ++k) seen_[k].push_back(states_[k]);
    if (jump < next_look) continue;
    next_look *= 2;
    take_out_settled(found);
  }
  for (auto& landings : seen_) landings.clear();
}

/// Tells the orbits of designs that are as good as on them, and leaves the others.
void GaitSolver::take_out_settled(const std::function<void(std::size_t, const Orbit&)>& found) {
  Orbit orbit;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < going_.size(); ++k) {
    if (is_settled(some_[k], seen_[k], orbit)) {
      found(going_[k], orbit);
      continue;
    }
    going_[kept] = going_[k], some_[kept] = some_[k], states_[kept] = states_[k];
    seen_[kept++].clear();
  }
  going_.resize(kept), some_.resize(kept), states_.resize(kept), seen_.resize(kept);
}

/// Whether the last rounds come nearer to an orbit by one factor, which is its multiplier.
bool GaitSolver::is_settled(const Design& design, std::span<const Landed> seen, Orbit& orbit) {
  constexpr double near = 1e-3, rounding = 1e-11, alike = 0.05, contracts = 0.9;
  for (std::size_t period = 1; 3 * period < seen.size(); ++period) {
    std::array<double, 3> gaps;  // the last first
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t last = seen.size() - 1 - k * period;
      gaps[k] = between(seen[last - period], seen[last]).lpNorm<Eigen::Infinity>();
    }
    if (!(gaps[0] < near)) continue;
    const bool is_there = gaps[0] < rounding && gaps[1] < 1e-6;
    const double factor = gaps[0] / gaps[1];
    const bool shrinks = factor < contracts && std::abs(factor - gaps[1] / gaps[2]) < alike;
    if (!is_there && !shrinks) return false;  // of no longer period before this one is decided
    if (!map_.close(design, static_cast<int>(period), seen.back(), orbit)) return false;
    const double multiplier = std::abs(orbit.multiplier);
    return multiplier < contracts && (is_there || std::abs(multiplier - factor) < alike);
  }
  return false;
}

/// As many jumps more as the longest period has.
void GaitSolver::look_on() {
  const auto note = [&] {
    for (std::size_t k = 0; k < going_.size(); ++k) seen_[k].push_back(states_[k]);
  };
  note();
  for (long jump = 0; jump < scene_.most_period && !going_.empty(); ++jump) jump_on(Start::landing), note();
}

/// One jump of those that go on; those that make it are left.
void GaitSolver::jump_on(Start start) {
  map_.next(start, some_, states_, found_);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < going_.size(); ++k) {
    ends_[going_[k]] = found_[k].status;
    if (found_[k].status != Status::jumped) continue;
    going_[kept] = going_[k], some_[kept] = some_[k], states_[kept] = states_[k];
    if (kept != k) seen_[kept] = std::move(seen_[k]);
    ++kept;
  }
  going_.resize(kept), some_.resize(kept), states_.resize(kept), seen_.resize(kept);
}

namespace {

/// Whether it comes nearer to itself by the same factor from each round to the next.
bool shrinks(std::span<const Landed> seen, std::size_t period) {
  constexpr double nearly = 0.1, alike = 0.02;
  if (seen.size() <= 3 * period) return false;
  std::array<double, 3> gaps;
  for (std::size_t k = 0; k < 3; ++k)
    gaps[k] = between(seen[k * period], seen[(k + 1) * period]).lpNorm<Eigen::Infinity>();
  return gaps[0] < nearly && gaps[1] < gaps[0] && gaps[2] < gaps[1] &&
         std::abs(gaps[1] / gaps[0] - gaps[2] / gaps[1]) < alike;
}

}  // namespace

/// The orbit that it is drawn to: of the shortest period after which it is nearly where it was.
bool GaitSolver::find_orbit(const Design& design, std::span<const Landed> seen, Orbit& orbit) {
  for (std::size_t period = 1; period < seen.size(); ++period) {
    const double gap = between(seen[0], seen[period]).lpNorm<Eigen::Infinity>();
    if (!(gap < scene_.gait_tolerance) && !shrinks(seen, period)) continue;
    if (!map_.close(design, static_cast<int>(period), seen[0], orbit)) continue;
    if (!(std::abs(orbit.multiplier) < 1.0)) continue;
    // What it has not yet come near by is a geometric series of gaps.
    const double left = between(seen[0], orbit.landings.back()).lpNorm<Eigen::Infinity>();
    if (left <= 10.0 * gap / (1.0 - std::abs(orbit.multiplier)) + 1e-9) return true;
  }
  return false;
}

}  // namespace leapmap
