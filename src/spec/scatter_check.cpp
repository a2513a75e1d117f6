// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/scatter_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "leapmap/errors.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "spec/spec_hoop.hpp"
#include "tolerance/made_hoops.hpp"

namespace leapmap {
namespace {

[[noreturn]] void refuse(const Spec& spec, std::string_view section, std::string_view key,
                         const std::string& what, const std::string& allowed) {
  throw InputError(fmt::format("{}: {}.{} {}; allowed: {}", origin_of(spec), section, key, what, allowed));
}

/// The number's values over all designs of the spec. One that follows another has the other's.
std::vector<double> values_of(const Spec& spec, const Variable& variable) {
  if (const Axis* axis = find_varying(spec, variable.key)) return axis->values;
  const double value = variable.of(spec.design, spec.hoop.value_or(Body{}));
  if (std::isnan(value) && !variable.of_body()) return values_of(spec, *find_variable("mu_static", nullptr));
  return {value};
}

/// A percentage of zero, or of what is zero but for the rounding of a step, is no scatter at all.
void refuse_percent_of_nothing(const Spec& spec, const Spread& spread, std::span<const double> values) {
  if (!spread.percent || spread.width == 0.0) return;
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  for (const double value : values)
    if (std::abs(value) <= 1e-12 * most)
      refuse(spec, "scatter", spread.parameter,
             fmt::format("is {} % of a nominal value of {}", spread.width, value),
             "a width in the parameter's unit");
}

void check_spread(const Spec& spec, const Spread& spread) {
  const Option* option = find_option("scatter", spread.parameter);
  if (!option || !std::holds_alternative<SpreadSlot>(option->slot))
    refuse(spec, "scatter", spread.parameter, "is not a parameter of a design", "one of them");
  if (std::ranges::count(spec.scatter.spreads, spread.parameter, &Spread::parameter) > 1)
    refuse(spec, "scatter", spread.parameter, "appears twice", "once");
  if (!has(spec.scene, option->only_of))
    refuse(spec, "scatter", spread.parameter, no_use(spec.scene, option->only_of),
           with_model(option->only_of));
  if (!in_range(*option, spread.width))
    refuse(spec, "scatter", spread.parameter, fmt::format("is {} wide", spread.width), "a width in [0, inf)");
  const auto variable = find_variable(spread.parameter, spec.hoop ? &*spec.hoop : nullptr);
  if (!variable) {
    if (!spec.hoop)
      refuse(spec, "scatter", spread.parameter, "has no effect, because there is no [hoop]",
             "with [hoop] in the spec");
    check_hoop_key(*spec.hoop, spread.parameter, origin_of(spec));
    refuse(spec, "scatter", spread.parameter, "has no tolerance, because it scales the whole map",
           "other numbers of [hoop]");
  }
  const MadeHoops hoops({{spread}, SobolPoints::replicates, 0}, spec.hoop, held_in_si(spec),
                        std::make_shared<const SobolPoints>(1, SobolPoints::replicates, 0));
  const std::vector<double> values = values_of(spec, *variable);
  refuse_percent_of_nothing(spec, spread, values);
  for (const double value : values) {
    if (std::isnan(value))
      refuse(spec, "scatter", spread.parameter, "has no nominal value", "with a value in [hoop]");
    Design drawn = spec.design;
    Body body = spec.hoop.value_or(Body{});
    variable->in(drawn, body) = value;
    if (!hoops.can_make(drawn, &body))
      refuse(
          spec, "scatter", spread.parameter,
          fmt::format("exceeds the domain around {}{}: {:.3g} % of the distribution is outside", value,
                      option->unit == "rad" ? " rad" : "", 100.0 * (1.0 - hoops.law(0, drawn, &body).left)),
          fmt::format("a smaller width; the parameter is {}",
                      allowed_values(variable->range, variable->unit)));
  }
}

/// [hoop] determines the ratios: a tolerance of both would say the same twice.
void refuse_ratios_beside_bodies(const Spec& spec) {
  const auto& spreads = spec.scatter.spreads;
  const auto of_body = std::ranges::find_if(
      spreads, [](const Spread& spread) { return find_body_number(spread.parameter) != nullptr; });
  if (of_body == spreads.end()) return;
  for (const Spread& spread : spreads)
    if (const auto variable = find_variable(spread.parameter, nullptr);
        variable && follows_from_body(variable->parameter()))
      refuse(spec, "scatter", spread.parameter,
             fmt::format("follows from numbers of [hoop], of which {} has a tolerance", of_body->parameter),
             "one of the two");
}

void check_goal(const Spec& spec, const Goal& goal) {
  const Option* option = find_option("goal", goal.field);
  if (!option) refuse(spec, "goal", goal.field, "is not a field of a map", "one of them");
  if (std::ranges::count(spec.goals, goal.field, &Goal::field) > 1)
    refuse(spec, "goal", goal.field, "appears twice", "once");
  if (std::holds_alternative<OfMade>(find_field(goal.field)->source))
    refuse(spec, "goal", goal.field, "describes manufactured hoops, and is not a goal for one",
           "with leapmap design");
  if (!has(spec.scene, option->only_of))
    refuse(spec, "goal", goal.field, no_use(spec.scene, option->only_of), with_model(option->only_of));
  const bool some = std::isfinite(goal.at_least) || std::isfinite(goal.at_most);
  if (!(some && goal.at_least <= goal.at_most))
    refuse(spec, "goal", goal.field,
           fmt::format("is at least {} and at most {}", goal.at_least, goal.at_most),
           "one bound or both, at_least not above at_most");
  const Field& field = *find_field(goal.field);
  const auto* code = std::get_if<Code>(&field.source);
  const bool exactly = goal.at_least == goal.at_most && goal.at_least == std::floor(goal.at_least);
  if (code && !code->names.empty() &&
      !(exactly && goal.at_least >= 0.0 && goal.at_least < static_cast<double>(code->names.size())))
    refuse(spec, "goal", goal.field,
           fmt::format("is at least {} and at most {}", goal.at_least, goal.at_most),
           fmt::format("{{ is = ... }} with one of {}", fmt::join(code->names, ", ")));
  if (std::holds_alternative<Word>(field.source) &&
      !(exactly && goal.at_least >= 1.0 && goal.at_least < 9e15))
    refuse(spec, "goal", goal.field, "is not a sequence of phases",
           "for example { is = \"RSF\" }, up to 26 letters");
}

}  // namespace

void check_scatter(const Spec& spec) {
  const Scatter& scatter = spec.scatter;
  for (const std::string& name : spec.output.fields)
    if (const Field* field = find_field(name); field && std::holds_alternative<OfMade>(field->source)) {
      if (scatter.spreads.empty())
        refuse(spec, "output", "fields", fmt::format("names {}, which describes manufactured hoops", name),
               "with a parameter in [scatter]");
      if (std::get<OfMade>(field->source).statistic == Statistic::yield && spec.goals.empty())
        refuse(spec, "output", "fields", fmt::format("names {}", name), "with a field in [goal]");
    }
  for (const Goal& goal : spec.goals) check_goal(spec, goal);
  if (scatter.spreads.empty()) return;
  if (scatter.samples % static_cast<long>(SobolPoints::replicates) != 0)
    refuse(spec, "scatter", "samples", fmt::format("= {}", scatter.samples),
           fmt::format("a multiple of {}", SobolPoints::replicates));
  for (const Spread& spread : scatter.spreads) check_spread(spec, spread);
  refuse_ratios_beside_bodies(spec);
}

}  // namespace leapmap
