// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Gaits: periodic sequences of jumps, and their stability.
#pragma once

#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// A periodic sequence of jumps.
struct Gait {
  std::vector<Jump> jumps;   ///< one period; times and distances count from the landing before
  double multiplier = 0.0;   ///< Floquet multiplier: growth of a small deviation over one period
  double height = 0.0;       ///< mean height of the jumps [hoop diameters]
  double speed = 0.0;        ///< mean speed down the plane [m/s]
  double jump_time = 0.0;    ///< per jump [s]
  double energy_lost = 0.0;  ///< per jump [(m + m_p) g R]

  /// Whether small deviations decay.
  bool is_stable() const { return multiplier > -1.0 && multiplier < 1.0; }
};

/// One point of the return map, which takes the angle at one lift-off to the angle at the next.
struct ReturnPoint {
  double angle;   ///< phi at a lift-off from rolling, in [0, 2 pi) [rad]; N = 0 determines the spin
  double next;    ///< phi at the next lift-off; NaN: there is none, or it coincides with the landing
  double slope;   ///< d next / d angle
  double height;  ///< height of the jump from `angle` [hoop diameters]; NaN: below Scene::hop_height
  bool uphill;    ///< whether the hoop rolls uphill at the lift-off
};

/// Options of find_gaits.
struct GaitOptions {
  int most_period = 1;       ///< longest period to search for [jumps], in [1, 16]
  double tolerance = 1e-10;  ///< relative error allowed in times
};

/// Result of find_gaits.
struct Gaits {
  std::vector<Gait> gaits;           ///< ordered by period, then by height
  std::vector<ReturnPoint> returns;  ///< samples of the return map, ordered by angle, downhill first
  bool is_whole = true;  ///< false: the map has more folds than were sampled, gaits may be missing
};

/// Finds the gaits of one hoop that never slips, stable and unstable ones.
///
/// Without slip, N = 0 determines the spin at a lift-off, so that the return map is a curve. It is sampled
/// every sixteenth of a degree, and more densely if a cubic does not predict the points between. A branch
/// between two similar samples may be missed. Orbits whose lift-offs coincide with landings are not on that
/// curve. They are found by Newton's iteration from some thousand starting points; one may be missed.
/// The rolling limit counts from each landing: a larger one admits more gaits, of higher jumps.
/// (For walking machines: McGeer 1990; Garcia et al. 1998.)
/// @throws InputError as solve does, and with Coulomb friction, where the return map has more dimensions
Gaits find_gaits(const Design& design, const Scene& scene = {}, const GaitOptions& options = {});

}  // namespace leapmap
