// SPDX-License-Identifier: GPL-3.0-or-later
/// Where along the plane a thin wall may stand so that a hoop jumps over it.
#pragma once

#include <span>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

/// What clearances follow from: their derivatives need those of these.
std::span<double Outcome::*const> numbers_of_flights();

/// Fills in clears_from and clears_to of designs that jump, for walls of scene.clear_height. Their flights
/// must be known: jump_height, apex_time and numbers_of_flights. gradients, if given, is put their
/// derivatives; flights: those of numbers_of_flights, by the same parameters.
/// A wall in metres has none by the hoop's size.
void find_clearances(const Scene& scene, std::span<const Design> designs, std::span<Outcome> outcomes,
                     const Gradients& flights = {}, Gradients* gradients = nullptr);

}  // namespace leapmap
