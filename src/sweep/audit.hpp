// SPDX-License-Identifier: GPL-3.0-or-later
/// How accurate this very sweep is: a random share of its designs solved again by an independent method.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "sweep/spec.hpp"

namespace leapmap {

/// What the two methods disagree on.
struct AuditReport {
  std::size_t designs = 0;
  std::string method;                 ///< of the audit
  double max_abs_height_error = 0.0;  ///< [hoop diameters], where both methods see the same jump
  double max_rel_time_error = 0.0;
  std::size_t flag_mismatches = 0;  ///< designs whose status, spurious flag or number of candidates differ
  std::optional<std::size_t> first_mismatch;  ///< the least design number among them
};

/// The method that audits another, and its options: as far from it as GSL offers, at a tight tolerance.
struct AuditMethod {
  std::string name;
  IntegrationOptions options;
};
AuditMethod audit_method(const Numerics& numerics);

/// Solves ceil(numerics.audit * designs) designs by both methods; which ones depends on the spec alone.
/// Both methods are deterministic, so that the first gives again what the sweep stored.
/// stop_requested is asked after each design; once true, the report covers what was done until then.
AuditReport audit(const Spec& spec, int threads, const std::function<bool()>& stop_requested = {});

}  // namespace leapmap
