// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "spec/options.hpp"

namespace leapmap {
namespace {

constexpr double audit_reach =
    1e-11;  // relative: how far off an integration at that tolerance may see a flag flip

/// The design with each parameter some relative distance away, either way; 0: one unit in the last place.
std::vector<Design> beside(const Design& design, const Spec& spec, double distance) {
  std::vector<Design> designs;
  for (const Option* parameter : design_parameters(spec)) {
    const auto member = member_of(*parameter);
    const double value = design.*member;
    if (value == 0.0) continue;  // as written, and the number beside it is no rounding of it
    for (const double way : {-1.0, 1.0}) {
      Design nudged = design;
      nudged.*member =
          distance > 0.0 ? value * (1.0 + way * distance) : std::nextafter(value, way * HUGE_VAL);
      if (in_range(*parameter, nudged.*member)) designs.push_back(nudged);
    }
  }
  return designs;
}

}  // namespace

Outcome solved(const Solver& solve, const Design& design) {
  Outcome outcome;
  solve({&design, 1}, {&outcome, 1});
  return outcome;
}

std::vector<Outcome> outcomes_beside(const AuditSolver& judge, const Design& design, const Spec& spec,
                                     bool farther) {
  std::vector<Design> designs = beside(design, spec, 0.0);
  if (farther) std::ranges::copy(beside(design, spec, audit_reach), std::back_inserter(designs));
  std::vector<Outcome> outcomes(designs.size());
  judge.solve(designs, outcomes);
  outcomes.push_back(solved(judge.coarser, design));
  return outcomes;
}

}  // namespace leapmap
