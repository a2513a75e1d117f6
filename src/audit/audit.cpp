// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>

#include "engine/map_layout.hpp"
#include "engine/parallel.hpp"
#include "hoop/units.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/prove.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "numerics/mixed.hpp"
#include "referee/referee.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

constexpr std::size_t usual_referee_every = 10;
constexpr double most_refereed = 200;  // designs that the referee judges of a large audit, about
constexpr double own_error = 1e-11;    // an integration's at that tolerance, over a few revolutions
constexpr double adaptive_slack = 100.0;

using Difference = AuditDifference;

Difference larger(const Difference& a, const Difference& b, double weight) {
  return {a.flags || b.flags, std::max(a.height, weight * b.height), std::max(a.time, weight * b.time),
          std::max(a.motion, weight * b.motion)};
}

/// `ours` may lack what its sweep was not asked to store.
Difference difference(const Outcome& ours, const Outcome& theirs, const Output& output = {}) {
  Difference d;
  d.flags = !same_flags(ours, theirs);
  if (d.flags) return d;
  for (const Field& field : map_fields()) {
    const auto* quantity = std::get_if<Quantity>(&field.source);
    if (!quantity || field.of_sequence || field.of_gait) continue;  // judged elsewhere
    // A sweep need not compute what its map does not hold.
    if (field.by_default != ByDefault::stored && !stores(output, field)) continue;
    const double a = ours.*quantity->member, b = theirs.*quantity->member;
    if (std::isnan(a) && std::isnan(b)) continue;
    // After as many phases as a sequence holds, only some methods see that a hoop rocks to rest.
    const bool is_left_open = quantity->member == &Outcome::slip_distance && ours.status == Status::stalled &&
                              ours.phase_sequence >> 62 != 0;
    if (is_left_open && (std::isnan(a) || std::isnan(b))) continue;
    const Measure measure = quantity->measure;
    double& most = measure == Measure::height ? d.height : measure == Measure::time ? d.time : d.motion;
    double error = std::abs(a - b);
    if (measure == Measure::time && b != 0.0) error = std::abs(a / b - 1.0);
    if (measure == Measure::other) error /= 1.0 + std::abs(b);
    if (!std::isnan(error)) {
      most = std::max(most, error);
    } else if (stores(output, field)) {
      most = std::numeric_limits<double>::infinity();
    }
  }
  return d;
}

}  // namespace

std::string audit_method(const Numerics& numerics, const Scene& scene) {
  constexpr std::string_view first = "gsl-rk8pd", other = "gsl-rkck";
  const std::string method = resolved_method(numerics, scene);
  if (method != "exact" && model_of(scene).stepper.empty()) return "exact";
  return std::string(method == first ? other : first);
}

std::string auditor_of(const Numerics& numerics, const Scene& scene) {
  return numerics.audit_by == "proof" ? numerics.audit_by : audit_method(numerics, scene);
}

AuditReport begin_audit(const Spec& spec) {
  AuditReport report;
  report.method = auditor_of(spec.numerics, spec.scene);
  const double rounding = spec.output.precision == "f4" ? std::numeric_limits<float>::epsilon() : 0.0;
  const double slack = resolved_method(spec) == "exact" ? 1.0 : adaptive_slack;
  report.allowed_error = std::max(spec.numerics.tolerance * slack, own_error) + rounding;
  return report;
}

namespace {

/// The middles of what is proved; what is not proved has failed.
Solver solver_by_proof(const Spec& spec) {
  const auto middle = [](const Enclosure& within) { return within.low + 0.5 * (within.high - within.low); };
  return [scene = spec.scene, middle](std::span<const Design> designs, std::span<Outcome> outcomes) {
    std::ranges::transform(designs, outcomes.begin(), [&](const Design& design) {
      const Proof proof = prove(design, scene);
      Outcome outcome;
      outcome.status = proof.proved ? proof.status : Status::failed;
      outcome.spurious_first_jump = proof.spurious_first_jump;
      outcome.candidates =
          static_cast<std::uint8_t>(std::clamp(proof.lift_offs, 0L, long{Outcome::most_candidates}));
      outcome.jump_height = middle(proof.height), outcome.jump_time = middle(proof.time);
      outcome.first_jump_height = middle(proof.first_height);
      outcome.first_jump_time = middle(proof.first_time);
      return outcome;
    });
  };
}

bool stores_way(const Spec& spec) {
  return std::ranges::any_of(map_fields(),
                             [&](const Field& field) { return field.of_way && stores(spec.output, field); });
}

/// The first jump of the spec's designs by the method that audits; its way, too, if the map stores that.
Solver second_solver(const Spec& spec, double tolerance) {
  if (spec.numerics.audit_by == "proof") return solver_by_proof(spec);
  Request request{.scene = spec.scene,
                  .numerics = {.method = audit_method(spec.numerics, spec.scene), .tolerance = tolerance}};
  request.scene.jumps = 1, request.scene.settle = 0;
  request.columns = fields_of(request.scene);
  if (!stores_way(spec)) std::erase_if(request.columns, [](const Field* field) { return field->of_way; });
  return make_solver(request);
}

Solver solver_by_referee(const Spec& spec, double tolerance) {
  const auto referee = std::make_shared<referee::Referee>(spec.scene, tolerance);
  referee->meets_forces = stores_way(spec);
  return [referee](std::span<const Design> designs, std::span<Outcome> outcomes) {
    std::ranges::transform(designs, outcomes.begin(), [&](const Design& d) { return referee->solve(d); });
    resize(designs, outcomes);
  };
}

/// Made when it is first asked: most audits ask no coarser one.
Solver made_late(std::function<Solver()> make) {
  return [make = std::move(make), solve = Solver()](std::span<const Design> designs,
                                                    std::span<Outcome> outcomes) mutable {
    if (!solve) solve = make();
    solve(designs, outcomes);
  };
}

}  // namespace

Auditor::Auditor(const Spec& spec, std::size_t referee_every)
    : spec_(spec),
      space_(spec),
      second_{second_solver(spec, audit_tolerance),
              made_late([&spec] { return second_solver(spec, coarser_tolerance); })},
      referee_{made_late([&spec] { return solver_by_referee(spec, audit_tolerance); }),
               made_late([&spec] { return solver_by_referee(spec, coarser_tolerance); })},
      gradients_(spec),
      sequences_(spec, begin_audit(spec).allowed_error),
      gaits_(spec, begin_audit(spec).allowed_error),
      referee_every_(referee_every),
      allowed_(begin_audit(spec).allowed_error) {
  proved_.fields = {"jump_height", "jump_time", "first_jump_height", "first_jump_time"};
  if (referee_every == 0) {
    const double audited = spec.numerics.audit * static_cast<double>(designs_of(shape_of(spec)));
    const auto large = static_cast<std::size_t>(audited / most_refereed);
    referee_every_ = audited <= 3.0 * usual_referee_every ? 1 : std::max(usual_referee_every, large);
  }
}

auto Auditor::verdict_of(const AuditSolver& judge, const Design& design, const Outcome& ours,
                         const Output& output) const -> Verdict {
  const Outcome theirs = solved(judge.solve, design);
  Verdict verdict;
  verdict.difference = difference(ours, theirs, output);
  verdict.undecided = theirs.status == Status::failed;
  if (verdict.undecided) return verdict;
  verdict.wrong_flags = verdict.difference.flags;
  verdict.inaccurate = !verdict.wrong_flags && exceeds(verdict.difference, {}, ours);
  if (!verdict.wrong_flags && !verdict.inaccurate) return verdict;

  std::vector<Outcome> beside = outcomes_beside(judge, design, spec_, verdict.wrong_flags);
  if (std::ranges::all_of(beside, [&](const Outcome& o) { return same_flags(o, theirs); })) {
    Difference doubt;
    for (const Outcome& outcome : beside) doubt = larger(doubt, difference(outcome, theirs), 10.0);
    verdict.inaccurate = verdict.inaccurate && exceeds(verdict.difference, doubt, ours);
    return verdict;
  }
  beside.push_back(theirs);
  std::erase_if(beside, [](const Outcome& o) { return o.status == Status::failed; });
  return verdict_among(ours, beside);
}

/// A judge whose answers nearby differ cannot decide. What it is asked about is wrong all the same if it is
/// like none of them; not where bounces make every answer its own, and as to numbers only if it is far off,
/// as they may go with the root of the distance from a cliff.
auto Auditor::verdict_among(const Outcome& ours, const std::vector<Outcome>& beside) const -> Verdict {
  constexpr std::size_t most_kinds = 3, least_of_a_kind = 2, least_like = 3;
  constexpr Difference far_off{false, 1e-4, 1e-4, 1e-4};
  Verdict verdict;
  std::vector<std::pair<const Outcome*, std::size_t>> kinds;
  for (const Outcome& outcome : beside) {
    const auto kind =
        std::ranges::find_if(kinds, [&](const auto& k) { return same_flags(*k.first, outcome); });
    if (kind == kinds.end())
      kinds.emplace_back(&outcome, 1);
    else
      ++kind->second;
  }
  const bool few_kinds = kinds.size() <= most_kinds && std::ranges::all_of(kinds, [](const auto& k) {
                           return k.second >= least_of_a_kind;
                         });
  std::vector<Outcome> like;
  std::ranges::copy_if(beside, std::back_inserter(like),
                       [&](const Outcome& o) { return same_flags(o, ours); });
  verdict.wrong_flags = like.empty() && few_kinds;
  if (like.size() >= least_like) {
    Difference spread = far_off;
    bool is_like_one = false;
    for (const Outcome& outcome : like) spread = larger(spread, difference(outcome, like.front()), 10.0);
    for (const Outcome& outcome : like) {
      verdict.difference = difference(ours, outcome, spec_.output);
      is_like_one = is_like_one || !exceeds(verdict.difference, spread, ours);
    }
    verdict.inaccurate = !is_like_one;
  }
  verdict.undecided = !verdict.wrong_flags && !verdict.inaccurate;
  return verdict;
}

/// Whether a difference is more than is allowed, and more than a judge's doubt.
bool Auditor::exceeds(const AuditDifference& d, const AuditDifference& doubt, const Outcome& ours) const {
  const double height_allowed = allowed_ * (std::isnan(ours.jump_height) ? 1.0 : 1.0 + ours.jump_height);
  return d.height > std::max(height_allowed, doubt.height) || d.time > std::max(allowed_, doubt.time) ||
         d.motion > std::max(allowed_, doubt.motion);
}

void Auditor::look_at(const AuditSample& sample, AuditReport& report) const {
  const std::size_t number = sample.number;
  const Outcome& ours = sample.outcome;
  ++report.designs;
  if (ours.status == Status::failed) {
    ++report.failed;
    return;
  }
  const Design design = space_.at(number);
  sequences_.look_at(number, design, ours, report);
  gaits_.look_at(number, design, ours, report);
  if (!sample.gradient.empty()) gradients_.look_at(number, design, ours, sample.gradient, report);
  const bool by_proof = spec_.numerics.audit_by == "proof";
  Verdict verdict = verdict_of(second_, design, ours, by_proof ? proved_ : spec_.output);
  std::optional<Verdict> ruling;
  // Where an integration convicts exact, the referee is asked for its opinion.
  const bool second_opinion = verdict.convicts() && resolved_method(spec_) == "exact";
  if (mixed(number) % referee_every_ == 0 || second_opinion)
    ruling = verdict_of(referee_, design, ours, spec_.output);
  const bool acquitted = ruling && !ruling->undecided && !ruling->convicts();
  if (verdict.convicts() && acquitted) verdict.undecided = true;
  // Of flags two of three decide. Numbers may be wrong by a formula that the second method shares.
  if (ruling && ruling->wrong_flags && !verdict.undecided && !verdict.convicts()) ruling->undecided = true;

  const auto note_first = [&](std::optional<std::size_t>& first) {
    first = std::min(first.value_or(number), number);
  };
  if (verdict.undecided) {
    ++report.undecided;
  } else if (verdict.wrong_flags) {
    ++report.flag_mismatches;
    note_first(report.first_mismatch);
  } else {
    report.max_abs_height_error = std::max(report.max_abs_height_error, verdict.difference.height);
    report.max_rel_time_error = std::max(report.max_rel_time_error, verdict.difference.time);
    report.max_rel_motion_error = std::max(report.max_rel_motion_error, verdict.difference.motion);
    if (verdict.inaccurate) ++report.beyond_tolerance, note_first(report.first_inaccurate);
  }
  if (!ruling) return;
  ++report.refereed;
  if (ruling->undecided) {
    ++report.referee_undecided;
    return;
  }
  if (ruling->convicts()) ++report.overruled, note_first(report.first_overruled);
  if (!ruling->wrong_flags)
    report.referee_max_error = std::max({report.referee_max_error, ruling->difference.height,
                                         ruling->difference.time, ruling->difference.motion});
}

AuditReport audit(const Spec& spec, std::span<const AuditSample> samples, int threads,
                  const std::function<bool()>& stop_requested, std::size_t referee_every) {
  AuditReport report = begin_audit(spec);
  std::mutex reporting;
  parallel_for_each(samples.size(), threads, stop_requested, [&] {
    return [&, auditor = Auditor(spec, referee_every)](std::size_t i) {
      AuditReport one;
      try {
        auditor.look_at(samples[i], one);
      } catch (const Stopped&) {
        return false;
      }
      const std::lock_guard lock(reporting);
      merge(report, one);
      return !(stop_requested && stop_requested());
    };
  });
  return report;
}

}  // namespace leapmap
