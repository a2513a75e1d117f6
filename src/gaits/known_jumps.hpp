// SPDX-License-Identifier: GPL-3.0-or-later
/// What one design's jumps have shown of its return map.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gaits/return_map.hpp"

namespace leapmap {

/// Jumps that have been solved, and by interpolation those that lie between them. The landings of a hoop that
/// rolls between its jumps lie on curves, by angle, and so do the next ones: after a hundred jumps of chaos
/// nearly all others are known.
class KnownJumps {
 public:
  /// phases: of the jump from one landing to the next, both reduced, as in Outcome::phase_sequence. Where it
  /// does not hold them all, or a model tells none, two jumps may differ though their phases agree: they are
  /// left out.
  void add(const Landed& from, const Landed& to, std::uint64_t phases);

  /// Where the jump ends that begins there. Nothing where its neighbours do not tell it to within `error`:
  /// they went through other phases, do not lie on one curve with it, or too far from it.
  std::optional<Landed> next(const Landed& from) const;

  /// Of what neighbours tell, at most, by the change that the outer ones make to what the inner ones do.
  static constexpr double error = 1e-9;

 private:
  /// What a jump went through: its phases, and whether it ends slipping and with a rebound.
  struct Kind {
    std::uint64_t phases;
    bool slips, rebounds;
    bool operator==(const Kind&) const = default;
  };
  struct Known {
    Landed from, to;
    Kind kind;
  };
  std::vector<Known>::const_iterator at_or_after(double angle) const;

  std::vector<Known> known_;  // by the angle at which they begin
};

}  // namespace leapmap
