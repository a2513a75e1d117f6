// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion: its phases, every lift-off on the way, and samples over time. SI units.
#pragma once

#include <vector>

#include "leapmap/outcome.hpp"

namespace leapmap {

/// The motion at one time.
struct MotionPoint {
  double t;             ///< since release [s]
  double phi;           ///< angle [rad]; 0: mass on the plane
  double spin;          ///< phi' [rad/s], positive downhill
  double x;             ///< travel of the hoop's centre along the plane since release [m]
  double y;             ///< height of the hoop's lowest point above the plane [m]; 0 in contact
  double normal_force;  ///< (11), over the weight; negative: rolling on would need a plane that pulls
  double friction;      ///< (12), over the weight, positive downhill
  Phase phase;
};

/// A phase as it begins.
struct PhaseStart {
  Phase phase;
  int direction;  ///< of sliding: 1 forwards, -1 backwards; else 0
  double t;       ///< since release [s]
  double phi;     ///< [rad]
  double spin;    ///< [rad/s]
  double x;       ///< travel since release [m]
};

/// A lift-off that was looked at, and the flight it begins.
struct Candidate {
  double t;            ///< of the lift-off, since release [s]
  double phi;          ///< [rad]
  double spin;         ///< [rad/s]
  double height;       ///< of the apex [hoop diameters]; 0: it sinks at once
  double apex_time;    ///< from the lift-off [s]
  double flight_time;  ///< from the lift-off to the landing [s]
  double dip;          ///< how far the flight first enters the plane [hoop diameters], <= 0
  bool is_jump;        ///< it is as high as a jump has to be
};

/// A place where the normal force touches zero, or nearly so: a lift-off decided by a hair.
struct Graze {
  double t;             ///< since release [s]
  double phi;           ///< [rad]
  double normal_force;  ///< at its extremum, over the weight
  bool minimum;         ///< a minimum or a maximum of the normal force

  /// Whether it was counted as making a lift-off: a minimum below zero, or a maximum above zero, after which
  /// the normal force falls again.
  bool makes_lift_off() const { return minimum == (normal_force < 0.0); }
};

/// From release to the end: the last jump's landing, the stall or the runway's end. A motion towards a stall
/// ends a hair before it, as the stall itself is approached for ever.
struct Motion {
  Outcome outcome;
  std::vector<PhaseStart> phases;     ///< in order; without slip: it rolls until a jump
  std::vector<Candidate> candidates;  ///< in order, jumps among them
  std::vector<Graze> grazes;          ///< found by integration only
  std::vector<MotionPoint> points;    ///< empty unless asked for
  double end = 0.0;  ///< when the motion ends [s], if points were asked for; by integration, their last
};

}  // namespace leapmap
