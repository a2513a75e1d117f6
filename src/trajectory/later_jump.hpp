// SPDX-License-Identifier: GPL-3.0-or-later
/// The quantities of every jump of a sequence: members of Outcome for the first, of Jump for later ones.
#pragma once

#include <array>

#include "leapmap/outcome.hpp"

namespace leapmap {

struct JumpRow {
  double Outcome::*first;
  double Jump::*later;
};
inline constexpr std::array jump_rows{
    JumpRow{&Outcome::jump_height, &Jump::height},
    JumpRow{&Outcome::jump_time, &Jump::time},
    JumpRow{&Outcome::jump_angle, &Jump::angle},
    JumpRow{&Outcome::jump_spin, &Jump::spin},
    JumpRow{&Outcome::jump_distance, &Jump::distance},
    JumpRow{&Outcome::flight_time, &Jump::flight_time},
    JumpRow{&Outcome::jump_range, &Jump::range},
    JumpRow{&Outcome::landing_normal_speed, &Jump::landing_normal_speed},
    JumpRow{&Outcome::landing_tangential_speed, &Jump::landing_tangential_speed},
    JumpRow{&Outcome::landing_impulse, &Jump::landing_impulse},
    JumpRow{&Outcome::landing_energy_lost, &Jump::landing_energy_lost},
    JumpRow{&Outcome::clears_from, &Jump::clears_from},
    JumpRow{&Outcome::clears_to, &Jump::clears_to},
    JumpRow{&Outcome::max_normal_force, &Jump::max_normal_force},
    JumpRow{&Outcome::motor_energy, &Jump::motor_energy},
    JumpRow{&Outcome::motor_max_power, &Jump::motor_max_power},
    JumpRow{&Outcome::motor_max_spin, &Jump::motor_max_spin}};

/// Where later jumps keep a quantity of the first; nullptr: nowhere.
constexpr double Jump::*later_member(double Outcome::*first) {
  for (const JumpRow& row : jump_rows)
    if (row.first == first) return row.later;
  return nullptr;
}

/// A jump after the first, which a solver reports in an Outcome as if it were the first.
inline Jump jump_of(const Outcome& outcome, double landing_spin) {
  Jump jump;
  for (const JumpRow& row : jump_rows) jump.*row.later = outcome.*row.first;
  jump.landing_spin = landing_spin;
  return jump;
}

}  // namespace leapmap
