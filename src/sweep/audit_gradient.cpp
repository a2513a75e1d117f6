// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit_gradient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/model.hpp"
#include "model/parameters.hpp"
#include "numerics/mixed.hpp"
#include "sweep/solver.hpp"

namespace leapmap {
namespace {

/// What errors are measured by: of derivatives smaller than a thousandth they are absolute.
constexpr double least_size = 1e-3, allowed = 1e-6;
/// Differences of two steps as near to each other as this are those of a derivative that is there.
constexpr double settled = 1e-4;

/// Outcomes one and two steps to either side.
struct Beside {
  double step;
  std::array<Outcome, 4> outcomes;  // + 1, - 1, + 2, - 2 steps
};

/// Whether they could be had, and are all of a kind.
bool look_beside(const Design& original, const Scene& scene, double Design::*parameter, const Outcome& ours,
                 Beside& beside) {
  Design design = original;
  // What follows another goes where that goes.
  if (kinetic_follows(design)) design.mu_kinetic = std::numeric_limits<double>::quiet_NaN();
  const double value = design.*parameter;
  beside.step = 1e-5 * std::max(1.0, std::abs(value));
  for (std::size_t k = 0; k < beside.outcomes.size(); ++k) {
    Design moved = design;
    moved.*parameter = value + (k % 2 == 0 ? 1.0 : -1.0) * (k < 2 ? 1.0 : 2.0) * beside.step;
    const bool kink = (moved.mu_static < moved.mu_kinetic) != (design.mu_static < design.mu_kinetic);
    if (kink || !is_allowed(moved, scene)) return false;
    beside.outcomes[k] = model_of(scene).refined(moved, scene);
    if (!same_flags(beside.outcomes[k], ours)) return false;
  }
  return true;
}

}  // namespace

GradientAuditor::GradientAuditor(const Spec& spec)
    : spec_(spec),
      wanted_(gradients_of(spec)),
      rounding_(spec.output.precision == "f4" ? std::numeric_limits<float>::epsilon() : 0.0) {}

void GradientAuditor::look_at(std::size_t number, const Design& design, const Outcome& ours,
                              std::span<const double> gradient, AuditReport& report) const {
  const std::size_t parameters = wanted_.by.size();
  if (parameters == 0 || ours.candidates == 0) return;
  const std::size_t j = mixed(number) % parameters;
  const auto parameter = differentiable[wanted_.by[j]];
  if (std::isnan(design.*parameter)) return;
  if (parameter == &Design::mu_kinetic && kinetic_follows(design)) return;  // it is not free
  ++report.gradient_designs;
  Beside beside;
  if (!look_beside(design, spec_.scene, parameter, ours, beside)) {
    ++report.gradient_undecided;
    return;
  }
  bool wrong = false;
  for (std::size_t i = 0; i < wanted_.of.size(); ++i) {
    const auto at = [&](std::size_t k) { return wanted_.of[i].of(beside.outcomes[k]); };
    // Of fourth order, and the difference of the two of second order is more than its error.
    const double near = (at(0) - at(1)) / (2.0 * beside.step), far = (at(2) - at(3)) / (4.0 * beside.step);
    const double truth = (4.0 * near - far) / 3.0, found = gradient[i * parameters + j];
    if (std::isnan(truth)) continue;
    const double size = least_size + std::abs(truth), doubt = std::abs(near - far);
    if (std::isnan(found)) {  // right on a fold, where differences do not settle
      wrong = wrong || doubt < settled * size;
      continue;
    }
    const double error = std::max(std::abs(found - truth) - doubt, 0.0) / size;
    report.gradient_max_error = std::max(report.gradient_max_error, error);
    wrong = wrong || error > allowed + rounding_;
  }
  if (!wrong) return;
  ++report.gradients_wrong;
  report.first_wrong_gradient = std::min(report.first_wrong_gradient.value_or(number), number);
}

}  // namespace leapmap
