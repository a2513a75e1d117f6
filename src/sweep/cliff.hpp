// SPDX-License-Identifier: GPL-3.0-or-later
/// What a cliff is told by, and bisection to it, of many at once.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "leapmap/boundaries.hpp"
#include "leapmap/design.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

Discrete discrete(const Outcome& outcome, bool phases);

/// A design and its outcome, a number along some line.
struct Probe {
  double at;
  Outcome outcome;
};

/// A line of designs between two whose discrete outcomes differ.
struct Stretch {
  std::size_t line;  ///< what design_at knows it by
  Probe below, above;
  double resolution;  ///< nothing is asked nearer than this
};

/// What happens between two designs next to each other.
CliffKind kind_of(const Scene& scene, const Design& below, const Probe& from, const Design& above,
                  const Probe& to);

/// Bisects all stretches, side by side, until each has nothing between its ends; what lies beyond them that is
/// another cliff again becomes a stretch more. design_at(line, number) is the design there. found(stretch) is
/// called for each. stop() is asked now and then; true: it throws Stopped.
template <class DesignAt, class Found, class Stop>
void bisect(const Solver& solve, bool phases, std::vector<Stretch> stretches, const DesignAt& design_at,
            const Found& found, const Stop& stop) {
  std::vector<Design> designs;
  std::vector<Outcome> outcomes;
  const auto same = [&](const Outcome& a, const Outcome& b) { return discrete(a, phases) == discrete(b, phases); };
  struct Half {
    Stretch stretch;
    Probe end;  // of the whole; above.outcome may be another's by now
    double middle;
  };
  std::vector<Half> open;
  for (const Stretch& stretch : stretches) open.push_back({stretch, stretch.above, 0.0});
  while (!open.empty()) {
    stop();
    std::vector<Half> next;
    designs.clear();
    for (Half& half : open) {
      const auto& [line, below, above, resolution] = half.stretch;
      half.middle = below.at + 0.5 * (above.at - below.at);
      if (half.middle > below.at && half.middle < above.at && above.at - below.at > resolution) {
        designs.push_back(design_at(line, half.middle));
        next.push_back(half);
        continue;
      }
      found(half.stretch);
      // What follows is not what the line ends in: another cliff.
      if (!same(above.outcome, half.end.outcome)) {
        Half beyond{{line, above, half.end, resolution}, half.end, 0.0};
        beyond.middle = beyond.stretch.below.at + 0.5 * (half.end.at - beyond.stretch.below.at);
        if (!(beyond.middle > beyond.stretch.below.at && beyond.middle < half.end.at)) {
          found(beyond.stretch);
          continue;
        }
        designs.push_back(design_at(line, beyond.middle));
        next.push_back(beyond);
      }
    }
    outcomes.resize(designs.size());
    solve(designs, outcomes);
    for (std::size_t i = 0; i < next.size(); ++i) {
      Stretch& stretch = next[i].stretch;
      (same(outcomes[i], stretch.below.outcome) ? stretch.below : stretch.above) = Probe{next[i].middle,
                                                                                   outcomes[i]};
    }
    open = std::move(next);
  }
}

}  // namespace leapmap
