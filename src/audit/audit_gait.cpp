// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit_gait.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "audit/audit_solver.hpp"
#include "gaits/error_growth.hpp"
#include "gaits/return_map.hpp"
#include "gaits/settle.hpp"
#include "integrate/integration_options.hpp"
#include "model/model.hpp"

namespace leapmap {
namespace {

/// Of a multiplier by differences, and how far those of other steps may be from them.
constexpr double multiplier_allowed = 1e-6, multiplier_settled = 1e-5;
constexpr double map_step = 1e-5;  // [rad, sqrt(g/R)]

/// The return map's derivative at a landing by differences. False: it does not jump on from beside it.
bool differences(const JumpSolver<double>& jumps, const Design& design, const Landed& at, double by,
                 StateMatrix& slope) {
  slope.setZero();
  const std::array<double Landed::*, 4> numbers{&Landed::angle, &Landed::spin, &Landed::slip,
                                                &Landed::normal};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (k >= 2 && at.*numbers[k] == 0.0) continue;  // held there
    std::array<Landed, 2> ends{at, at};
    ends[0].*numbers[k] -= by, ends[1].*numbers[k] += by;
    for (Landed& end : ends) {
      Outcome outcome;
      jumps(Start::landing, {&design, 1}, {&end, 1}, {&outcome, 1});
      if (outcome.status != Status::jumped) return false;
    }
    slope.col(static_cast<int>(k)) = between(ends[0], ends[1]) / (2.0 * by);
  }
  return true;
}

}  // namespace

struct GaitAuditor::Work {
  GaitSolver gaits;
  ErrorGrowth growth;
  JumpSolver<double> second;

  explicit Work(const Spec& spec)
      : gaits(spec.scene, spec.numerics.tolerance),
        growth(spec.scene, spec.numerics.tolerance),
        second(model_of(spec.scene)
                   .integrated_jumps(each_jump_alone(spec.scene), adaptive("gsl-rk8pd", audit_tolerance))) {}

  /// Round an orbit, by differences so far apart; NaN: there are none.
  double multiplier(const Design& design, const Orbit& orbit, double by) const {
    StateMatrix round = StateMatrix::Identity(), slope;
    Landed from = orbit.landings.back();
    for (const Landed& to : orbit.landings) {
      if (!differences(second, design, from, by, slope)) return std::numeric_limits<double>::quiet_NaN();
      round = slope * round;
      from = to;
    }
    return largest_eigenvalue(round);
  }
};

GaitAuditor::GaitAuditor(const Spec& spec, double allowed) : spec_(spec), allowed_(allowed) {
  if (spec.scene.settle > 0) work_ = std::make_unique<Work>(spec);
}
GaitAuditor::~GaitAuditor() = default;
GaitAuditor::GaitAuditor(GaitAuditor&&) noexcept = default;

auto GaitAuditor::verdict_on(const Design& design, const Outcome& ours, AuditReport& report) const
    -> Verdict {
  const int period = ours.gait_period;
  Orbit orbit, seen;
  if (!work_->gaits.orbit_of(design, orbit) || orbit.jumps.size() != static_cast<std::size_t>(period))
    return Verdict::wrong;
  const Landed& start = orbit.landings.back();
  const std::vector<double> growth =
      work_->growth.along(design, Start::landing, start, static_cast<std::size_t>(period));
  if (growth.size() != static_cast<std::size_t>(period) || !(growth.back() <= audited_growth))
    return Verdict::undecided;
  if (!go_once_round(work_->second, each_jump_alone(spec_.scene), design, period, start, seen))
    return Verdict::wrong;
  double error = between(start, seen.landings.back()).lpNorm<Eigen::Infinity>();
  const auto compare = [&](double stored, double right) {
    if (!std::isnan(stored)) error = std::max(error, std::abs(stored - right) / (1.0 + std::abs(right)));
  };
  compare(ours.gait_height, seen.height);
  compare(ours.gait_speed, seen.speed * std::sqrt(design.size));
  compare(ours.gait_jump_time, seen.jump_time * std::sqrt(design.size));
  compare(ours.gait_energy_lost, seen.energy_lost);
  report.gait_max_error = std::max(report.gait_max_error, error);
  if (error > allowed_ * growth.back()) return Verdict::wrong;

  if (std::isnan(ours.gait_multiplier)) return Verdict::right;  // it is not stored
  // Of fourth order, by steps of one and two and by steps of two and four.
  const double near = work_->multiplier(design, orbit, map_step),
               far = work_->multiplier(design, orbit, 2.0 * map_step),
               farthest = work_->multiplier(design, orbit, 4.0 * map_step), right = (4.0 * near - far) / 3.0,
               coarser = (4.0 * far - farthest) / 3.0, size = 1.0 + std::abs(right),
               doubt = std::abs(right - coarser) / size;
  if (!(doubt <= multiplier_settled)) return Verdict::undecided;
  const double off = std::abs(ours.gait_multiplier - right) / size;
  report.multiplier_max_error = std::max(report.multiplier_max_error, off);
  return off <= multiplier_allowed + allowed_ + doubt ? Verdict::right : Verdict::wrong;
}

void GaitAuditor::look_at(std::size_t number, const Design& design, const Outcome& ours,
                          AuditReport& report) const {
  if (!work_ || ours.gait_period == 0 || ours.gait_period == Outcome::no_gait) return;
  ++report.gaits;
  const Verdict verdict = verdict_on(design, ours, report);
  report.gaits_undecided += verdict == Verdict::undecided;
  if (verdict != Verdict::wrong) return;
  ++report.gaits_wrong;
  report.first_wrong_gait = std::min(report.first_wrong_gait.value_or(number), number);
}

}  // namespace leapmap
