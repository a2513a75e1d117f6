// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sweep/audit.hpp"
#include "sweep/solver.hpp"

namespace leapmap {
namespace {

constexpr double audit_tolerance = 1e-13, coarser_tolerance = 1e-12;
/// Beyond which an integration's own error, 1e-11, leaves fewer than six digits.
constexpr double audited_growth = 1e5;

}  // namespace

SequenceAuditor::SequenceAuditor(const Spec& spec, double allowed) : spec_(spec), allowed_(allowed) {
  if (spec.scene.jumps == 1) return;
  Spec jumps = spec;
  jumps.scene.settle = 0;
  const std::string method = audit_method(spec.numerics);
  second_ = {make_solver(jumps, method, audit_tolerance), make_solver(jumps, method, coarser_tolerance)};
  growth_ = std::make_unique<ErrorGrowth>(spec.scene, spec.numerics.tolerance);
}

/// The larger of height's, relative to one more than its size, and time's, relative. What a sweep was not
/// asked to store has none.
double SequenceAuditor::error_of(const Outcome& ours, const Outcome& theirs, std::size_t jump,
                                 bool stored_only) const {
  const Jump &a = ours.later_jumps[jump - 2], &b = theirs.later_jumps[jump - 2];
  const auto error = [&](const char* field, double x, double y, double size) {
    if (stored_only && !stores(spec_.output, field + std::to_string(jump))) return 0.0;
    return std::isnan(x) && std::isnan(y) ? 0.0
           : std::isnan(x - y)            ? std::numeric_limits<double>::infinity()
                                          : std::abs(x - y) / size;
  };
  return std::max(error("jump_height_", a.height, b.height, 1.0 + std::abs(b.height)),
                  error("jump_time_", a.time, b.time, std::abs(b.time)));
}

std::size_t SequenceAuditor::sure_of(const Design& design, const Outcome& theirs,
                                     std::span<const double> growth) const {
  std::size_t sure = theirs.jumps() + 1;
  for (const Outcome& beside : outcomes_beside(second_, design, spec_, true)) {
    if (beside.jumps() != theirs.jumps() || beside.sequence_end != theirs.sequence_end)
      sure = std::min({sure, beside.jumps(), theirs.jumps()});
    for (std::size_t jump = 2; jump <= std::min(sure, growth.size()); ++jump)
      if (error_of(beside, theirs, jump, false) > allowed_ * growth[jump - 1]) sure = jump - 1;
  }
  return sure;
}

void SequenceAuditor::look_at(std::size_t number, const Design& design, const Outcome& ours,
                              AuditReport& report) const {
  if (!growth_ || ours.status != Status::jumped) return;
  const Outcome theirs = solved(second_.solve, design);
  if (theirs.status != Status::jumped) return;  // which is told of the first jump
  const std::size_t both = std::min(ours.jumps(), theirs.jumps());
  std::vector<double> growth = growth_->along(design, both);
  growth.erase(std::ranges::find_if(growth, [](double g) { return !(g <= audited_growth); }), growth.end());
  // The jumps that can be told, and the one after the last: whether there is one.
  std::size_t sure = growth.size() < both ? growth.size() : both + 1;

  std::vector<double> errors(both + 1, 0.0);
  std::size_t first_wrong = both + 1;
  for (std::size_t jump = std::min(sure, both); jump >= 2; --jump) {
    errors[jump] = error_of(ours, theirs, jump, true) / growth[jump - 1];
    if (errors[jump] > allowed_) first_wrong = jump;
  }
  const bool same =
      first_wrong > both && ours.jumps() == theirs.jumps() && ours.sequence_end == theirs.sequence_end;
  if (!same && first_wrong <= sure) sure = std::min(sure, sure_of(design, theirs, growth));
  const std::size_t compared = std::min(both, sure);
  for (std::size_t jump = 2; jump <= compared; ++jump)
    report.jump_max_error = std::max(report.jump_max_error, errors[jump]);
  if (compared > 1) report.jumps_compared += compared - 1;
  report.jumps_beyond += both - std::max<std::size_t>(compared, 1);
  if (same || first_wrong > sure) return;
  ++report.sequences_wrong;
  report.first_wrong_sequence = std::min(report.first_wrong_sequence.value_or(number), number);
}

}  // namespace leapmap
