// SPDX-License-Identifier: GPL-3.0-or-later
/// What one design's jumps have shown of its return map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaits/return_map.hpp"

namespace leapmap {

/// Jumps that have been solved, and by interpolation those that lie between them. The landings of a hoop that
/// rolls between its jumps lie on curves, by angle, and so do the next ones: of the jumps of a hoop that
/// never settles some two thirds are known from others.
class KnownJumps {
 public:
  /// phases: of the jump from one landing to the next, both reduced, as in Outcome::phase_sequence. Where it
  /// does not hold them all, or a model tells none, two jumps may differ though their phases agree: they are
  /// left out. So are those after the first some hundreds.
  void add(const Landed& from, const Landed& to, std::uint64_t phases);

  /// Where the jump ends that begins there. Nothing where its neighbours do not tell it to some `error`: they
  /// went through other phases, do not lie on one curve with it, or too far from it.
  std::optional<Landed> next(const Landed& from);

  /// By how much the farthest of the neighbours may change what the nearer ones tell: mostly more than it is
  /// off by.
  static constexpr double error = 1e-9;

 private:
  /// What a jump went through, and which way it slips (1, -1; 0: it does not) as it begins and where it ends.
  struct Kind {
    std::uint64_t phases;
    int slip, slip_there;
    bool rebounds;
    bool operator==(const Kind&) const = default;
  };
  struct Known {
    Landed from, to;
    Kind kind;
  };
  std::vector<Known>::const_iterator at_or_after(double angle) const;

  std::vector<Known> known_;  // by the angle at which they begin
  std::size_t told_ = 0;
};

}  // namespace leapmap
