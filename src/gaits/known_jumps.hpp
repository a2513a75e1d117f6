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
  /// phases: Outcome::phase_sequence of the jump between these two reduced landings. A jump is left out if
  /// that holds no phases or not all of them, because two such jumps may differ though their phases agree. No
  /// more than 256 jumps are kept.
  void add(const Landed& from, const Landed& to, std::uint64_t phases);

  /// Where the jump ends that begins there. Nothing if interpolation is not good to some `error`: its
  /// neighbours went through other phases, lie on another curve, or are too far away. Once too few of the
  /// jumps asked for could be interpolated, it always returns nothing.
  std::optional<Landed> next(const Landed& from);

  /// The largest change that the last neighbour may make to the interpolated landing. The landing itself is
  /// mostly nearer to the solved one than that.
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
  /// Where a jump begins, and which it is.
  struct Place {
    double angle;
    std::size_t jump;
  };
  const Known& at(const Place& place) const { return known_[place.jump]; }
  std::vector<Place>::const_iterator at_or_after(double angle) const;
  bool gives_up() const;

  std::vector<Known> known_;
  std::vector<Place> places_;                 // by angle
  std::size_t asked_ = 0, interpolated_ = 0;  // jumps so far
};

}  // namespace leapmap
