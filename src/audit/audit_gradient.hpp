// SPDX-License-Identifier: GPL-3.0-or-later
/// How right a sweep's derivatives are: some of a sample's again, by differences of the exact solver in long
/// double, which knows nothing of duals.
#pragma once

#include <cstddef>
#include <span>

#include "hoop/body.hpp"
#include "leapmap/audit.hpp"
#include "leapmap/spec.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

class GradientAuditor {
 public:
  /// Keeps a reference to spec.
  explicit GradientAuditor(const Spec& spec);

  /// Compares the derivatives by some parameters, which the design's number picks: by all of them in a small
  /// audit, by one in a large one. gradient: those of all quantities, each by all parameters that the spec
  /// asks for. A design that has another outcome nearby, whichever parameter moves, is undecided.
  void look_at(std::size_t number, const Design& design, const Outcome& ours,
               std::span<const double> gradient, AuditReport& report) const;

 private:
  const Spec& spec_;
  GradientWanted wanted_;
  std::vector<SameInSi> held_;
  Solver follow_up_;
  std::size_t parameters_each_;  ///< compared of each design
  double rounding_;              ///< of what is stored, relative
};

}  // namespace leapmap
