// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/judged_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "audit/audit.hpp"
#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "proof/cells.hpp"
#include "request/solver.hpp"

namespace leapmap {
namespace {

/// What a map stores of a design that is not what is proved of it; empty: nothing.
/// second: the unit of its times.
std::string wrong_number(const Outcome& stored, const Proof& proof, double allowed, double second) {
  if (stored.status != proof.status)
    return fmt::format("status {} where {} is proved", name_of(stored.status), name_of(proof.status));
  if (stored.spurious_first_jump != proof.spurious_first_jump)
    return fmt::format("spurious_first_jump {} where {} is proved", stored.spurious_first_jump,
                       proof.spurious_first_jump);
  if (const long most = Outcome::most_candidates; stored.candidates != std::min(proof.lift_offs, most))
    return fmt::format("{} lift-offs where {} are proved", stored.candidates, proof.lift_offs);
  const auto outside = [](std::string_view name, double value, const Enclosure& within,
                          double slack) -> std::string {
    if (std::isnan(value) && std::isnan(within.low)) return {};
    if (value >= within.low - slack && value <= within.high + slack) return {};
    return fmt::format("{} {} outside the proved [{}, {}]", name, value, within.low, within.high);
  };
  const auto height = [&](std::string_view name, double value, const Enclosure& within) {
    return outside(name, value, within, allowed * (1.0 + std::abs(value)));
  };
  const auto time = [&](std::string_view name, double value, const Enclosure& within) {
    constexpr double rounding = 1e-15;  // of a lift-off at the release, in units of the time
    return std::isnan(within.low) ? std::string()
                                  : outside(name, value, within, allowed * value + rounding * second);
  };
  std::string wrong = height("jump_height", stored.jump_height, proof.height);
  if (wrong.empty()) wrong = height("first_jump_height", stored.first_jump_height, proof.first_height);
  if (wrong.empty()) wrong = time("jump_time", stored.jump_time, proof.time);
  if (wrong.empty()) wrong = time("first_jump_time", stored.first_jump_time, proof.first_time);
  return wrong;
}

void note(const Spec& spec, const AuditSample& sample, const Design& design, const Proof& proof,
          double allowed, JudgedMap& judged) {
  constexpr std::size_t most_told = 20;
  ++judged.looked_at;
  if (sample.outcome.status == Status::failed) {
    ++judged.failed;
    return;
  }
  if (!proof.proved) {
    ++judged.undecided[proof.open];
    return;
  }
  ++judged.proved;
  if (!std::isnan(proof.height.low))
    judged.widest_height = std::max(judged.widest_height, proof.height.high - proof.height.low);
  if (proof.time.low > 0.0)
    judged.widest_time = std::max(judged.widest_time, (proof.time.high - proof.time.low) / proof.time.low);
  const std::string wrong =
      wrong_number(sample.outcome, proof, allowed, time_unit(spec.scene) * std::sqrt(design.size));
  if (wrong.empty()) return;
  if (!prove(within_rounding(design), spec.scene).proved) {
    --judged.proved, ++judged.undecided["an event within rounding"];
    return;
  }
  if (++judged.wrong <= most_told)
    judged.findings.push_back(
        fmt::format("design {}: {}; {}", sample.number, wrong, hop_command(spec, design)));
}

}  // namespace

JudgedMap judge_map(const MapReader& map, const Spec& spec, const JudgeOptions& options) {
  const Cells cells(spec);
  const DesignSpace space(spec);
  const Tiling tiling = map.blocks("status");
  Request request = request_of(spec);  // what the map does not store is the solver's
  for (const std::string_view name : {"status", "spurious_first_jump", "candidates", "jump_height",
                                      "jump_time", "first_jump_height", "first_jump_time"})
    add_column(request.columns, find_field(name));
  const Solver solver = make_solver(request);
  const double allowed = begin_audit(spec).allowed_error;
  const auto total =
      static_cast<std::size_t>(std::ceil(options.share * static_cast<double>(tiling.designs())));
  JudgedMap judged;
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const std::vector<AuditSample> samples =
        audit_samples(map, spec, options.share, tiling, tiling.tile(t), solver);
    std::vector<Proof> proofs(samples.size());
    std::vector<std::uint8_t> is_done(samples.size());
    try {
      parallel_for_each(samples.size(), options.threads, options.stop_requested, [&] {
        return [&](std::size_t i) {
          if (options.stop_requested && options.stop_requested()) return false;
          proofs[i] = prove(space.at(samples[i].number), spec.scene);
          is_done[i] = 1;
          return true;
        };
      });
    } catch (const Stopped&) {  // inside a proof that takes long
    }
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (is_done[i]) note(spec, samples[i], space.at(samples[i].number), proofs[i], allowed, judged);
    if (options.progress) options.progress(judged.looked_at, total);
    if (options.stop_requested && options.stop_requested()) break;
  }
  return judged;
}

}  // namespace leapmap
