// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "leapmap/errors.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/variable.hpp"
#include "numerics/gsl_integrator.hpp"
#include "spec/quantity.hpp"
#include "spec/spec_hoop.hpp"
#include "support/closest.hpp"
#include "support/number.hpp"

namespace leapmap {
namespace {

std::vector<std::string_view> methods() {
  std::vector<std::string_view> names{"auto", "exact"};
  for (const GslStepper& stepper : gsl_steppers()) names.push_back(stepper.name);
  return names;
}

std::vector<std::string_view> mechanisms() { return {mechanism_names.begin(), mechanism_names.end()}; }

std::vector<std::string_view> motor_laws() { return {motor_law_names.begin(), motor_law_names.end()}; }

/// The value of an enumeration whose names are these.
struct PlaceIn {
  std::size_t place;
  template <class Enumeration>
  operator Enumeration() const {
    return static_cast<Enumeration>(place);
  }
};
template <class Names>
PlaceIn place_in(const Names& names, std::string_view word) {
  return {static_cast<std::size_t>(std::ranges::find(names, word) - names.begin())};
}

std::vector<std::string_view> switch_words() { return {"true", "false"}; }

std::vector<std::string_view> names_same_in_si() {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameters())
    if (const auto* member = std::get_if<double Design::*>(&parameter.member); member && may_be_held(*member))
      names.push_back(parameter.name);
  return names;
}

std::vector<std::string_view> auditors() { return {"method", "proof"}; }

std::vector<std::string_view> precisions() { return {"f8", "f4"}; }

std::vector<std::string_view> field_names() {
  std::vector<std::string_view> names;
  for (const Field& field : map_fields()) names.push_back(field.name);
  return names;
}

bool is_parameter(std::string_view name) {
  return std::ranges::any_of(parameters(), [&](const Parameter& parameter) {
    return parameter.name == name && std::holds_alternative<double Design::*>(parameter.member);
  });
}

bool is_of_jump(std::string_view name) {
  return std::ranges::find(jump_fields(), name, &Field::name) != jump_fields().end();
}

bool is_of_made(std::string_view name) {
  return std::ranges::find(scatter_fields(), name, &Field::name) != scatter_fields().end();
}

bool is_of_proof(std::string_view name) {
  return std::ranges::find(proof_fields(), name, &Field::name) != proof_fields().end();
}

std::vector<std::string_view> differentiable_names() {
  std::vector<std::string_view> names;
  for (const Field& field : map_fields())
    if (can_be_differentiated(field)) names.push_back(field.name);
  return names;
}

std::vector<std::string_view> design_parameter_names() {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameters())
    if (std::holds_alternative<double Design::*>(parameter.member)) names.push_back(parameter.name);
  return names;
}

/// The keys that are no parameters, in order.
const std::array other_keys{
    Option{
        "scene",
        "model",
        WordSlot{[](const Scene& scene) { return name_of(scene.model); },
                 [](Scene& scene, std::string_view word) { scene.model = place_in(mechanism_names, word); },
                 true},
        "",
        "what rolls; pendulum: a hoop with a pendulum on its axis and a motor between them",
        {},
        mechanisms},
    Option{"scene",
           "friction",
           WordSlot{[](const Scene& scene) { return model_of(scene).name; },
                    [](Scene& scene, std::string_view word) { scene.friction = find_model(word)->friction; },
                    true},
           "",
           "contact model; sticking: never slips, as in the paper; coulomb: Coulomb friction",
           {},
           model_names},
    Option{"scene",
           "jumps",
           IntegerSlot{[](Spec& s) -> long& { return s.scene.jumps; }},
           "1",
           "number of jumps to follow",
           {1, static_cast<double>(most_jumps)}},
    Option{"scene",
           "motor_in_flight",
           SwitchSlot{[](Spec& s) -> bool& { return s.scene.motor_in_flight; }},
           "",
           "whether a motor drives the hoop in flight too; else it idles there",
           {},
           switch_words},
    Option{"design",
           "motor_law",
           WordSlot{
               [](const Scene& scene) { return name_of(scene.motor_law); },
               [](Scene& scene, std::string_view word) { scene.motor_law = place_in(motor_law_names, word); },
               false},
           "",
           "what the motor does with its torque; until_: brakes and holds at motor_target; speed, angle: "
           "regulates to it",
           {},
           motor_laws,
           Mechanism::pendulum},
    Option{"design", "points", TextSlot{[](Spec& s) -> std::string& { return s.points; }}, "",
           "CSV file with one design in a row instead of axes; its header names parameters"},
    Option{"numerics",
           "method",
           TextSlot{[](Spec& s) -> std::string& { return s.numerics.method; }},
           "",
           "how motion is solved; auto: exact; gsl-: integration in time",
           {},
           methods},
    Option{"numerics",
           "tolerance",
           NumberSlot{[](Spec& s) -> double& { return s.numerics.tolerance; }},
           "1",
           "relative error allowed in times (exact) or per step (gsl-)",
           {0.0, 0.1, false, true}},
    Option{"numerics",
           "absolute_tolerance",
           NumberSlot{[](Spec& s) -> double& { return s.numerics.absolute_tolerance; }},
           "1",
           "gsl-: absolute error allowed per step, in rad and sqrt(g/R); 0: equal to tolerance",
           {0.0, 0.1}},
    Option{"numerics",
           "fixed_step",
           NumberSlot{[](Spec& s) -> double& { return s.numerics.fixed_step; }},
           "sqrt(R/g)",
           "gsl-: length of constant steps without error control; 0: adaptive steps",
           {0.0, 100.0}},
    Option{"numerics",
           "max_steps",
           IntegerSlot{[](Spec& s) -> long& { return s.numerics.max_steps; }},
           "1",
           "gsl-: a design that needs more steps gets status failed",
           {1, 1e12}},
    Option{
        "numerics",
        "audit",
        NumberSlot{[](Spec& s) -> double& { return s.numerics.audit; }},
        "1",
        "fraction of designs solved again by an independent method; if not given, at most some 400 designs",
        {0.0, 1.0}},
    Option{"numerics",
           "audit_by",
           TextSlot{[](Spec& s) -> std::string& { return s.numerics.audit_by; }},
           "",
           "what the audit compares with: another method, or proof, whose enclosures hold, without slip",
           {},
           auditors},
    Option{"gait",
           "settle",
           IntegerSlot{[](Spec& s) -> long& { return s.scene.settle; }},
           "1",
           "transient: most jumps until a hoop settles on a gait; 0: no search; 500 if another key of this "
           "section is given",
           {0, 1'000'000}},
    Option{"gait",
           "most_period",
           IntegerSlot{[](Spec& s) -> long& { return s.scene.most_period; }},
           "1",
           "longest period to search for, in jumps",
           {1, 64}},
    Option{"gait",
           "tolerance",
           NumberSlot{[](Spec& s) -> double& { return s.scene.gait_tolerance; }},
           "1",
           "distance of landings that count as equal, in rad and sqrt(g/R)",
           {0.0, 1.0, false, true}},
    Option{
        "design",
        "nominal_units",
        TextsSlot{[](Spec& s) -> std::vector<std::string>& { return s.nominal_units; }},
        "",
        "with [hoop]: parameters in the units of the nominal hoop, so that hoops of every size and mass have "
        "the same in N m or rpm; one that is given with such a unit is always among them",
        {},
        names_same_in_si},
    Option{"output", "file", TextSlot{[](Spec& s) -> std::string& { return s.output.file; }}, "",
           "the map to write; the option -o overrides it"},
    Option{
        "output",
        "fields",
        TextsSlot{[](Spec& s) -> std::vector<std::string>& { return s.output.fields; }},
        "",
        "datasets to store",
        {},
        field_names,
        {},
        [](std::string_view name) { return is_of_jump(name) || is_of_made(name) || is_of_proof(name); },
        "with scene.jumps also jump_height_2, jump_time_2 and so on; with [scatter] also yield, cut_off, "
        "unsolved, and for every quantity _mean, _sd, _q05, _q50, _q95, for example jump_height_mean, each "
        "also with _error; without slip also proof, jump_height_low, jump_height_high, jump_time_low, "
        "jump_time_high: what is proved of each design's cell (leapmap prove)"},
    Option{"output",
           "gradients",
           TextsSlot{[](Spec& s) -> std::vector<std::string>& { return s.output.gradients; }},
           "",
           "quantities to store with their derivatives, for example as jump_height_by_slope (exact only)",
           {},
           differentiable_names,
           {},
           is_of_jump,
           "with scene.jumps jump_height_2, jump_time_2 and so on"},
    Option{"output",
           "gradients_by",
           TextsSlot{[](Spec& s) -> std::vector<std::string>& { return s.output.gradients_by; }},
           "",
           "parameters of these derivatives; by default all of the model, with [hoop] its numbers in place "
           "of the ratios",
           {},
           design_parameter_names,
           {},
           [](std::string_view name) { return find_body_number(name) != nullptr; },
           "numbers of [hoop]"},
    Option{"output",
           "order",
           TextsSlot{[](Spec& s) -> std::vector<std::string>& { return s.output.order; }},
           "",
           "order of the axes, the first varies slowest",
           {},
           design_parameter_names,
           {},
           [](std::string_view name) { return find_body_number(name) != nullptr; },
           "numbers of [hoop]"},
    Option{"output",
           "precision",
           TextSlot{[](Spec& s) -> std::string& { return s.output.precision; }},
           "",
           "type of stored numbers; f4 has 7 digits and half the size",
           {},
           precisions},
    Option{"output",
           "compression",
           IntegerSlot{[](Spec& s) -> long& { return s.output.compression; }},
           "1",
           "level of shuffle and deflate, from 1 (fast) to 9 (small); 0: none",
           {0, 9}},
    Option{"scatter",
           "samples",
           IntegerSlot{[](Spec& s) -> long& { return s.scatter.samples; }},
           "1",
           "manufactured hoops per design, a multiple of 16, best a power of two",
           {32, 1 << 20}},
    Option{"scatter",
           "seed",
           IntegerSlot{[](Spec& s) -> long& { return s.scatter.seed; }},
           "1",
           "seed of the manufactured hoops",
           {0, 1e15}},
    Option{
        "scatter",
        "interpolate",
        SwitchSlot{[](Spec& s) -> bool& { return s.scatter.interpolate; }},
        "",
        "whether a map with friction solves some hoops and interpolates those between; else all are solved",
        {},
        switch_words},
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// [scatter] has a key for each parameter that a design has of its own.
Option spread_of(const Parameter& parameter) {
  return {"scatter",
          parameter.name,
          SpreadSlot{},
          parameter.unit,
          parameter.meaning,
          {0.0, infinity, true, false},
          {},
          parameter.only_of};
}

Option objective(std::string_view key, TextsSlot slot, std::string_view meaning) {
  return {"goal",
          key,
          slot,
          "",
          meaning,
          {},
          field_names,
          {},
          [](std::string_view name) {
            return is_parameter(name) || is_of_made(name) || find_body_number(name) != nullptr;
          },
          "a free parameter or number of [hoop]; with [scatter] also yield, jump_height_q05 and so on"};
}

/// [goal] has one for each field.
Option goal_of(const Field& field) {
  return {
      "goal", field.name,   GoalSlot{}, own_unit(field), field.long_name, {-infinity, infinity, false, false},
      {},     field.only_of};
}

Option option_of(const Parameter& parameter) {
  const auto* of_design = std::get_if<double Design::*>(&parameter.member);
  Option option{of_design && !parameter.of_contact ? "design" : "scene",
                parameter.name,
                SceneSlot{},
                parameter.unit,
                parameter.meaning,
                parameter.range};
  if (of_design)
    option.slot = ParameterSlot{*of_design};
  else
    option.slot = SceneSlot{std::get<double Scene::*>(parameter.member)};
  option.only_of = parameter.only_of;
  return option;
}

/// Section by section: what picks the model, the parameters, the other keys.
std::vector<Option> all_options() {
  std::vector<Option> all;
  for (const std::string_view section : spec_sections) {
    const auto add_keys = [&](bool pick_model) {
      std::ranges::copy_if(other_keys, std::back_inserter(all), [&](const Option& key) {
        const auto* word = std::get_if<WordSlot>(&key.slot);
        return key.section == section && (word && word->picks_model) == pick_model;
      });
    };
    add_keys(true);
    for (const Parameter& parameter : parameters())
      if (const Option option = option_of(parameter); option.section == section) all.push_back(option);
    if (section == "scatter")
      for (const Parameter& parameter : parameters())
        if (std::holds_alternative<double Design::*>(parameter.member)) all.push_back(spread_of(parameter));
    if (section == "goal")
      for (const Field& field : map_fields()) all.push_back(goal_of(field));
    if (section == "goal") {
      all.push_back(goal_of(*find_field("yield")));
      all.push_back(goal_of(*find_field("worst_case")));
      all.push_back(objective(
          "maximize", [](Spec& s) -> std::vector<std::string>& { return s.maximize; },
          "leapmap design: objectives to maximize; with minimize one or two in all"));
      all.push_back(objective(
          "minimize", [](Spec& s) -> std::vector<std::string>& { return s.minimize; },
          "leapmap design: objectives to minimize"));
    }
    add_keys(false);
  }
  return all;
}

}  // namespace

std::span<const Option> spec_options() {
  static const std::vector<Option> options = all_options();
  return options;
}

std::vector<const Option*> design_parameters() {
  std::vector<const Option*> parameters;
  for (const Option& option : spec_options())
    if (std::holds_alternative<ParameterSlot>(option.slot)) parameters.push_back(&option);
  return parameters;
}

std::vector<const Option*> hop_options() {
  std::vector<const Option*> of_one;
  for (const Option& option : spec_options())
    if (option.section == "scene" || (option.section == "design" && option.key != "points"))
      of_one.push_back(&option);
  return of_one;
}

std::vector<const Option*> design_parameters(const Spec& spec) {
  std::vector<const Option*> parameters = design_parameters();
  std::erase_if(parameters, [&](const Option* parameter) {
    return !has(spec.scene, parameter->only_of) &&
           std::ranges::find(spec.list.columns, parameter->key, &Axis::key) == spec.list.columns.end();
  });
  return parameters;
}

namespace {

/// A row of [hoop], or its tolerance.
Option option_of(const BodyNumber& row, bool spread) {
  Option option{"hoop", row.name, HoopSlot{}, row.unit, row.meaning, row.range};
  if (spread)
    option.section = "scatter", option.slot = SpreadSlot{}, option.range = {0.0, infinity, true, false};
  return option;
}

const Option* find_hoop_option(std::string_view section, std::string_view key) {
  static const auto make = [](bool spread) {
    std::vector<Option> options;
    for (const BodyNumber& row : body_numbers()) options.push_back(option_of(row, spread));
    return options;
  };
  static const std::vector<Option> numbers = make(false), spreads = make(true);
  const BodyNumber* row = find_body_number(key);
  if (!row || !(section.empty() || section == "hoop" || section == "scatter")) return nullptr;
  const auto place = row - body_numbers().data();
  return &(section == "scatter" ? spreads : numbers)[static_cast<std::size_t>(place)];
}

}  // namespace

std::string flag_of(const Option& option) {
  std::string flag = fmt::format("--{}", option.key);
  std::ranges::replace(flag, '_', '-');
  return flag;
}

const Option* find_option(std::string_view section, std::string_view key) {
  if (const Option* of_hoop = find_hoop_option(section, key)) return of_hoop;
  const auto found = std::ranges::find_if(spec_options(), [&](const Option& o) {
    const bool there = o.section == section ||
                       (section == "design" && std::holds_alternative<ParameterSlot>(o.slot)) ||
                       (section == "scene" && std::holds_alternative<WordSlot>(o.slot));
    return o.key == key && (section.empty() || there);
  });
  return found == spec_options().end() ? nullptr : &*found;
}

std::string allowed_values(const Option& option) {
  if (option.choices)
    return fmt::format("one of {}{}{}", fmt::join(option.choices(), ", "), option.also ? "; " : "",
                       option.also_told);
  if (std::holds_alternative<TextSlot>(option.slot)) return "a string";
  return allowed_values(option.range, option.unit,
                        std::holds_alternative<IntegerSlot>(option.slot) ? "a whole number" : "a number");
}

std::string unknown_choice(const Option& option, std::string_view text) {
  const std::vector<std::string_view> choices = option.choices();
  return fmt::format("'{}' is unknown{}", text, did_you_mean(text, choices));
}

bool is_choice(const Option& option, std::string_view text) {
  const auto choices = option.choices();
  return std::ranges::find(choices, text) != choices.end() || (option.also && option.also(text));
}

bool in_range(const Option& option, double value) { return option.range.holds(value); }

double parse_number(const Option& option, std::string_view text, const Scales& scales) {
  double value = 0.0;
  try {
    value = number_in_own_unit(text, option.unit, scales);
  } catch (const InputError& error) {
    std::string allowed = allowed_values(option);
    const OwnUnit* own = find_own_unit(option.unit);
    if (own && !(own->size(scales) > 0.0)) allowed.resize(std::min(allowed.find(" or as "), allowed.size()));
    throw InputError(fmt::format("{}; allowed: {}", error.what(), allowed));
  }
  if (!in_range(option, value))
    throw InputError(fmt::format("'{}' is out of range{}; allowed: {}", text,
                                 number_in(text) ? meant_degrees(option.range, option.unit, value) : "",
                                 allowed_values(option)));
  return value;
}

double Design::*member_of(std::string_view parameter) { return member_of(*find_option("", parameter)); }

}  // namespace leapmap
