// SPDX-License-Identifier: GPL-3.0-or-later
/// Where on the hoop the tracks of a film are.
#pragma once

#include <vector>

#include "leapmap/fit.hpp"

namespace leapmap {

/// Gives each track its place: by the markers, by the names of weights, by names of the centre; of two tracks
/// the one with the shorter way is the centre, and the last without a place follows the mass. Throws
/// InputError for a track whose place is not known, and for a marker of no track or off the hoop.
void place_marks(Film& film, const Spec& spec, const std::vector<Marker>& markers);

}  // namespace leapmap
