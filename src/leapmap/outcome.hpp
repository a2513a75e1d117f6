// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// The outcome of one design.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace leapmap {

/// How a design ended. Maps store these numbers, so they never change.
enum class Status : std::uint8_t {
  not_computed = 0,         ///< not solved yet, in an incomplete map
  jumped = 1,               ///< it jumps; every jump_ field is valid
  no_jump = 2,              ///< it reaches the rolling limit first
  stalled = 3,              ///< trapped: it rocks between two turning points, or rests
  airborne_at_release = 4,  ///< the normal force at the release is zero or negative
  indeterminate = 5,        ///< Painleve's paradox: the rigid-body equations have no solution or two
  failed = 6,               ///< the method could not solve it; no field is valid
};
/// Number of statuses.
inline constexpr int status_count = 7;

/// The status's name in maps and tables, for example "jumped".
constexpr std::string_view name_of(Status status) {
  constexpr std::array<std::string_view, status_count> names{
      "not_computed", "jumped", "no_jump", "stalled", "airborne_at_release", "indeterminate", "failed"};
  return names[static_cast<std::size_t>(status)];
}

/// Number of designs with each status.
using StatusCounts = std::array<std::int64_t, status_count>;
/// Number of designs with any status.
inline std::size_t designs_in(const StatusCounts& counts) {
  std::int64_t designs = 0;
  for (const std::int64_t count : counts) designs += count;
  return static_cast<std::size_t>(designs);
}

/// Contact phase. Traces and phase_sequence store these numbers, so they never change.
enum class Phase : std::uint8_t {
  rolling = 1,  ///< contact without slip
  sliding = 2,  ///< contact with slip, in either direction
  flight = 3    ///< no contact
};

/// A phase_sequence as letters, for example "RSRSF". "-": none; "..." at the end: 32 phases or more.
std::string phase_letters(std::uint64_t sequence);

/// One jump of a sequence: lift-off, flight and landing. NaN: does not apply, or was not requested.
struct Jump {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();  ///< a number that does not apply
  double height = none;                    ///< of the apex above the plane [hoop diameters]
  double time = none;                      ///< from release to lift-off [s]
  double angle = none;                     ///< phi at lift-off [rad]
  double spin = none;                      ///< w at lift-off [sqrt(g/R)]
  double distance = none;                  ///< travelled by the hoop's centre from release to lift-off [R]
  double flight_time = none;               ///< from lift-off to landing [s]
  double landing_spin = none;              ///< w after the landing [sqrt(g/R)]
  double range = none;                     ///< travel of the centre from lift-off to landing [R]
  double landing_normal_speed = none;      ///< as Outcome::landing_normal_speed
  double landing_tangential_speed = none;  ///< as Outcome::landing_tangential_speed
  double landing_impulse = none;           ///< as Outcome::landing_impulse
  double landing_energy_lost = none;       ///< as Outcome::landing_energy_lost
  double clears_from = none;               ///< as Outcome::clears_from
  double clears_to = none;                 ///< as Outcome::clears_to
  double max_normal_force = none;          ///< on the way from the landing before [(m + m_p) g]
  double motor_energy = none;              ///< on that way, as Outcome::motor_energy
  double motor_max_power = none;           ///< on that way, as Outcome::motor_max_power
  double motor_max_spin = none;            ///< on that way, as Outcome::motor_max_spin
};

/// Largest number of jumps that a scene may ask for.
inline constexpr long most_jumps = 250;

/// The outcome of one design, as maps store it. NaN: does not apply. All members but later_jumps and those of
/// gaits describe the first jump and the motion before it.
struct Outcome {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();  ///< a number that does not apply
  static constexpr std::uint8_t no_lift_off = 255;      ///< spurious_first_jump without any lift-off
  static constexpr std::uint8_t most_candidates = 254;  ///< largest value of `candidates`

  Status status = Status::not_computed;  ///< how the design ended
  std::uint8_t spurious_first_jump =
      no_lift_off;                             ///< 1: the first lift-off stays below hop_height; 0: it jumps
  std::uint8_t candidates = 0;                 ///< number of lift-offs up to the jump, the jump included
  Status sequence_end = Status::not_computed;  ///< jumped: all Scene::jumps were made; else why not
  double jump_height = none;                   ///< apex of the jump above the plane [hoop diameters]
  double jump_time = none;                     ///< from release to lift-off [s]
  double jump_angle = none;                    ///< phi at lift-off [rad]
  double jump_spin = none;                     ///< w at lift-off [sqrt(g/R)]
  double jump_distance = none;                 ///< travel of the centre from release to lift-off [R]
  double apex_time = none;                     ///< from lift-off to apex [s]
  double flight_time = none;                   ///< from lift-off to landing [s]
  double dip = none;                           ///< lowest height right after lift-off [hoop diameters], <= 0
  double first_jump_height = none;             ///< apex of the first lift-off [hoop diameters]
  double first_jump_time = none;               ///< from release to the first lift-off [s]
  double jump_range = none;                    ///< travel of the centre from lift-off to landing [R]
  double landing_normal_speed = none;          ///< of the contact point, towards the plane [sqrt(g R)]
  double landing_tangential_speed = none;      ///< the same along the plane, positive downhill
  /// Normal, of the whole landing [(m + m_p) sqrt(g R)]; below zero without slip: the plane would have to
  /// pull.
  double landing_impulse = none;
  double landing_energy_lost = none;  ///< kinetic energy lost in the landing [(m + m_p) g R]
  // With Scene::clear_height > 0: where along the plane, from the lift-off, a thin wall of that height may
  // stand so that the hoop flies over it. A box of width b is cleared if clears_to - clears_from >= b.
  double clears_from = none;  ///< first place [R]; NaN: none
  double clears_to = none;    ///< last place [R]; NaN: none
  // On the way from the release to the lift-off of the jump, if requested by name:
  double max_normal_force = none;  ///< the largest [(m + m_p) g]
  double motor_energy = none;      ///< work of the motor [(m + m_p) g R]
  double motor_max_power = none;   ///< its largest power [(m + m_p) g sqrt(g R)]; below zero: it only brakes
  double motor_max_spin = none;    ///< largest spin of the hoop, or of a pendulum relative to it [sqrt(g/R)]
  double motor_max_torque = none;  ///< pendulum only: its largest torque, either way [(m + m_p) g R]
  double efficiency = none;        ///< pendulum only: weight times height over motor_energy, if above 1e-9
  // With Coulomb friction.
  std::uint64_t phase_sequence = 0;  ///< two bits a phase, the first lowest, up to 32; see Phase
  double slip_distance = none;       ///< slid until the jump, or the end [R]; NaN if the hoop rocks to rest
  double landing_spin = none;        ///< w after the landing of the jump [sqrt(g/R)]
  double energy_lost = none;         ///< from release to lift-off [(m + m_p) g R]
  // With Scene::jumps > 1, if requested by name:
  double sequence_condition = none;  ///< growth factor of errors at the release and at every landing
  // With Scene::settle > 0: the gait that the hoop's jumps converge to.
  static constexpr std::uint8_t no_gait = 255;  ///< gait_period if jumps continue without a period
  std::uint8_t gait_period = no_gait;           ///< period [jumps]; 0: the jumps end
  double gait_multiplier = none;                ///< Floquet multiplier: growth of a deviation over one period
  double gait_height = none;                    ///< mean height of its jumps [hoop diameters]
  double gait_speed = none;                     ///< mean speed down the plane [m/s]
  double gait_jump_time = none;                 ///< per jump [s]
  double gait_energy_lost = none;               ///< per jump [(m + m_p) g R]
  const char* failure = nullptr;                ///< reason of status failed, or nullptr
  std::vector<Jump> later_jumps{};              ///< the jumps after the first, at most Scene::jumps - 1

  /// Number of jumps that the design makes.
  std::size_t jumps() const { return status == Status::jumped ? 1 + later_jumps.size() : 0; }
};

/// Selects a number of an outcome: a member of Outcome, or a member of one of its later jumps.
struct OutcomeNumber {
  double Outcome::*own = nullptr;   ///< member of Outcome, if `jump` is 1
  double Jump::*of_jump = nullptr;  ///< member of Jump, if `jump` is larger
  std::size_t jump = 1;             ///< number of the jump, from 1

  /// Selects a member of Outcome.
  constexpr OutcomeNumber(double Outcome::*member) : own(member) {}
  /// Selects a member of the jump with that number.
  constexpr OutcomeNumber(double Jump::*member, std::size_t which) : of_jump(member), jump(which) {}
  /// Whether both select the same number.
  bool operator==(const OutcomeNumber&) const = default;

  /// Its value; NaN if the outcome has no such jump.
  double of(const Outcome& outcome) const {
    if (jump == 1) return outcome.*own;
    return jump <= outcome.jumps() ? outcome.later_jumps[jump - 2].*of_jump : Outcome::none;
  }
  /// Its address in an outcome; nullptr if the outcome has no such jump.
  double* in(Outcome& outcome) const {
    if (jump == 1) return &(outcome.*own);
    return jump <= outcome.jumps() ? &(outcome.later_jumps[jump - 2].*of_jump) : nullptr;
  }
};

/// Whether two outcomes agree in status, sub-threshold first lift-off, number of lift-offs and phases.
inline bool same_flags(const Outcome& a, const Outcome& b) {
  return a.status == b.status && a.spurious_first_jump == b.spurious_first_jump &&
         a.candidates == b.candidates && a.phase_sequence == b.phase_sequence;
}

/// The outcome of a design that could not be solved.
/// @param why  the reason, a text that lives as long as the program
inline Outcome failed_outcome(const char* why) {
  Outcome outcome;
  outcome.status = Status::failed;
  outcome.failure = why;
  return outcome;
}

}  // namespace leapmap
