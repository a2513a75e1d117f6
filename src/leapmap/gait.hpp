// SPDX-License-Identifier: GPL-3.0-or-later
/// Gaits: hoops that jump for ever, and their stability. Scene::settle has every solver tell the gait that a
/// design settles on; here all of them are looked for, the unstable ones too.
#pragma once

#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// A periodic sequence of jumps.
struct Gait {
  std::vector<Jump> jumps;   ///< once round; times and distances each from the landing before
  double multiplier = 0.0;   ///< derivative of the return map round it: stable where below 1 in size
  double height = 0.0;       ///< mean of the jumps [hoop diameters]
  double speed = 0.0;        ///< down the plane [m/s]
  double energy_lost = 0.0;  ///< a jump, over (m + m_p) g R

  bool is_stable() const { return multiplier > -1.0 && multiplier < 1.0; }
};

/// Where the return map takes a lift-off: angles in [0, 2 pi) [rad].
struct ReturnPoint {
  double angle;   ///< phi at a lift-off from rolling, where N = 0 tells the spin
  double next;    ///< phi at the next one; NaN: the hoop does not jump again, or jumps again where it lands
  double slope;   ///< d next / d angle
  double height;  ///< of the jump from `angle` [hoop diameters]; NaN: it stays below Scene::hop_height
  bool uphill;    ///< it lifts off with spin uphill
};

struct GaitOptions {
  int most_period = 1;       ///< of the gaits looked for [jumps], in [1, 16]
  double tolerance = 1e-10;  ///< relative, of times
};

struct Gaits {
  std::vector<Gait> gaits;           ///< by period, then by height
  std::vector<ReturnPoint> returns;  ///< the return map where it was looked at, by angle, downhill first
  bool is_whole =
      true;  ///< false: the map was looked at in as many places as are, and not as finely as it needs
};

/// The periodic orbits of the return map of one hoop that never slips, as far as a scan can tell: the map is
/// sampled every sixteenth of a degree and more densely between samples that lie on other branches, or where
/// a cubic does not foretell what is between them. A branch between two samples that are alike may be missed.
/// Orbits all of whose jumps begin where the one before lands are not on that curve: they are found by
/// Newton's iteration from some thousand starts, so that one may be missed. The runway counts from each
/// landing: with a longer one there are more gaits, of ever higher jumps. Throws InputError as solve does,
/// and with friction, where the map has more dimensions.
Gaits find_gaits(const Design& design, const Scene& scene = {}, const GaitOptions& options = {});

}  // namespace leapmap
