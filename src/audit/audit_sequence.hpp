// SPDX-License-Identifier: GPL-3.0-or-later
/// How right a sweep's later jumps are: as many of them again as the condition allows.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "audit/audit_solver.hpp"
#include "gaits/error_growth.hpp"
#include "leapmap/audit.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

class SequenceAuditor {
 public:
  /// Keeps a reference to spec. allowed: the error that the first jump is allowed.
  SequenceAuditor(const Spec& spec, double allowed);

  /// Looks at the jumps after the first by the method that audits first jumps. Errors may have grown as much
  /// as derivatives from landing to landing tell (gaits/error_growth.hpp). Jumps are beyond it where they
  /// have grown by more than audited_growth, where the second method gives up, and from where its own answers
  /// part that begin a hair away.
  void look_at(std::size_t number, const Design& design, const Outcome& ours, AuditReport& report) const;

 private:
  double error_of(const Outcome& ours, const Outcome& theirs, std::size_t jump, bool stored_only) const;
  /// How many of its jumps the second method is sure of, to errors that have grown as told; one more if also
  /// of how they end.
  std::size_t sure_of(const AuditSolver& judge, const Design& design, const Outcome& theirs,
                      std::span<const double> growth) const;
  AuditSolver second(std::size_t jumps) const;

  const Spec& spec_;
  Scene scene_;
  std::unique_ptr<ErrorGrowth> growth_;  // none: nothing is asked for but the first jump
  double allowed_;
};

}  // namespace leapmap
