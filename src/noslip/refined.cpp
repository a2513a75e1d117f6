// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/exact.hpp"
#include "noslip/model.hpp"

namespace leapmap::noslip {

Outcome refined(const Design& design, const Scene& scene) {
  Outcome outcome;
  ExactSolver<long double> solver(1e-18);
  Sequences<long double>([&](Start start, std::span<const Design> designs,
                             std::span<ContactState<long double>> states, std::span<Outcome> outcomes) {
    solver.solve(start, designs, states, scene, outcomes);
  }).solve({&design, 1}, scene, {&outcome, 1});
  return outcome;
}

}  // namespace leapmap::noslip
