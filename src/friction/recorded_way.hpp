// SPDX-License-Identifier: GPL-3.0-or-later
/// The phases of one design as the exact solver goes through them, for who goes the same way again.
#pragma once

#include <vector>

#include "friction/coulomb.hpp"

namespace leapmap {

struct RecordedWay {
  struct Begun {
    Phase phase;
    ContactState<double> at;
    int direction;
    std::vector<double> turns;  ///< angles where it turns round, rolling
  };
  std::vector<Begun> phases;
  std::vector<Flight<double>> flights;
  std::vector<SlideTold<double>> slides;
  ContactState<double> end;
};

/// On the way to a jump from `at`, which is moved to just after its landing.
Outcome recorded_way(CoulombSolver<double>& solver, Start start, const Design& design,
                     ContactState<double>& at, const Scene& scene, RecordedWay& recorded);

}  // namespace leapmap
