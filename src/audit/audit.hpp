// SPDX-License-Identifier: GPL-3.0-or-later
/// How accurate this very sweep is: a random share of its outcomes, on their way to the map, solved again by
/// an independent method.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "audit/audit_gait.hpp"
#include "audit/audit_gradient.hpp"
#include "audit/audit_report.hpp"
#include "audit/audit_samples.hpp"
#include "audit/audit_sequence.hpp"
#include "audit/audit_solver.hpp"
#include "spec/designs.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// How far two outcomes are apart.
struct AuditDifference {
  bool flags = false;
  double height = 0.0, time = 0.0, motion = 0.0;
};

/// The method that audits another: exact audits integration, integration by gsl-rk8pd at 1e-13 audits exact;
/// of a model that is integrated gsl-rkck audits gsl-rk8pd, and gsl-rk8pd any other stepper.
std::string audit_method(const Numerics& numerics, const Scene& scene);

/// What the spec's audit compares with: that method, or "proof".
std::string auditor_of(const Numerics& numerics, const Scene& scene);

/// A report on no design yet.
AuditReport begin_audit(const Spec& spec);

/// Solves samples again, one after the other, and compares. One a thread.
class Auditor {
 public:
  /// Keeps a reference to spec. The referee sees one design in so many; 0: one in ten, but of large audits no
  /// more than some two hundred, and all of one of thirty or fewer.
  explicit Auditor(const Spec& spec, std::size_t referee_every = 0);
  /// Adds what a sample comes to. An error is beyond the tolerance if it is larger than numerics.tolerance (a
  /// hundred times that for an adaptive stepper, whose tolerance is per step; no less than 1e-11, the audit's
  /// own error), and larger than 10 times what one unit in the last place of the inputs, or a coarser
  /// tolerance, makes of the second method's own answer. A map in f4 is allowed a rounding of f4 on top.
  void look_at(const AuditSample& sample, AuditReport& report) const;

 private:
  struct Verdict {
    bool undecided = false, wrong_flags = false, inaccurate = false;
    AuditDifference difference;

    bool convicts() const { return !undecided && (wrong_flags || inaccurate); }
  };
  /// output: whose fields are compared.
  Verdict verdict_of(const AuditSolver& judge, const Design& design, const Outcome& ours,
                     const Output& output) const;
  Verdict verdict_among(const Outcome& ours, const std::vector<Outcome>& beside) const;
  bool exceeds(const AuditDifference& d, const AuditDifference& doubt, const Outcome& ours) const;

  const Spec& spec_;
  DesignSpace space_;
  AuditSolver second_, referee_;
  Output proved_;  ///< the fields that proofs compare
  GradientAuditor gradients_;
  SequenceAuditor sequences_;
  GaitAuditor gaits_;
  std::size_t referee_every_;
  double allowed_;
};

/// Looks at all samples on all threads. stop_requested is asked after each design; once true, the report
/// covers what was done until then.
AuditReport audit(const Spec& spec, std::span<const AuditSample> samples, int threads,
                  const std::function<bool()>& stop_requested = {}, std::size_t referee_every = 0);

}  // namespace leapmap
