// SPDX-License-Identifier: GPL-3.0-or-later
/// Where along the plane a thin wall may stand so that a hoop jumps over it.
#pragma once

#include <span>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// Fills in clears_from and clears_to of designs that jump, for walls of scene.clear_height. Their flights
/// must be known: jump_angle, jump_spin, apex_time, flight_time, jump_range, landing_normal_speed.
void find_clearances(const Scene& scene, std::span<const Design> designs, std::span<Outcome> outcomes);

}  // namespace leapmap
