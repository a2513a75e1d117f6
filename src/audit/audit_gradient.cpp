// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit_gradient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "hoop/units.hpp"
#include "map/tile.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "numerics/mixed.hpp"
#include "request/request.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap {
namespace {

/// What errors are measured by: of derivatives smaller than a thousandth they are absolute.
constexpr double least_size = 1e-3, allowed = 1e-6;
/// Differences of two steps as near to each other as this are those of a derivative that is there.
constexpr double settled = 1e-4;
constexpr double step = 1e-5, fine_step = 3e-7;

/// Outcomes one and two steps to either side.
struct Beside {
  double step;
  std::array<Outcome, 4> outcomes;  // + 1, - 1, + 2, - 2 steps
};

/// Whether they could be had, and are all of a kind. relative: the step, of the parameter or of one.
bool look_beside(const Design& original, const Scene& scene, double Design::*parameter, const Outcome& ours,
                 double relative, const Solver& follow_up, Beside& beside) {
  Design design = original;
  // What follows another goes where that goes.
  if (kinetic_follows(design)) design.mu_kinetic = std::numeric_limits<double>::quiet_NaN();
  const double value = design.*parameter;
  beside.step = relative * std::max(1.0, std::abs(value));
  for (std::size_t k = 0; k < beside.outcomes.size(); ++k) {
    Design moved = design;
    moved.*parameter = value + (k % 2 == 0 ? 1.0 : -1.0) * (k < 2 ? 1.0 : 2.0) * beside.step;
    const bool kink = (moved.mu_static < moved.mu_kinetic) != (design.mu_static < design.mu_kinetic);
    if (kink || !is_allowed(moved, scene)) return false;
    beside.outcomes[k] = need(model_of(scene), &Model::refined, "solver in long double")(moved, scene);
    if (!same_flags(beside.outcomes[k], ours)) return false;
    if (follow_up) follow_up({&moved, 1}, {&beside.outcomes[k], 1});
    resize(moved, beside.outcomes[k]);
  }
  return true;
}

/// How far a derivative is off beyond what the differences know, relative; infinity if it is missing where
/// they settle. Nothing: they do not apply.
std::optional<double> error_of(double found, const OutcomeNumber& quantity, const Beside& beside) {
  const auto at = [&](std::size_t k) { return quantity.of(beside.outcomes[k]); };
  // Of fourth order, and the difference of the two of second order is more than its error.
  const double near = (at(0) - at(1)) / (2.0 * beside.step), far = (at(2) - at(3)) / (4.0 * beside.step);
  const double truth = (4.0 * near - far) / 3.0;
  if (std::isnan(truth)) return {};
  const double size = least_size + std::abs(truth), doubt = std::abs(near - far);
  if (!std::isnan(found)) return std::max(std::abs(found - truth) - doubt, 0.0) / size;
  if (doubt < settled * size) return HUGE_VAL;
  return {};  // right on a fold, where differences do not settle
}

/// Of how many parameters a design's derivatives are compared: of all in a small audit, of at least one in a
/// large one, so that some thousand are.
std::size_t parameters_of_each(const Spec& spec, std::size_t parameters) {
  constexpr double most_compared = 2000.0;
  const double audited = spec.numerics.audit * static_cast<double>(designs_of(shape_of(spec)));
  const double each = most_compared / std::max(audited, 1.0);
  return std::min(parameters, static_cast<std::size_t>(std::clamp(each, 1.0, most_compared)));
}

/// What the differentiated quantities ask of a first jump besides its solution.
Solver follow_up_of(const Spec& spec, const GradientWanted& wanted) {
  std::vector<const Field*> columns;
  for (const Field* field : fields_of(spec.scene))
    if (const auto number = number_of(*field); number && number->jump == 1 && wanted.wants(*number))
      columns.push_back(field);
  return follow_up(request_of(spec, columns));
}

}  // namespace

GradientAuditor::GradientAuditor(const Spec& spec)
    : spec_(spec),
      wanted_(derivatives_of(request_of(spec))),
      held_(held_in_si(spec)),
      follow_up_(follow_up_of(spec, wanted_)),
      parameters_each_(parameters_of_each(spec, wanted_.by.size())),
      rounding_(spec.output.precision == "f4" ? std::numeric_limits<float>::epsilon() : 0.0) {}

void GradientAuditor::look_at(std::size_t number, const Design& design, const Outcome& ours,
                              std::span<const double> gradient, AuditReport& report) const {
  const std::size_t parameters = wanted_.by.size();
  if (parameters == 0 || ours.candidates == 0) return;
  bool applies = false, decided = false, wrong = false;
  for (std::size_t k = 0; k < parameters_each_; ++k) {
    const std::size_t j = (mixed(number) + k) % parameters;
    const auto parameter = differentiable[wanted_.by[j]];
    if (std::isnan(design.*parameter)) continue;
    if (parameter == &Design::mu_kinetic && kinetic_follows(design)) continue;  // it is not free
    applies = true;
    const double unit = held_unit(held_, parameter, design);
    Beside beside, closer;
    if (!look_beside(design, spec_.scene, parameter, ours, step, follow_up_, beside)) continue;
    decided = true;
    for (std::size_t i = 0; i < wanted_.of.size(); ++i) {
      auto error = error_of(gradient[i * parameters + j] / unit, wanted_.of[i], beside);
      // Phases that no flag shows may change within the steps, not within finer ones.
      if (error && *error > allowed + rounding_ &&
          look_beside(design, spec_.scene, parameter, ours, fine_step, follow_up_, closer))
        error = error_of(gradient[i * parameters + j] / unit, wanted_.of[i], closer);
      if (!error) continue;
      if (std::isfinite(*error)) report.gradient_max_error = std::max(report.gradient_max_error, *error);
      wrong = wrong || *error > allowed + rounding_;
    }
  }
  if (!applies) return;
  ++report.gradient_designs;
  if (!decided) ++report.gradient_undecided;
  if (!wrong) return;
  ++report.gradients_wrong;
  report.first_wrong_gradient = std::min(report.first_wrong_gradient.value_or(number), number);
}

}  // namespace leapmap
