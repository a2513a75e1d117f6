// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// The motion of one design: phases, lift-offs, samples over time. All in SI units.
#pragma once

#include <limits>
#include <vector>

#include "leapmap/outcome.hpp"

namespace leapmap {

/// The state at one time.
struct MotionPoint {
  double t;             ///< since release [s]
  double phi;           ///< angle [rad]; 0: mass on the plane
  double spin;          ///< phi' [rad/s], positive downhill
  double x;             ///< travel of the hoop's centre along the plane since release [m]
  double y;             ///< height of the hoop's lowest point above the plane [m]; 0 in contact
  double normal_force;  ///< N of the paper's (11), over the weight; 0 in flight; negative: the plane would
                        ///< have to hold the hoop down
  double friction;      ///< F of the paper's (12), over the weight, positive downhill
  Phase phase;          ///< contact phase
  // Of a pendulum; NaN: there is none.
  double pendulum_angle = std::numeric_limits<double>::quiet_NaN();  ///< psi [rad]
  double pendulum_spin = std::numeric_limits<double>::quiet_NaN();   ///< psi' [rad/s]
  double motor_torque = std::numeric_limits<double>::quiet_NaN();    ///< on it [(m + m_p) g R]
};

/// The beginning of a phase.
struct PhaseStart {
  Phase phase;    ///< contact phase
  int direction;  ///< of sliding: 1 forwards, -1 backwards; otherwise 0
  double t;       ///< since release [s]
  double phi;     ///< angle [rad]
  double spin;    ///< phi' [rad/s]
  double x;       ///< travel since release [m]
};

/// A lift-off and its flight.
struct Candidate {
  double t;            ///< time of the lift-off since release [s]
  double phi;          ///< angle at the lift-off [rad]
  double spin;         ///< phi' at the lift-off [rad/s]
  double height;       ///< apex above the plane [hoop diameters]; 0: the hoop sinks at once
  double apex_time;    ///< from the lift-off to the apex [s]
  double flight_time;  ///< from the lift-off to the landing [s]
  double dip;          ///< lowest height right after lift-off [hoop diameters], <= 0
  bool is_jump;        ///< whether it reaches Scene::hop_height
};

/// A grazing contact: an extremum of the normal force at nearly zero, which decides on a lift-off.
struct Graze {
  double t;             ///< since release [s]
  double phi;           ///< angle [rad]
  double normal_force;  ///< its extremum, over the weight
  bool minimum;         ///< true: a minimum; false: a maximum

  /// Whether it counts as a lift-off: a minimum below zero, or a maximum above zero, after which the normal
  /// force falls again.
  bool makes_lift_off() const { return minimum == (normal_force < 0.0); }
};

/// The motion from release to the last jump's landing, the rolling limit or the trapping. The approach to an
/// equilibrium takes infinitely long, so a motion towards one ends shortly before it.
struct Motion {
  Outcome outcome;                    ///< as solve returns it
  std::vector<PhaseStart> phases;     ///< in order
  std::vector<Candidate> candidates;  ///< all lift-offs in order, jumps included
  std::vector<Graze> grazes;          ///< found by integration only
  std::vector<MotionPoint> points;    ///< samples; empty unless requested
  double end = 0.0;                   ///< end of the motion [s], if samples were requested
};

}  // namespace leapmap
