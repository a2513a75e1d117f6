// SPDX-License-Identifier: GPL-3.0-or-later
/// The hoop's angle in a film: measured, or by two tracks.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "leapmap/fit.hpp"

namespace leapmap {

struct FilmAngles {
  std::vector<double> t{};  ///< [s]
  std::vector<double>
      phi{};  ///< [rad], continued over revolutions; of tracks with the camera's estimated tilt
};

/// Empty: one track alone does not show the angle.
FilmAngles angles_of(const Film& film, double slope);

/// Calls f(i, k) with the places of each time that two tracks have in common.
template <class F>
void for_common_times(const Track& one, const Track& other, const F& f) {
  for (std::size_t i = 0, k = 0; i < one.t.size(); ++i) {
    while (k < other.t.size() && other.t[k] < one.t[i]) ++k;
    if (k < other.t.size() && other.t[k] == one.t[i]) f(i, k);
  }
}

/// The centre's track, and the one farthest from it; nullptr: there is none.
std::pair<const Track*, const Track*> centre_and_mark(const Film& film);

/// Angle and spin [rad/s] at the time of the release, by the cubic that fits the beginning best: so long that
/// noise of a frame hardly counts, so short that the cubic holds. second: sqrt(R/g) [s].
std::pair<double, double> release_of(const FilmAngles& angles, double release, double second);

}  // namespace leapmap
