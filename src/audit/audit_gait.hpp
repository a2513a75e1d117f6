// SPDX-License-Identifier: GPL-3.0-or-later
/// How right a sweep's gaits are: whether each of them is one.
#pragma once

#include <cstddef>
#include <memory>

#include "leapmap/audit.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

class GaitAuditor {
 public:
  /// Keeps a reference to spec. allowed: the error that the first jump is allowed.
  GaitAuditor(const Spec& spec, double allowed);
  ~GaitAuditor();
  GaitAuditor(GaitAuditor&&) noexcept;

  /// Goes once round a design's gait by integration, from the landing where the exact solver begins it:
  /// whether it is back there, with the heights, the speed and the loss that are stored; and has the
  /// multiplier by differences of integrations. Whether the release leads there is not asked: on its way it
  /// forgets where it came from.
  void look_at(std::size_t number, const Design& design, const Outcome& ours, AuditReport& report) const;

 private:
  struct Work;
  enum class Verdict { right, wrong, undecided };
  Verdict verdict_on(const Design& design, const Outcome& ours, AuditReport& report) const;

  const Spec& spec_;
  std::unique_ptr<Work> work_;  // none: the scene asks for no gaits
  double allowed_;
};

}  // namespace leapmap
