// SPDX-License-Identifier: GPL-3.0-or-later
/// The rule that picks the jump among a design's lift-offs.
#pragma once

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "physics/flight.hpp"

namespace leapmap {

/// Counts a lift-off and its flight, in order of time. True if it is the jump, which ends the search: the
/// jump is the first lift-off that reaches scene.hop_height.
bool consider(Outcome& outcome, const Scene& scene, const Design& design, const LiftOff<double>& lift_off,
              const Flight<double>& flight);

}  // namespace leapmap
