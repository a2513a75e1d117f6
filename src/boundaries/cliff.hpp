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

/// Bisects all stretches, side by side, until each has nothing between its ends; what lies beyond them that
/// is another cliff again becomes a stretch more. Where the method gives up on a design between, it is not
/// asked again: what is found is from the last it could solve to there, or, where that is a sliver, to the
/// next. design_at(line, number) is the design there. found(stretch) is called for each, stop() now and then.
template <class DesignAt, class Found, class Stop>
void bisect(const Solver& solve, bool phases, const std::vector<Stretch>& stretches,
            const DesignAt& design_at, const Found& found, const Stop& stop) {
  constexpr double sliver = 1e-9;  // of a stretch
  const auto same = [&](const Probe& a, const Probe& b) {
    return discrete(a.outcome, phases) == discrete(b.outcome, phases);
  };
  const auto failed = [](const Probe& probe) { return probe.outcome.status == Status::failed; };
  struct Open {
    Stretch stretch;
    Probe end;  // of the whole; above.outcome may be another's by now
    double width;
  };
  std::vector<Open> open, asked;
  for (const Stretch& whole : stretches) {
    if (failed(whole.below) || failed(whole.above))
      found(whole);
    else
      open.push_back({whole, whole.above, whole.above.at - whole.below.at});
  }
  std::vector<Design> designs;
  std::vector<Outcome> outcomes;
  while (!open.empty()) {
    stop();
    asked.clear(), designs.clear();
    for (std::size_t i = 0; i < open.size(); ++i) {  // it may grow
      const auto [stretch, end, width] = open[i];
      const auto& [line, below, above, resolution] = stretch;
      const double middle = below.at + 0.5 * (above.at - below.at);
      if (middle > below.at && middle < above.at && above.at - below.at > resolution) {
        designs.push_back(design_at(line, middle));
        asked.push_back(open[i]);
        continue;
      }
      found(stretch);
      // What follows is not what the line ends in: another cliff.
      if (!same(above, end)) open.push_back({{line, above, end, resolution}, end, width});
    }
    outcomes.resize(designs.size());
    solve(designs, outcomes);
    open.clear();
    for (std::size_t i = 0; i < asked.size(); ++i) {
      Stretch& stretch = asked[i].stretch;
      const Probe middle{stretch.below.at + 0.5 * (stretch.above.at - stretch.below.at), outcomes[i]};
      if (failed(middle)) {
        if (stretch.above.at - stretch.below.at > sliver * asked[i].width) stretch.above = middle;
        found(stretch);
        continue;
      }
      (same(middle, stretch.below) ? stretch.below : stretch.above) = middle;
      open.push_back(asked[i]);
    }
  }
}

}  // namespace leapmap
