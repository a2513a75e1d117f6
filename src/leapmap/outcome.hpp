// SPDX-License-Identifier: GPL-3.0-or-later
/// The answer for one design.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace leapmap {

/// How a design ended. Stored in maps: numbers are never reused or changed.
enum class Status : std::uint8_t {
  not_computed = 0,         ///< nothing is known; holes in an unfinished map
  jumped = 1,               ///< every jump_ field is valid
  no_jump = 2,              ///< the runway ended first
  stalled = 3,              ///< the spin fell to zero first, or the hoop starts uphill
  airborne_at_release = 4,  ///< the plane would have to pull at t = 0
  indeterminate = 5,        ///< Painleve: the rigid-body equations have no answer or two
  failed = 6,               ///< the method gave up; no field is valid
};
inline constexpr int status_count = 7;

/// The status as written in maps and tables, for example "jumped".
constexpr std::string_view name_of(Status status) {
  constexpr std::array<std::string_view, status_count> names{
      "not_computed", "jumped", "no_jump", "stalled", "airborne_at_release", "indeterminate", "failed"};
  return names[static_cast<std::size_t>(status)];
}

/// Designs by how they ended.
using StatusCounts = std::array<std::int64_t, status_count>;
inline std::size_t designs_in(const StatusCounts& counts) {
  std::int64_t designs = 0;
  for (const std::int64_t count : counts) designs += count;
  return static_cast<std::size_t>(designs);
}

/// Stored in traces and phase_sequence: numbers are never reused or changed.
enum class Phase : std::uint8_t { rolling = 1, sliding = 2, flight = 3 };

/// A phase_sequence as letters, for example "RSRSF"; "-": none; with "..." where there are 32 phases or more.
std::string phase_letters(std::uint64_t sequence);

/// A jump of a sequence: its lift-off, flight and landing.
struct Jump {
  double height;        ///< of the apex above the plane [hoop diameters]
  double time;          ///< from release to lift-off [s]
  double angle;         ///< phi at lift-off [rad]
  double spin;          ///< w at lift-off [sqrt(g/R)]
  double distance;      ///< travelled by the hoop's centre from release to lift-off [R]
  double flight_time;   ///< [s]
  double landing_spin;  ///< w after the landing [sqrt(g/R)]
};

/// Most jumps that a scene may ask for, and most that are stored.
inline constexpr long most_jumps = 250;

/// As maps store it. NaN: does not apply. What has no number is of the first jump, or of the way to it,
/// however many jumps the scene asks for.
struct Outcome {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::uint8_t no_lift_off = 255;  ///< spurious_first_jump where there is no lift-off at all
  static constexpr std::uint8_t most_candidates = 254;  ///< candidates stops counting here

  Status status = Status::not_computed;
  std::uint8_t spurious_first_jump = no_lift_off;  ///< 1: the first lift-off stayed below hop_height
  std::uint8_t candidates = 0;                     ///< lift-offs looked at, the jump included
  Status sequence_end =
      Status::not_computed;         ///< of a sequence: jumped if it made all the jumps, else why not
  double jump_height = none;        ///< apex of the jump above the plane [hoop diameters]
  double jump_time = none;          ///< from release to lift-off [s]
  double jump_angle = none;         ///< phi at lift-off [rad]
  double jump_spin = none;          ///< w at lift-off [sqrt(g/R)]
  double jump_distance = none;      ///< travelled since release [R]
  double apex_time = none;          ///< from lift-off [s]
  double flight_time = none;        ///< from lift-off to landing [s]
  double dip = none;                ///< how far the flight first enters the plane [hoop diameters], <= 0
  double first_jump_height = none;  ///< of the first lift-off [hoop diameters]
  double first_jump_time = none;    ///< [s]
  // With Coulomb friction.
  std::uint64_t phase_sequence = 0;  ///< two bits a phase, the first lowest, up to 32; see Phase
  double slip_distance = none;       ///< slid, either way, until the end [R]; NaN if the hoop rocks to rest
  double landing_spin = none;        ///< w after the landing of the jump [sqrt(g/R)]
  double energy_lost = none;         ///< from release to the lift-off of the jump, over (m + m_p) g R
  // With Scene::jumps > 1, where it is asked for by name:
  double sequence_condition = none;  ///< what errors of one at the release and at every landing come to
  // With Scene::settle > 0: the gait that the hoop settles on.
  static constexpr std::uint8_t no_gait = 255;  ///< gait_period where jumps go on and none is found
  std::uint8_t gait_period = no_gait;           ///< in jumps; 0: they come to an end
  double gait_multiplier = none;                ///< of the return map round the gait: errors shrink by it
  double gait_height = none;                    ///< mean of its jumps [hoop diameters]
  double gait_speed = none;                     ///< down the plane [m/s]
  double gait_energy_lost = none;               ///< a jump, over (m + m_p) g R
  const char* failure = nullptr;                ///< why the status is failed, if that is known
  std::vector<Jump> later_jumps{};  ///< those after the first, as many of Scene::jumps as it makes

  /// How many jumps it makes.
  std::size_t jumps() const { return status == Status::jumped ? 1 + later_jumps.size() : 0; }
};

/// A number of an outcome: one of its own, or that of a later jump; NaN if it makes no such jump.
struct OutcomeNumber {
  double Outcome::*own = nullptr;
  double Jump::*of_jump = nullptr;
  std::size_t jump = 1;  ///< which, from 1; 1: an outcome's own

  constexpr OutcomeNumber(double Outcome::*member) : own(member) {}
  constexpr OutcomeNumber(double Jump::*member, std::size_t which) : of_jump(member), jump(which) {}
  bool operator==(const OutcomeNumber&) const = default;

  double of(const Outcome& outcome) const {
    if (jump == 1) return outcome.*own;
    return jump <= outcome.jumps() ? outcome.later_jumps[jump - 2].*of_jump : Outcome::none;
  }
  /// Where an outcome keeps it; nullptr: it makes no such jump.
  double* in(Outcome& outcome) const {
    if (jump == 1) return &(outcome.*own);
    return jump <= outcome.jumps() ? &(outcome.later_jumps[jump - 2].*of_jump) : nullptr;
  }
};

/// Whether two methods see the same: status, spurious flag, number of candidates and phases.
inline bool same_flags(const Outcome& a, const Outcome& b) {
  return a.status == b.status && a.spurious_first_jump == b.spurious_first_jump &&
         a.candidates == b.candidates && a.phase_sequence == b.phase_sequence;
}

/// The outcome of a design that a method gave up on; why: a text that lives as long as the program.
inline Outcome failed_outcome(const char* why) {
  Outcome outcome;
  outcome.status = Status::failed;
  outcome.failure = why;
  return outcome;
}

}  // namespace leapmap
