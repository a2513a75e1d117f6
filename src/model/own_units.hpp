// SPDX-License-Identifier: GPL-3.0-or-later
/// The units in which leapmap computes: of the SI, or products of the hoop's radius, its mass and gravity.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "leapmap/scene.hpp"

namespace leapmap {

/// What turns leapmap's own units into those of the SI.
struct Scales {
  double radius = Scene{}.radius;    ///< R [m]
  double gravity = Scene{}.gravity;  ///< g [m/s^2]
  double mass = Scene{}.mass;        ///< m + m_p [kg]; 0: not known
};

inline Scales scales_of(const Scene& scene) { return {scene.radius, scene.gravity, scene.mass}; }

/// A unit of parameters and fields: so many of a unit of the SI, for a hoop of that size.
struct OwnUnit {
  std::string_view name;
  const char* si;  ///< as UDUNITS reads it
  double (*size)(const Scales&);
  std::string_view example;  ///< one in which people give such numbers
};

namespace own {
constexpr double one(const Scales&) { return 1.0; }
inline double time(const Scales& s) { return std::sqrt(s.radius / s.gravity); }
inline double speed(const Scales& s) { return std::sqrt(s.radius * s.gravity); }
inline double energy(const Scales& s) { return s.mass * s.gravity * s.radius; }
}  // namespace own

inline constexpr std::array own_units{
    OwnUnit{"rad", "rad", own::one, "deg"},
    OwnUnit{"s", "s", own::one, "ms"},
    OwnUnit{"m", "m", own::one, "mm"},
    OwnUnit{"kg", "kg", own::one, "g"},
    OwnUnit{"kg m2", "kg m2", own::one, "g mm2"},
    OwnUnit{"m s-1", "m s-1", own::one, "mm/s"},
    OwnUnit{"rad s-1", "rad s-1", own::one, "rpm"},
    OwnUnit{"m s-2", "m s-2", own::one, "m/s2"},
    OwnUnit{"R", "m", [](const Scales& s) { return s.radius; }, "mm"},
    OwnUnit{"hoop diameters", "m", [](const Scales& s) { return 2.0 * s.radius; }, "mm"},
    OwnUnit{"revolutions", "m", [](const Scales& s) { return 2.0 * std::numbers::pi * s.radius; }, "m"},
    OwnUnit{"sqrt(R/g)", "s", own::time, "ms"},
    OwnUnit{"sqrt(g/R)", "rad s-1", [](const Scales& s) { return 1.0 / own::time(s); }, "rpm"},
    OwnUnit{"rad or sqrt(g/R)", "rad", own::one, "deg"},  // of motor_target, by the motor's law
    OwnUnit{"sqrt(g R)", "m s-1", own::speed, "m/s"},
    OwnUnit{"(m + m_p) g R", "N m", own::energy, "N m"},
    OwnUnit{"(m + m_p) g sqrt(g R)", "W", [](const Scales& s) { return s.mass * s.gravity * own::speed(s); },
            "W"},
    OwnUnit{"(m + m_p) g", "N", [](const Scales& s) { return s.mass * s.gravity; }, "N"},
    OwnUnit{"(m + m_p) sqrt(g R)", "N s", [](const Scales& s) { return s.mass * own::speed(s); }, "N s"},
};

/// The unit of that name, or nullptr: of pure numbers, and of what is no number.
constexpr const OwnUnit* find_own_unit(std::string_view name) {
  for (const OwnUnit& own : own_units)
    if (own.name == name) return &own;
  return nullptr;
}

}  // namespace leapmap
