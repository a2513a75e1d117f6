// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/recorded_way.hpp"

namespace leapmap {

Outcome recorded_way(CoulombSolver<double>& solver, Start start, const Design& design,
                     ContactState<double>& at, const Scene& scene, RecordedWay& recorded) {
  CoulombObserver observer;
  observer.phase = [&](Phase phase, const ContactState<double>& state, int direction) {
    recorded.phases.push_back({phase, state, direction, {}});
  };
  observer.lift_off = [&](const LiftOff<double>&, const Flight<double>& flight) {
    recorded.flights.push_back(flight);
  };
  observer.turn = [&](const ContactState<double>& state) {
    recorded.phases.back().turns.push_back(state.angle);
  };
  observer.end = [&](const ContactState<double>& state) { recorded.end = state; };
  return solver.solve(start, design, at, scene, observer, &recorded.slides);
}

}  // namespace leapmap
