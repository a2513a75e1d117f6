// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaits/settle.hpp"

#include <algorithm>
#include <array>
#include <cassert>
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
  std::vector<bool> has_gait(designs.size());
  follow(designs, [&](std::size_t i, const Orbit& orbit) { tell(orbit, outcomes[i]), has_gait[i] = true; });
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (has_gait[i]) continue;
    const Status last = ends_[i].status;
    const bool stops = last != Status::jumped && last != Status::failed && last != Status::indeterminate;
    outcomes[i].gait_period = stops ? 0 : Outcome::no_gait;
  }
}

bool GaitSolver::orbit_of(const Design& design, Orbit& orbit) {
  bool has_gait = false;
  follow({&design, 1}, [&](std::size_t, const Orbit& found) { orbit = found, has_gait = true; });
  return has_gait;
}

/// Follows each design until its jumps end or its orbit is plain: a transient that shrinks by the same factor
/// from round to round need not be followed to its end. Where a design still jumps after scene_.settle jumps,
/// looks for its orbit.
void GaitSolver::follow(std::span<const Design> designs,
                        const std::function<void(std::size_t, const Orbit&)>& found) {
  assert(scene_.settle > 0 && scene_.most_period > 0);
  courses_.assign(designs.size(), {});
  states_.clear();
  for (const Design& design : designs) states_.push_back(released<double>(design));
  Orbit orbit;
  map_.follow(Start::release, designs, states_, ends_, [&](std::size_t i) {
    const bool more = goes_on(designs[i], states_[i], ends_[i].phase_sequence, courses_[i], orbit);
    if (courses_[i].settled) found(i, orbit);
    if (!more) courses_[i].known = {};
    if (!more && courses_[i].jumps < scene_.settle) courses_[i].seen = {};
    return more;
  });
  for (std::size_t i = 0; i < designs.size(); ++i)
    if (ends_[i].status == Status::jumped && !courses_[i].settled &&
        find_orbit(designs[i], courses_[i], orbit))
      found(i, orbit);
  courses_.clear();
}

/// Takes a landing, and those after it that known jumps lead to, to the last of which it moves the design.
/// Returns whether the design is to be followed further.
bool GaitSolver::goes_on(const Design& design, Landed& landed, std::uint64_t phases, Course& course,
                         Orbit& orbit) {
  constexpr long transient = 24;  // most settle soon afterwards
  if (course.jumps >= transient) course.known.add(course.seen.back(), landed, phases);
  bool more = takes(design, landed, course, orbit);
  while (more) {
    const std::optional<Landed> next = course.known.next(landed);
    if (!next) break;
    landed = *next, course.interpolates = true;
    more = takes(design, landed, course, orbit);
  }
  return more;
}

/// Takes the landing of one more jump. Returns whether the design is to be followed further: where it has
/// come so near to an orbit that it is not, it has settled.
bool GaitSolver::takes(const Design& design, const Landed& landed, Course& course, Orbit& orbit) {
  auto& [jumps, next_look, seen, settled, known, interpolates] = course;
  throw_if_stopped();
  ++jumps;
  const auto most_seen = 3 * static_cast<std::size_t>(scene_.most_period) + 1;
  if (seen.size() == 2 * most_seen)
    seen.erase(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(most_seen));
  seen.push_back(landed);
  if (jumps == next_look && jumps <= scene_.settle) {
    settled = is_settled(design, course, orbit);
    next_look += std::max(jumps / 4, 4L);
  }
  if (jumps == scene_.settle) seen.assign(1, landed);
  // In the end as many more as the longest period has.
  return !settled && jumps < scene_.settle + scene_.most_period;
}

namespace {

/// Whether an orbit is where one is that is drawn to it, and was a gap away from there a round before or
/// later: what it has not yet come near by is a geometric series of gaps, and of how far off each round may
/// be.
bool is_near(const Landed& at, double gap, const Orbit& orbit, double off) {
  const double left = between(at, orbit.landings.back()).lpNorm<Eigen::Infinity>();
  return left <= (10.0 * gap + off) / (1.0 - std::abs(orbit.multiplier)) + 1e-9;
}

/// Where a sequence goes to whose differences shrink by one factor, by Aitken; the last comes first.
double limit_of(const std::array<double, 3>& sequence) {
  const auto& [last, before, first] = sequence;
  const double step = last - before;
  return std::abs(step) < std::abs(before - first) ? last - step * step / (step - (before - first))
                                                   : HUGE_VAL;
}

}  // namespace

/// Whether the last rounds come nearer to an orbit by one factor, which is its multiplier.
bool GaitSolver::is_settled(const Design& design, const Course& course, Orbit& orbit) {
  const std::vector<Landed>& seen = course.seen;
  constexpr double near = 1e-3, nearing = 0.1, rounding = 1e-11, contracts = 0.99;
  // How far factors may differ: the nearer to 1 the less, as an orbit that repels may be close by.
  const auto alike = [](double factor) { return std::min(0.05, 0.5 * (1.0 - factor)); };
  const auto longest = std::min(static_cast<std::size_t>(scene_.most_period), (seen.size() - 1) / 3);
  for (std::size_t period = 1; period <= longest; ++period) {
    std::array<StateVector, 3> rounds;  // the last first
    std::array<double, 3> gaps;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t last = seen.size() - 1 - k * period;
      rounds[k] = between(seen[last - period], seen[last]);
      gaps[k] = rounds[k].lpNorm<Eigen::Infinity>();
    }
    const double factor = gaps[0] / gaps[1], way = rounds[0].dot(rounds[1]) < 0.0 ? -1.0 : 1.0;
    const bool is_there = gaps[0] < rounding && gaps[1] < 1e-6;
    const bool shrinks = factor < 1.0 && std::abs(factor - gaps[1] / gaps[2]) < alike(factor);
    if (gaps[0] >= near) {
      // Where these gaps are about to vanish, those of two rounds do so, too, and first.
      if (gaps[0] < nearing && limit_of(gaps) < 0.2 * gaps[0]) return false;
      continue;
    }
    if (!is_there && !(shrinks && factor < contracts)) return false;           // nor of any longer period
    const double rest = is_there ? 0.0 : way * factor / (1.0 - way * factor);  // of a geometric series
    if (!map_.close(design, static_cast<int>(period), moved(seen.back(), rest * rounds[0]), orbit))
      return false;
    const double multiplier = std::abs(orbit.multiplier);
    return multiplier < contracts && (is_there || std::abs(multiplier - factor) < alike(multiplier)) &&
           is_near(seen.back(), gaps[0], orbit, off(course));
  }
  return false;
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

/// The orbit that it is drawn to: of the shortest period after which it is nearly where it was. Newton's
/// method may miss it from the first landing of a round and find it from the last. Where jumps are solved
/// coarsely, it may find it from any other alone.
bool GaitSolver::find_orbit(const Design& design, const Course& course, Orbit& orbit) {
  const std::vector<Landed>& seen = course.seen;
  const bool is_coarse = map_.nearness() > 1e-6;
  for (std::size_t period = 1; period < seen.size(); ++period) {
    const double gap = between(seen[0], seen[period]).lpNorm<Eigen::Infinity>();
    if (!(gap < scene_.gait_tolerance) && !shrinks(seen, period)) continue;
    const std::size_t apart = is_coarse || period == 1 ? 1 : period - 1;
    for (std::size_t k = 0; k < period; k += apart) {
      if (!map_.close(design, static_cast<int>(period), seen[k], orbit)) continue;
      if (std::abs(orbit.multiplier) < 1.0 && is_near(seen[k], gap, orbit, off(course))) return true;
      break;
    }
  }
  return false;
}

}  // namespace leapmap
