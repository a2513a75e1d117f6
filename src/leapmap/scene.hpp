// SPDX-License-Identifier: GPL-3.0-or-later
/// What all designs of a study share: the plane, the rule that says what a jump is, and the units of the
/// answer.
#pragma once

#include <cmath>

namespace leapmap {

/// How the contact holds: it never slips (the paper's model), or Coulomb's law.
enum class Friction { sticking, coulomb };

struct Scene {
  Friction friction = Friction::sticking;
  double runway = 5.0;       ///< where the search for a jump ends [revolutions rolled since release], > 0
  double hop_height = 0.05;  ///< a lift-off this high is the jump [hoop diameters], >= 0; 0: the first one is
  long jumps = 1;            ///< go on after a landing until that many jumps, in [1, 250]
  // Of gaits, which jump after jump repeat themselves; the runway then counts from each landing.
  long settle = 0;        ///< jumps before a gait is looked at, in [0, 10^6]; 0: none is looked for
  long most_period = 16;  ///< of a gait [jumps], in [1, 64]
  /// How nearly a landing comes again that is closed to an orbit [rad, sqrt(g/R)], in (0, 1].
  double gait_tolerance = 1e-3;
  double rest_speed = 1e-3;  ///< coulomb: a rebound slower than this counts as none [sqrt(g R)], >= 0
  double radius = 0.041;     ///< R [m], > 0; scales lengths and times, nothing else
  double gravity = 9.81;     ///< g [m/s^2], > 0; scales times, nothing else
};

/// sqrt(R/g) [s], the unit of time inside the solvers.
inline double time_unit(const Scene& scene) { return std::sqrt(scene.radius / scene.gravity); }

}  // namespace leapmap
