// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's story: every lift-off on the way, and, if wanted, its motion sampled over time.
#pragma once

#include <cstdint>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "physics/flight.hpp"
#include "trajectory/contact_phases.hpp"
#include "trajectory/graze.hpp"

namespace leapmap {

struct IntegrationOptions;

/// The motion at one time. Lengths in R, times in sqrt(R/g), forces in weights.
struct TracePoint {
  double t;             ///< since release
  double phi;           ///< angle [rad]
  double spin;          ///< w
  double x;             ///< travel of the hoop's centre along the plane since release
  double y;             ///< height of the hoop's lowest point above the plane; 0 in contact
  double normal_force;  ///< (11); negative where rolling without slip would need a plane that pulls
  double friction;      ///< (12), positive downhill
  Phase phase;
};

/// A phase as it begins.
struct PhaseStart {
  Phase phase;
  ContactState<double> state;
  int direction;  ///< of sliding: 1 forwards, -1 backwards; else 0
};

/// A lift-off that was looked at, and the flight it would begin.
struct Candidate {
  LiftOff<double> lift_off;
  Flight<double> flight;
};

struct Story {
  Outcome outcome;
  std::vector<Candidate> candidates;
  std::vector<PhaseStart> phases;  ///< with Coulomb friction; else empty
  std::vector<Graze> grazes;       ///< zeros of the normal force decided by a hair; of integration only
  std::vector<TracePoint>
      points;        ///< from release to the end: the jump's landing, the stall, the runway's end
  double end = 0.0;  ///< when that is [sqrt(R/g)], if the motion was asked for; of exact only
};

inline constexpr double check_tolerance = 1e-12;  ///< of the method that checks a story

/// Solves one design by the exact solver and tells everything about it, for which no integrator is needed.
/// interval > 0: samples the motion that often [sqrt(R/g)], and at the jump's lift-off and landing. The
/// motion towards a stall ends a hair before it. Throws InputError if that would be more than 10^7 samples.
/// An infinite interval: those two only.
Story tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval = 0.0);

/// The same by integration in time, with grazes whose |N| is below graze_limit.
Story tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                          double interval = 0.0, double graze_limit = 1e-6);

}  // namespace leapmap
