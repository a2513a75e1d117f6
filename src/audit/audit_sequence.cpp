// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "integrate/integration_options.hpp"
#include "model/model.hpp"
#include "request/request.hpp"

namespace leapmap {
namespace {

Solver solver_of(const Scene& scene, const std::string& method, double tolerance) {
  if (method == "exact")
    return need(model_of(scene), &Model::exact, "semi-analytic solver")(scene, tolerance, {});
  IntegrationOptions options = adaptive(method, tolerance);
  options.max_steps = most_steps(scene);
  return need(model_of(scene), &Model::integration, "integration in time")(scene, options);
}

}  // namespace

SequenceAuditor::SequenceAuditor(const Spec& spec, double allowed)
    : spec_(spec), scene_(scene_asked(request_of(spec))), allowed_(allowed) {
  if (scene_.jumps > 1) growth_ = std::make_unique<ErrorGrowth>(scene_, spec.numerics.tolerance);
}

/// The second method, for so many jumps.
AuditSolver SequenceAuditor::second(std::size_t jumps) const {
  Scene scene = scene_;
  scene.jumps = static_cast<long>(jumps);
  const std::string method = audit_method(spec_.numerics, spec_.scene);
  return {solver_of(scene, method, audit_tolerance), solver_of(scene, method, coarser_tolerance)};
}

/// The largest of those of times, relative, and of the others, relative to one more than their size. What a
/// sweep was not asked to store has none.
double SequenceAuditor::error_of(const Outcome& ours, const Outcome& theirs, std::size_t jump,
                                 bool stored_only) const {
  double most = 0.0;
  const std::size_t each = jump_fields().size() / static_cast<std::size_t>(most_jumps - 1);
  for (const Field& field : jump_fields().subspan((jump - 2) * each, each)) {
    const auto& later = std::get<OfJump>(field.source);
    if (field.of_wall || field.of_way) continue;
    if ((stored_only || field.by_default != ByDefault::stored) && !stores(spec_.output, field)) continue;
    const double x = later.number.of(ours), y = later.number.of(theirs);
    if (std::isnan(x) && std::isnan(y)) continue;
    const double size = (later.measure == Measure::time ? 0.0 : 1.0) + std::abs(y);
    most =
        std::max(most, std::isnan(x - y) ? std::numeric_limits<double>::infinity() : std::abs(x - y) / size);
  }
  return most;
}

std::size_t SequenceAuditor::sure_of(const AuditSolver& judge, const Design& design, const Outcome& theirs,
                                     std::span<const double> growth) const {
  std::size_t sure = theirs.jumps() + 1;
  for (const Outcome& beside : outcomes_beside(judge, design, spec_, true)) {
    if (beside.jumps() != theirs.jumps() || beside.sequence_end != theirs.sequence_end)
      sure = std::min({sure, beside.jumps(), theirs.jumps()});
    const std::size_t made = std::min({theirs.jumps(), beside.jumps(), growth.size()});
    for (std::size_t jump = 2; jump <= std::min(sure, made); ++jump)
      if (error_of(beside, theirs, jump, false) > allowed_ * growth[jump - 1]) sure = jump - 1;
  }
  return sure;
}

void SequenceAuditor::look_at(std::size_t number, const Design& design, const Outcome& ours,
                              AuditReport& report) const {
  if (!growth_ || ours.status != Status::jumped) return;
  const std::size_t made = ours.jumps();
  std::vector<double> growth = growth_->along(design, made);
  const bool stops_short = growth.size() < made;  // exact makes no such jump: does the second method?
  const auto beyond = std::ranges::find_if(growth, [](double g) { return !(g <= audited_growth); });
  const bool can_tell_all = beyond == growth.end();
  growth.erase(beyond, growth.end());
  // The jumps that can be told and, if these are all, how they end.
  const bool whole = can_tell_all && !stops_short;
  const std::size_t told = whole ? std::min(made + 1, static_cast<std::size_t>(scene_.jumps))
                                 : growth.size() + (can_tell_all ? 1 : 0);
  std::size_t compared = 1;
  if (told > 1) {
    const AuditSolver judge = second(told);
    const Outcome theirs = solved(judge.solve, design);
    if (theirs.status != Status::jumped) return;  // which is told of the first jump
    const std::size_t mine = std::min(made, told), both = std::min({mine, theirs.jumps(), growth.size()});
    std::vector<double> errors(both + 1, 0.0);
    std::size_t first_wrong = both + 1;
    for (std::size_t jump = both; jump >= 2; --jump) {
      errors[jump] = error_of(ours, theirs, jump, true) / growth[jump - 1];
      if (errors[jump] > allowed_) first_wrong = jump;
    }
    const bool gave_up = theirs.sequence_end == Status::failed || ours.sequence_end == Status::failed;
    const bool same_end = theirs.jumps() == mine && (!whole || theirs.sequence_end == ours.sequence_end);
    const bool wrong = first_wrong <= both || !(same_end || gave_up);
    const std::size_t sure = wrong ? sure_of(judge, design, theirs, growth) : both + 1;
    compared = std::min(both, sure);
    for (std::size_t jump = 2; jump <= compared; ++jump)
      report.jump_max_error = std::max(report.jump_max_error, errors[jump]);
    if (wrong && first_wrong <= sure) {
      ++report.sequences_wrong;
      report.first_wrong_sequence = std::min(report.first_wrong_sequence.value_or(number), number);
    }
  }
  compared = std::max<std::size_t>(compared, 1);
  report.jumps_compared += compared - 1;
  report.jumps_beyond += made - compared;
}

}  // namespace leapmap
