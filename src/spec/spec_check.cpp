// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether a spec filled in by hand is one that a file could hold.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hoop/body.hpp"
#include "leapmap/errors.hpp"
#include "map/layout.hpp"
#include "map/schema.hpp"
#include "model/model.hpp"
#include "model/variable.hpp"
#include "numerics/gsl_integrator.hpp"
#include "spec/options.hpp"
#include "spec/scatter_check.hpp"
#include "spec/spacing.hpp"
#include "spec/spec_hoop.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

[[noreturn]] void refuse(const Spec& spec, std::string_view key, const std::string& what,
                         const std::string& allowed) {
  throw InputError(fmt::format("{}: {} {}; allowed: {}", origin_of(spec), key, what, allowed));
}

void check_number(const Spec& spec, const Option& option, double value) {
  if (!in_range(option, value))
    refuse(spec, option.key, fmt::format("= {} is out of range", value), allowed_values(option));
}

void check_text(const Spec& spec, const Option& option, const std::string& text) {
  if (!option.choices) return;
  if (!is_choice(option, text))
    refuse(spec, option.key, "= " + unknown_choice(option, text), allowed_values(option));
}

/// Axes, or the columns of a list.
void check_values(const Spec& spec, const std::vector<Axis>& axes) {
  for (const Axis& axis : axes) {
    const Option* option = find_option(find_body_number(axis.key) ? "hoop" : "design", axis.key);
    if (!option || !(std::holds_alternative<ParameterSlot>(option->slot) || find_body_number(axis.key)))
      refuse(spec, axis.key, "is not a parameter of a design", "an axis of one");
    if (std::ranges::count(axes, axis.key, &Axis::key) > 1) refuse(spec, axis.key, "appears twice", "once");
    if (!has(spec.scene, option->only_of))
      refuse(spec, axis.key, no_use(spec.scene, option->only_of), with_model(option->only_of));
    if (axis.values.empty()) refuse(spec, axis.key, "has no values", "one or more");
    if (axis.free)
      refuse(spec, axis.key, "is between bounds: 'count' is missing",
             "{ from, to, count }, or leapmap design, which chooses between bounds");
    for (const double value : axis.values) check_number(spec, *option, value);
    if (is_unused_by_law(*option, spec.scene))
      refuse(spec, axis.key, no_use_by_law(spec.scene), with_law(axis.key));
    if (&axes == &spec.axes && std::ranges::any_of(axis.values, [](double v) { return std::isinf(v); }))
      refuse(spec, axis.key, "goes to infinity", "finite values, or inf for all designs");
    if (axis.key == "motor_gain" && spec.scene.motor_law == MotorLaw::angle &&
        std::ranges::any_of(axis.values, [](double v) { return std::isinf(v); }))
      refuse(spec, axis.key, "is infinite, with which motor_law = \"angle\" would swing indefinitely",
             "finite values");
  }
}

/// That nothing is named which only comes of more jumps, or of gaits, than the scene asks for.
void check_names(const Spec& spec) {
  const auto look_at = [&](std::string_view key, const std::string& name) {
    const Field* field = find_field(name);
    if (!field || has(spec.scene, *field)) return;
    if (field->of_sequence)
      refuse(spec, key, fmt::format("'{}' has no effect with scene.jumps = {}", name, spec.scene.jumps),
             "with scene.jumps at least that number");
    if (field->of_wall)
      refuse(spec, key, fmt::format("'{}' has no effect without a wall", name),
             "with scene.clear_height, for example \"40 mm\"");
    if (field->of_gait)
      refuse(spec, key, fmt::format("'{}' has no effect without [gait]", name),
             "for example with gait.settle = 500");
  };
  for (const std::string& name : spec.output.gradients) look_at("gradients", name);
  for (const std::string& name : spec.output.fields) look_at("fields", name);
  for (const Goal& goal : spec.goals) look_at("goal", goal.field);
  for (const std::string& name : spec.maximize) look_at("goal.maximize", name);
  for (const std::string& name : spec.minimize) look_at("goal.minimize", name);
}

std::vector<std::string> keys_of(const std::vector<Variable>& variables) {
  std::vector<std::string> keys;
  for (const Variable& variable : variables) keys.push_back(variable.key);
  return keys;
}

/// That there is a method that has derivatives, and that the model has what is to be differentiated.
void check_gradients(const Spec& spec) {
  const Output& output = spec.output;
  if (output.gradients.empty() && !output.gradients_by.empty())
    refuse(spec, "gradients_by", "has no effect without gradients",
           "for example with gradients = [\"jump_height\"]");
  if (!output.gradients.empty() && resolved_method(spec) != "exact")
    refuse(spec, "gradients", fmt::format("has no effect with method \"{}\"", spec.numerics.method),
           "with method = \"exact\"");
  for (const std::string& name : output.gradients) {
    const Field* field = find_field(name);
    if (field && !has(spec.scene, field->only_of))
      refuse(spec, "gradients", fmt::format("'{}' {}", name, no_use(spec.scene, field->only_of)),
             with_model(field->only_of));
    if (field && can_be_differentiated(*field) && !can_be_differentiated(*field, spec.scene))
      refuse(spec, "gradients",
             fmt::format("'{}' has no derivatives if hoops of several sizes clear one wall", name),
             "with clear_height in hoop diameters");
  }
  const std::vector<Variable> of_body = spec.hoop ? variables_of(*spec.hoop) : std::vector<Variable>{};
  for (const std::string& name : output.gradients_by) {
    if (find_body_number(name) && std::ranges::find(of_body, name, &Variable::key) == of_body.end())
      refuse(spec, "gradients_by", fmt::format("'{}' is no number of this spec's [hoop] that may vary", name),
             of_body.empty() ? "with [hoop]" : fmt::format("{}", fmt::join(keys_of(of_body), ", ")));
    if (const Option* option = find_option("", name); option && !has(spec.scene, option->only_of))
      refuse(spec, "gradients_by", fmt::format("'{}' {}", name, no_use(spec.scene, option->only_of)),
             with_model(option->only_of));
  }
}

/// What all designs of the spec have in common.
void check_common(const Spec& spec) {
  Design common = spec.design;
  for (const auto* varying : {&spec.axes, &spec.list.columns})
    for (const Axis& axis : *varying) {
      const auto variable = find_variable(axis.key, nullptr);
      if (variable) common.*variable->parameter() = Design{}.*variable->parameter();
    }
  // Each design may have a gain of its own, which is checked.
  if (spec.scene.motor_law == MotorLaw::angle && std::isinf(common.motor_gain)) common.motor_gain = 1.0;
  check_design(common, spec.scene, origin_of(spec));
}

void check_labels(const Spec& spec) {
  const std::vector<std::string>& labels = spec.list.labels;
  if (!labels.empty() && labels.size() != spec.list.count)
    refuse(spec, label_name, fmt::format("has {} texts", labels.size()),
           fmt::format("one for each of the {} designs of the list", spec.list.count));
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labels[i].size() > most_label_bytes || printable(labels[i]) != labels[i])
      refuse(spec, label_name, fmt::format("of design {} is '{}'", i, printable(labels[i].substr(0, 40))),
             fmt::format("at most {} bytes of printable UTF-8", most_label_bytes));
}

}  // namespace

void refuse_drawing(const Spec& spec) {
  refuse(spec, "hoop", "draws masses that are fixed to the ring, which a pendulum is not",
         "mass_ratio, offset_ratio, pendulum_inertia and inertia_factor");
}

namespace {

/// The ratios of [hoop] are given once, by its numbers.
void check_body(const Spec& spec) {
  check_hoop(spec);
  if (!spec.hoop) return;
  if (spec.scene.model != Mechanism::hoop) refuse_drawing(spec);
  Design design = spec.design;
  apply_ratios(reduce_checked(*spec.hoop), design);
  for (double Design::*ratio : body_ratios)
    if (design.*ratio != spec.design.*ratio)
      refuse(spec, "hoop", "comes to other ratios than those of the design", "apply_body, or no hoop");
  for (const auto* varying : {&spec.axes, &spec.list.columns})
    for (const Axis& axis : *varying)
      if (const auto variable = find_variable(axis.key, nullptr);
          variable && follows_from_body(variable->parameter()))
        refuse(spec, axis.key, "follows from [hoop]", "an axis of a number of [hoop], such as hoop.mass");
}

void check_order(const Spec& spec) {
  if (spec.output.order.empty()) return;
  std::vector<std::string> keys;
  for (const Axis& axis : spec.axes) keys.push_back(axis.key);
  if (keys != spec.output.order)
    refuse(spec, "order", fmt::format("= {} does not name the axes", fmt::join(spec.output.order, ", ")),
           keys.empty() ? "with axes" : fmt::format("each of {} once", fmt::join(keys, ", ")));
}

void check_axes(const Spec& spec) {
  for (const Axis& axis : spec.axes) {
    if (axis.values.size() > static_cast<std::size_t>(most_axis_values))
      refuse(spec, axis.key, fmt::format("has {} values", axis.values.size()),
             fmt::format("up to {}", most_axis_values));
    if (const auto twice = repeated(axis.values))
      refuse(spec, axis.key, fmt::format("has the value {} twice", *twice), "each once");
  }
}

void check_count(const Spec& spec) {
  if (!spec.axes.empty() && (!spec.list.columns.empty() || !spec.points.empty()))
    refuse(spec, "points", "and an axis exclude each other", "one of them");
  if (!spec.points.empty() && spec.list.columns.empty())
    refuse(spec, "points", "is a file that was not read", "read_spec, which reads it, or the list's columns");
  if (spec.axes.empty() && spec.list.count == 0) refuse(spec, "list", "has no designs", "one or more");
  double designs = 1.0;
  for (const Axis& axis : spec.axes) designs *= static_cast<double>(axis.values.size());
  if (designs > most_designs)
    refuse(spec, "axes", fmt::format("make {:.3g} designs", designs), "at most 1e12");
}

/// That what audits can judge the scene.
void check_auditor(const Spec& spec) {
  if (spec.numerics.audit_by != "proof") return;
  if (spec.scene.model != Mechanism::hoop)
    refuse(spec, "audit_by", "is proof, which cannot judge pendulums", "method");
  if (spec.scene.friction != Friction::sticking)
    refuse(spec, "audit_by", "is proof, which cannot judge hoops with friction", "method, or without slip");
}

/// What the scene's model cannot do.
void check_capabilities(const Spec& spec) {
  const Model& model = model_of(spec.scene);
  const bool exact = resolved_method(spec) == "exact";
  const auto refuse_without = [&](bool can, std::string_view key, std::string_view what,
                                  const std::string& allowed) {
    if (!can)
      refuse(spec, key,
             fmt::format("needs {}, which the model \"{}\" lacks", what,
                         model.mechanism == Mechanism::hoop ? model.name : name_of(model.mechanism)),
             allowed);
  };
  if (exact)
    refuse_without(model.exact, "method", "a semi-analytic solver", "a stepper, for example \"gsl-rk8pd\"");
  else
    refuse_without(model.integration, "method", "an integration in time", "\"exact\"");
  const GslStepper* stepper = find_gsl_stepper(resolved_method(spec));
  if (model.mechanism == Mechanism::pendulum && stepper && (stepper->implicit || stepper->multistep))
    refuse(spec, "method", fmt::format("= {} cannot follow the pieces of a motor's torque", stepper->name),
           "an explicit stepper, for example gsl-rk8pd");
  if (spec.numerics.audit > 0.0)
    refuse_without(model.integration && (model.exact || !model.stepper.empty()), "audit", "a second method",
                   "0");
  if (!spec.output.gradients.empty()) refuse_without(model.gradients, "gradients", "derivatives", "none");
  const auto is_of_way = [](const std::string& name) {
    const Field* field = find_field(name);
    return field && field->of_way;
  };
  if (std::ranges::any_of(spec.output.fields, is_of_way))
    refuse_without(model.ways, "fields", "forces on the way to a jump", "other fields");
  if (spec.scene.jumps > 1)
    refuse_without(exact ? model.jumps != nullptr : model.integrated_jumps != nullptr, "jumps",
                   "jumps that begin at a landing", "1");
  if (spec.scene.settle > 0)
    refuse_without(model.jumps && model.state_jumps, "settle", "derivatives of jumps", "0");
}

}  // namespace

void check_spec(const Spec& spec) {
  check_scene(spec.scene);
  Spec copy;  // as slots are of specs that may be changed; without the designs, which may be many
  copy.scene = spec.scene, copy.numerics = spec.numerics, copy.output = spec.output,
  copy.points = spec.points;
  copy.scatter = spec.scatter, copy.maximize = spec.maximize, copy.minimize = spec.minimize;
  for (const Option& option : spec_options())
    std::visit(
        [&](const auto& slot) {
          using Slot = std::decay_t<decltype(slot)>;
          if constexpr (std::is_same_v<Slot, NumberSlot>)
            check_number(spec, option, slot(copy));
          else if constexpr (std::is_same_v<Slot, IntegerSlot>)
            check_number(spec, option, static_cast<double>(slot(copy)));
          else if constexpr (std::is_same_v<Slot, TextSlot>)
            check_text(spec, option, slot(copy));
          else if constexpr (std::is_same_v<Slot, TextsSlot>)
            for (const std::string& text : slot(copy)) check_text(spec, option, text);
        },
        option.slot);
  if (resolved_method(spec) == "exact" &&
      (spec.numerics.fixed_step > 0.0 || spec.numerics.absolute_tolerance > 0.0))
    refuse(spec, "fixed_step or absolute_tolerance", "has no effect, because exact takes no steps",
           "with method = \"gsl-...\"");
  for (const auto& [key, names] : {std::pair{"maximize", &spec.maximize}, {"minimize", &spec.minimize}})
    if (!names->empty() && spec.list.columns.empty())  // a list may tell what it was found for
      refuse(spec, key, fmt::format("'{}' has no effect here", names->front()), "with leapmap design");
  if (spec.scene.settle > 0 && resolved_method(spec) != "exact")
    refuse(spec, "settle", fmt::format("has no effect with method \"{}\"", spec.numerics.method),
           "with method = \"exact\"");
  for (const std::string& name : spec.nominal_units)
    if (const Option* option = find_option("design", name);
        !spec.hoop || !option || !std::holds_alternative<ParameterSlot>(option->slot) ||
        !may_be_held(std::get<ParameterSlot>(option->slot).member))
      refuse(spec, "nominal_units",
             spec.hoop ? fmt::format("'{}' has the same unit for every hoop", name)
                       : "has no effect, because there is no [hoop]",
             "drive_torque, resisting_torque, release_spin, with [hoop] in the spec");
  check_auditor(spec);
  check_capabilities(spec);
  check_names(spec);
  check_gradients(spec);
  check_scatter(spec);
  check_count(spec);
  check_values(spec, spec.axes);
  check_axes(spec);
  check_values(spec, spec.list.columns);
  if (spec.axes.empty())
    for (const Axis& column : spec.list.columns)
      if (column.values.size() != spec.list.count)
        refuse(spec, column.key, fmt::format("has {} values", column.values.size()),
               fmt::format("one for each of the {} designs of the list", spec.list.count));
  check_labels(spec);
  check_body(spec);
  check_order(spec);
  check_common(spec);
}

}  // namespace leapmap
