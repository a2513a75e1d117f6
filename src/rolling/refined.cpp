// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/exact.hpp"
#include "rolling/model.hpp"

namespace leapmap::rolling {

Outcome refined(const Design& design, const Scene& scene) {
  Outcome outcome;
  ExactSolver<long double>(1e-18).solve({&design, 1}, scene, {&outcome, 1});
  return outcome;
}

}  // namespace leapmap::rolling
