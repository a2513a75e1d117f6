// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "leapmap/errors.hpp"
#include "leapmap/worst_case.hpp"
#include "model/model.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

[[noreturn]] void refuse(const Spec& spec, std::string_view what, std::string_view allowed) {
  throw InputError(fmt::format("{}: {}; allowed: {}", origin_of(spec), what, allowed));
}

bool is_of_made(const Field& field) { return std::holds_alternative<OfMade>(field.source); }

Objective objective_of(const Spec& spec, const std::vector<FreeParameter>& free, const std::string& name,
                       bool maximize) {
  const std::string key = maximize ? "goal.maximize" : "goal.minimize";
  if (const auto found = std::ranges::find(free, name, &FreeParameter::name); found != free.end())
    return {name, maximize, nullptr, static_cast<std::size_t>(found - free.begin())};
  const Field* field = find_field(name);
  if (!field)
    refuse(spec, fmt::format("{}: {} is fixed", key, name),
           fmt::format("a field, or one of the free parameters, design.{} = {{ from, to }}", name));
  if (!has(spec.scene, field->only_of))
    refuse(spec, fmt::format("{}: {} {}", key, name, no_use(spec.scene, field->only_of)),
           with_model(field->only_of));
  if (field->of_wall && !has(spec.scene, *field))
    refuse(spec, fmt::format("{}: {} has no effect without a wall", key, name),
           "with scene.clear_height, for example \"40 mm\"");
  const auto* code = std::get_if<Code>(&field->source);
  if (std::holds_alternative<Word>(field->source) || (code && !code->names.empty()))
    refuse(spec, fmt::format("{}: {} is a code and has no order", key, name),
           "a quantity; a code may be a goal, { is = ... }");
  if (is_of_made(*field) && spec.scatter.spreads.empty())
    refuse(spec, fmt::format("{}: {} describes manufactured hoops", key, name),
           "with a parameter in [scatter]");
  return {name, maximize, field, 0};
}

/// What takes whole sequences of jumps is too slow to search for.
void refuse_what_is_slow(const Spec& spec, const std::string& key, const Field& field) {
  if (std::holds_alternative<Quantity>(field.source) && (field.of_gait || field.of_sequence))
    refuse(spec, fmt::format("{}: {} follows from whole sequences of jumps", key, field.name),
           "a quantity of a jump, or a code as a goal, for example gait_period = { is = 1 }");
}

bool is_of_jumps(const Field& field) {
  const auto* quantity = std::get_if<Quantity>(&field.source);
  return quantity && field.name.starts_with("first_") == false && field.name != "slip_distance";
}

/// Where a field's values can lie at all.
Range possible(const Field& field, const Scene& scene) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (field.name == "jump_height") return {scene.hop_height, infinity};
  if (field.name == "dip") return {-infinity, 0.0};
  if (field.name == "yield") return {0.0, 1.0};
  if (field.name == "worst_case") return {0.0, infinity};
  const auto* quantity = std::get_if<Quantity>(&field.source);
  const bool positive = (quantity && quantity->measure != Measure::other) ||
                        std::holds_alternative<Code>(field.source) || field.name == "slip_distance";
  return {positive ? 0.0 : -infinity, infinity};
}

/// Goals that no design whatever can reach.
void refuse_contradictions(const Spec& spec, const std::vector<Objective>& objectives) {
  for (const Objective& objective : objectives)
    if (objective.field) refuse_what_is_slow(spec, "goal", *objective.field);
  for (const Goal& goal : spec.goals) {
    refuse_what_is_slow(spec, "goal", *find_field(goal.field));
    const bool quantity = std::holds_alternative<Quantity>(find_field(goal.field)->source);
    if (quantity && goal.at_least == goal.at_most && goal.at_least != 0.0)
      refuse(spec, fmt::format("goal.{} {} is met by no hoop exactly", goal.field, text_of(goal)),
             "{ at_least = ..., at_most = ... } with room between them");
    if (!(goal.at_least <= goal.at_most))
      refuse(spec, fmt::format("goal.{} {} contradicts itself", goal.field, text_of(goal)),
             "at_least not above at_most");
    Scene scene = spec.scene;
    if (goal.unit_of_nominal > 0.0) scene.hop_height = 0.0;  // in SI, each hoop has its own
    const Range range = possible(*find_field(goal.field), scene);
    if (goal.at_least > range.most || goal.at_most < range.least)
      refuse(spec, fmt::format("goal.{} {} is impossible", goal.field, text_of(goal)),
             fmt::format("a range that overlaps {} to {}", range.least, range.most));
  }
  const auto status = std::ranges::find(spec.goals, "status", &Goal::field);
  if (status == spec.goals.end() || status->at_least == static_cast<double>(Status::jumped)) return;
  const auto contradicts = [&](const std::string& key, const Field* field) {
    if (field && is_of_jumps(*field))
      refuse(spec,
             fmt::format("goal.status {} contradicts {}, which describes hoops that jump", text_of(*status),
                         key),
             "goals that one hoop can reach");
  };
  for (const Goal& goal : spec.goals) contradicts("goal." + goal.field, find_field(goal.field));
  for (const Objective& objective : objectives) contradicts(objective.name, objective.field);
}

}  // namespace

bool asks_for_worst_case(const Question& question) {
  constexpr std::string_view name = "worst_case";
  return std::ranges::find(question.made_goals, name, &Goal::field) != question.made_goals.end() ||
         std::ranges::find(question.objectives, name, &Objective::name) != question.objectives.end();
}

Scatter fresh_samples(const Scatter& scatter) {
  Scatter fresh = scatter;
  constexpr long other = 1'000'003;
  fresh.seed = scatter.seed > other ? scatter.seed - other : scatter.seed + other;
  return fresh;
}

std::vector<FreeParameter> free_parameters(const Spec& spec) {
  std::vector<FreeParameter> free;
  for (const Axis& axis : spec.axes) {
    const auto [low, high] = std::ranges::minmax(axis.values);
    if (!axis.free && !axis.spaced)
      refuse(spec,
             fmt::format("design.{} is a list of values, {}{}", axis.key, axis.values[0],
                         axis.values.size() > 1 ? ", ..." : ""),
             "{ from, to }, between which it is free, or a number");
    if (!(low < high))
      refuse(spec, fmt::format("design.{} is the single value {}", axis.key, low), "two bounds, or a number");
    free.push_back(
        {axis.key, *find_variable(axis.key, spec.hoop ? &*spec.hoop : nullptr), {low, high, axis.log}});
  }
  return free;
}

std::vector<double> Question::values(std::span<const double> place) const {
  assert(place.size() == free.size());
  std::vector<double> values;
  for (std::size_t k = 0; k < free.size(); ++k) values.push_back(free[k].side.value(place[k]));
  return values;
}

Spec Question::grid() const {
  Spec spec = one;
  spec.goals.clear(), spec.scatter = {};
  constexpr std::size_t told = 4;  // fewer values do not tell that they are logarithmic
  for (const FreeParameter& parameter : free)
    spec.axes.push_back(
        {parameter.name, values_of({parameter.side.low, parameter.side.high, told, parameter.side.log})});
  return spec;
}

Question question_of(const Spec& spec) {
  if (spec.axes.empty())
    refuse(
        spec,
        spec.points.empty() && spec.list.columns.empty() ? "no parameter is free" : "design.points is a list",
        "one or more, for example design.slope = { from = \"2 deg\", to = \"50 deg\" }");
  Question question{
      .one = spec, .free = {}, .made_goals = {}, .objectives = {}, .designs = VariedDesigns(spec, {})};
  question.one.axes.clear(), question.one.maximize.clear(), question.one.minimize.clear();
  question.one.output = {};
  std::erase_if(question.one.goals, [&](const Goal& goal) {
    const Field* field = find_field(goal.field);
    if (!field || !is_of_made(*field)) return false;
    if (spec.scatter.spreads.empty())
      refuse(spec, fmt::format("goal.{} describes manufactured hoops", goal.field),
             "with a parameter in [scatter]");
    question.made_goals.push_back(goal);
    return true;
  });
  {
    Spec checked = question.one;  // at the bounds of what is free
    for (Axis axis : spec.axes) {
      axis.free = false;
      checked.axes.push_back(std::move(axis));
    }
    check_spec(checked);
  }
  question.free = free_parameters(spec);
  question.designs = VariedDesigns(spec, spec.axes);
  for (const Spread& spread : spec.scatter.spreads)
    for (const FreeParameter& parameter : question.free)
      if (spread.percent && spread.width > 0.0 && spread.parameter == parameter.name &&
          parameter.side.low < 0.0 && parameter.side.high > 0.0)
        refuse(spec,
               fmt::format("scatter.{} is {} % of zero if the parameter is 0, which is within its bounds",
                           spread.parameter, spread.width),
               "a width in the parameter's unit");
  for (const std::string& name : spec.maximize)
    question.objectives.push_back(objective_of(spec, question.free, name, true));
  for (const std::string& name : spec.minimize) {
    if (std::ranges::find(spec.maximize, name) != spec.maximize.end())
      refuse(spec, fmt::format("goal: {} is both maximized and minimized", name), "one of them");
    question.objectives.push_back(objective_of(spec, question.free, name, false));
  }
  if (question.objectives.empty())
    refuse(spec, "no objective: maximize and minimize of [goal] are empty",
           "for example maximize = [\"jump_height\"]");
  if (question.objectives.size() > 2)
    refuse(spec,
           fmt::format("goal.maximize and goal.minimize name {} quantities", question.objectives.size()),
           "one, or two for a Pareto front");
  const auto of_yield = [&](const auto& asked) { return asked.field && asked.field->name == "yield"; };
  if ((std::ranges::any_of(question.objectives, of_yield) ||
       std::ranges::find(question.made_goals, "yield", &Goal::field) != question.made_goals.end()) &&
      question.one.goals.empty())
    refuse(spec, "yield is the fraction of hoops that reach every goal, and there is no other goal",
           "with another field in [goal]");
  refuse_contradictions(spec, question.objectives);
  if (asks_for_worst_case(question)) check_worst_case(question.one);
  return question;
}

}  // namespace leapmap
