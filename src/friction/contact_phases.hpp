// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling, sliding, flying and landing with Coulomb friction, as a machine of phases.
///
// clang-format off
///   phase       | ends when                           | and then
///   ------------+-------------------------------------+----------------------------------------------
///   R rolling   | |F| - mu_s N rises through zero     | S, the way that F held back (v gets the sign
///     v = 0     |                                     |   of -F); F if n0 <= 0 there
///               | it has turned round twice           | stalled: it repeats itself
///   S sliding   | n0 falls through zero               | F, lift-off
///     v > 0 or  | v comes back to zero                | R if |F| <= mu_s N, else S the other way
///     v < 0     | Ic + rho s q falls to zero          | indeterminate (Painleve)
///   F flight    | its apex reaches hop_height         | jumped
///               | it begins by sinking, as the motor  | indeterminate: the plane would have to
///               |   that lifted it idles in flight    |   pull in contact, and is in the way
///               | y comes back to zero                | landing, impulses at once; then F if it
///               |                                     |   rebounds or n0 <= 0, S if v is not zero,
///               |                                     |   else as where v comes back to zero
///   R, S, F     | the centre has travelled the        | no_jump
///               |   runway, either way                |
///   at release  |                                     | R if N > 0 and |F| <= mu_s N, else
///               |                                     |   airborne_at_release if n0 <= 0, else S;
///               |                                     |   stalled at rest where nothing pulls
// clang-format on
///
/// A hoop that rolls or slides may turn round. One that rocks may slip a little less on every swing, for
/// ever: it is stalled, too, when its phases come again and again with less spin each (Rocking). At v = 0 the
/// forces decide, never the sign of a rounded v, and what friction holds but for rounding it holds.
/// Painleve's region is where the rigid-body equations have no answer or two; a slide that runs into its edge
/// is followed until doubles cannot tell the edge from where it is. A design that goes through more than
/// most_phases phases is failed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "hoop/contact_state.hpp"
#include "hoop/rolling.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// What the phases end in. slips_*: the direction that v takes.
enum class PhaseEnd {
  slips_forwards,
  slips_backwards,
  slip_ends,
  lifts_off,
  stalls,
  runway_ends,
  indeterminate,
  too_long,
  reverses,  ///< against a resisting torque
  failed
};

/// Whether a contact with n0 <= 0, which would leave the plane were it not held, does.
enum class Leaving {
  unless_it_sticks,  ///< rolling on is consistent there too, and what rolls goes on rolling
  always,
  never
};

/// What a design's friction and landing look like, its defaults settled. Static friction is never below
/// kinetic: between the two neither sticking nor sliding would be consistent.
template <class S>
struct Contact {
  S mu_static, mu_kinetic, restitution, rest_speed;
};
template <class S>
Contact<S> contact_of(const Design& design, const Scene& scene) {
  const double kinetic = std::isnan(design.mu_kinetic) ? design.mu_static : design.mu_kinetic;
  return {S(std::max(design.mu_static, kinetic)), S(kinetic), S(design.restitution), S(scene.rest_speed)};
}

inline constexpr int most_phases = 2'000;
/// Why a hoop fails that rebounds ever less, and never so little that rest_speed counts it as none.
inline constexpr const char* endless_rebounds =
    "its rebounds never end, as rest_speed counts none as the last; allowed: rest_speed = 1e-12 or more";

/// phase_sequence: two bits a phase, the first lowest, up to 32.
class PhaseSequence {
 public:
  void append(Phase phase) {
    if (count_ < 32) code_ |= static_cast<std::uint64_t>(phase) << (2 * count_);
    ++count_;
  }
  std::uint64_t code() const { return code_; }
  int count() const { return count_; }

 private:
  std::uint64_t code_ = 0;
  int count_ = 0;
};

/// Sees a hoop rock to rest: every phase of a cycle comes again in its place with less spin, and what a cycle
/// travels shrinks so fast that all that is left of it is next to nothing. The plane is the same everywhere,
/// so that there is nothing but the angle to tell one swing from another. Cycles of 2, 3, 4, 6 or 12 phases
/// are seen, and only after those that phase_sequence holds. After many phases those of up to 8, 10, 14 or 16
/// are, too, and it is enough that the fastest phase of a cycle loses spin: the others begin sooner or later
/// in a swing from cycle to cycle.
class Rocking {
 public:
  /// Forgets what it has seen, for less than it takes to make another one.
  void restart() { count_ = 0, shrinking_ = {}; }
  /// Looks at a phase as it begins; direction: of sliding. True: it rocks to rest.
  bool settles(Phase phase, int direction, double travel, double angle, double spin) {
    begun_[static_cast<std::size_t>(count_++ % remembered)] = {phase, direction, travel, angle, spin};
    bool rests = false;
    for (std::size_t k = 0; k < cycles.size() && !rests && (k == 0 || count_ > many); ++k) {
      const int cycle = cycles[k];
      const bool again = count_ > 2 * cycle && comes_again(ago(2 * cycle), ago(cycle), ago(0)) &&
                         (std::abs(spin) < std::abs(ago(cycle).spin) ||
                          (count_ > many && fastest(0, cycle) < fastest(cycle, cycle)));
      shrinking_[k] = again ? shrinking_[k] + 1 : 0;
      rests = count_ > 32 && shrinking_[k] >= cycle;
    }
    return rests;
  }

 private:
  static constexpr std::array cycles{12, 8, 10, 14, 16};  // each of its divisors, too
  static constexpr int many = 256, remembered = 33;       // two of the longest, and the phase that begins
  struct Begun {
    Phase phase;
    int direction;
    double travel, angle, spin;
  };

  const Begun& ago(int phases) const {
    return begun_[static_cast<std::size_t>((count_ - 1 - phases) % remembered)];
  }
  /// Of so many phases, before the last `later` ones.
  double fastest(int later, int phases) const {
    double spin = 0.0;
    for (int k = 0; k < phases; ++k) spin = std::max(spin, std::abs(ago(later + k).spin));
    return spin;
  }
  static bool comes_again(const Begun& first, const Begun& before, const Begun& now) {
    constexpr double nothing = 0.1;  // [R, rad, sqrt(g/R)]
    // of a cycle, and the share of it that the next one has
    const double drift = std::abs(now.travel - before.travel),
                 share = drift / std::abs(before.travel - first.travel);
    return now.phase != Phase::flight && before.phase == now.phase && before.direction == now.direction &&
           before.spin * now.spin > 0.0 && std::abs(now.spin) - std::abs(before.spin) < nothing &&
           share < 1.0 && drift * share / (1.0 - share) < nothing &&
           std::abs(now.angle - before.angle) < nothing;
  }

  std::array<Begun, remembered> begun_;  // the last ones; what has not begun yet is never read
  std::array<int, cycles.size()> shrinking_{};
  int count_ = 0;
};

}  // namespace leapmap
