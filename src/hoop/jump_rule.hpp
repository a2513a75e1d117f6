// SPDX-License-Identifier: GPL-3.0-or-later
/// The rule that picks the jump among a design's lift-offs.
#pragma once

#include "hoop/flight.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// Counts a lift-off and its flight, in order of time. True if it is the jump, which ends the search: the
/// jump is the first lift-off that reaches scene.hop_height. distance: travelled from the release to there.
inline bool consider(Outcome& outcome, const Scene& scene, const LiftOff<double>& lift_off,
                     const Flight<double>& flight, double distance) {
  const bool is_jump = flight.height >= scene.hop_height;
  if (outcome.candidates < Outcome::most_candidates) ++outcome.candidates;
  if (outcome.spurious_first_jump == Outcome::no_lift_off) {
    outcome.spurious_first_jump = is_jump ? 0 : 1;
    outcome.first_jump_height = flight.height;
    outcome.first_jump_time = lift_off.time;
  }
  if (!is_jump) return false;
  outcome.status = Status::jumped;
  outcome.jump_height = flight.height;
  outcome.jump_time = lift_off.time;
  outcome.jump_angle = lift_off.angle;
  outcome.jump_spin = lift_off.spin;
  outcome.jump_distance = distance;
  outcome.apex_time = flight.apex_time;
  outcome.flight_time = flight.flight_time;
  outcome.dip = flight.dip;
  return true;
}

}  // namespace leapmap
