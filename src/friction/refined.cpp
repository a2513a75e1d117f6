// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/coulomb.hpp"
#include "friction/model.hpp"

namespace leapmap::friction {

Outcome refined(const Design& design, const Scene& scene) {
  Outcome outcome;
  const auto solver = std::make_shared<CoulombSolver<long double>>(1e-15);
  Sequences<long double>(jumps_one_by_one<long double>(solver, scene))
      .solve({&design, 1}, scene, {&outcome, 1});
  return outcome;
}

}  // namespace leapmap::friction
