// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "map/schema.hpp"
#include "support/errors.hpp"

namespace leapmap {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double right_angle = std::numbers::pi / 2.0;
constexpr double degree = std::numbers::pi / 180.0;
constexpr Range non_negative{0.0, inf, true, false};
constexpr Range positive{1e-9, 1e9};  // a length or an acceleration
constexpr Range ratio{0.0, 1e12};
constexpr Range coefficient{0.0, 1e6};  // of friction: more than any pair of materials has
constexpr Range fraction{0.0, 1.0};

std::vector<std::string_view> frictions() { return {"sticking", "coulomb"}; }

std::vector<std::string_view> methods() {
  std::vector<std::string_view> names{"auto", "exact"};
  for (const GslStepper& stepper : gsl_steppers()) names.push_back(stepper.name);
  return names;
}

std::vector<std::string_view> precisions() { return {"f8", "f4"}; }

std::vector<std::string_view> field_names() {
  std::vector<std::string_view> names;
  for (const Field& field : map_fields()) names.push_back(field.name);
  return names;
}

const std::array options{
    Option{"scene",
           "friction",
           TextSlot{[](Spec& s) -> std::string& { return s.friction; }},
           "",
           "\"sticking\": never slips (the paper's model); \"coulomb\": slips, lands and hops on",
           {},
           frictions},
    Option{"scene",
           "mu_static",
           ParameterSlot{&Design::mu_static},
           "1",
           "coulomb only: static friction coefficient",
           coefficient,
           {},
           true},
    Option{"scene",
           "mu_kinetic",
           ParameterSlot{&Design::mu_kinetic},
           "1",
           "coulomb only: kinetic friction coefficient, mu_static unless given; a lower mu_static counts as "
           "much",
           coefficient,
           {},
           true},
    Option{"scene",
           "restitution",
           ParameterSlot{&Design::restitution},
           "1",
           "coulomb only: Poisson restitution",
           fraction,
           {},
           true},
    Option{"scene",
           "rest_speed",
           NumberSlot{[](Spec& s) -> double& { return s.scene.rest_speed; }},
           "sqrt(g R)",
           "coulomb only: slower rebounds count as none",
           non_negative,
           {},
           true},
    Option{"scene",
           "runway",
           NumberSlot{[](Spec& s) -> double& { return s.scene.runway; }},
           "revolutions",
           "distance rolled after which the search for a jump ends",
           {0.0, 1e6, false, true}},
    Option{"scene", "hop_height", NumberSlot{[](Spec& s) -> double& { return s.scene.hop_height; }},
           "hoop diameters", "a lift-off that flies this high is the jump; 0: the first one is",
           non_negative},
    Option{"scene", "radius", NumberSlot{[](Spec& s) -> double& { return s.scene.radius; }}, "m",
           "the hoop's radius R; scales times only", positive},
    Option{"scene", "gravity", NumberSlot{[](Spec& s) -> double& { return s.scene.gravity; }}, "m s-2",
           "g; scales times only", positive},
    Option{"design",
           "slope",
           ParameterSlot{&Design::slope},
           "rad",
           "slope of the plane",
           {0.0, right_angle, true, false}},
    Option{"design", "mass_ratio", ParameterSlot{&Design::mass_ratio}, "1",
           "point mass over hoop mass, m_p / m", ratio},
    Option{"design", "offset_ratio", ParameterSlot{&Design::offset_ratio}, "1",
           "distance of the point mass from the centre over the radius, L / R", fraction},
    Option{"design", "inertia_factor", ParameterSlot{&Design::inertia_factor}, "1",
           "inertia of the bare hoop over m R^2: thin hoop 1, disc 1/2", ratio},
    Option{"design",
           "release_angle",
           ParameterSlot{&Design::release_angle},
           "rad",
           "angle phi at release: 0 mass on the plane, 180 deg mass on top",
           {-1e6, 1e6}},
    Option{"design",
           "release_spin",
           ParameterSlot{&Design::release_spin},
           "sqrt(g/R)",
           "spin at release, positive downhill",
           {-1e4, 1e4}},
    Option{"design", "points", TextSlot{[](Spec& s) -> std::string& { return s.points; }}, "",
           "CSV file with one design a line instead of axes; its header names parameters (angles in rad)"},
    Option{"numerics",
           "method",
           TextSlot{[](Spec& s) -> std::string& { return s.numerics.method; }},
           "",
           "how rolling is solved; auto: exact, by conservation of energy",
           {},
           methods},
    Option{"numerics",
           "tolerance",
           NumberSlot{[](Spec& s) -> double& { return s.numerics.tolerance; }},
           "1",
           "relative error allowed in times (exact; with friction in every phase), or per step (gsl-)",
           {0.0, 0.1, false, true}},
    Option{"numerics",
           "absolute_tolerance",
           NumberSlot{[](Spec& s) -> double& { return s.numerics.absolute_tolerance; }},
           "1",
           "gsl-: absolute error allowed per step, in rad and sqrt(g/R); 0: as tolerance",
           {0.0, 0.1}},
    Option{"numerics",
           "fixed_step",
           NumberSlot{[](Spec& s) -> double& { return s.numerics.fixed_step; }},
           "sqrt(R/g)",
           "gsl-: constant steps this long, errors unchecked; 0: adaptive steps",
           {0.0, 100.0}},
    Option{"numerics",
           "max_steps",
           IntegerSlot{[](Spec& s) -> long& { return s.numerics.max_steps; }},
           "1",
           "gsl-: a design that needs more steps has status failed",
           {1, 1e12}},
    Option{"numerics", "audit", NumberSlot{[](Spec& s) -> double& { return s.numerics.audit; }}, "1",
           "share of designs solved again by an independent method", fraction},
    Option{"output", "file", TextSlot{[](Spec& s) -> std::string& { return s.output.file; }}, "",
           "the map to write; -o overrides it"},
    Option{"output",
           "fields",
           TextsSlot{[](Spec& s) -> std::vector<std::string>& { return s.output.fields; }},
           "",
           "datasets to store; default: all",
           {},
           field_names},
    Option{"output",
           "precision",
           TextSlot{[](Spec& s) -> std::string& { return s.output.precision; }},
           "",
           "type of stored numbers: f8, or f4 with 7 digits and half the size",
           {},
           precisions},
    Option{"output",
           "compression",
           IntegerSlot{[](Spec& s) -> long& { return s.output.compression; }},
           "1",
           "0: none; 1 (fast) to 9 (small): shuffle and deflate, read by every HDF5 program",
           {0, 9}},
};

std::string shown(const Option& option, double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return option.unit == "rad" && value == right_angle ? "90 deg" : fmt::format("{}", value);
}

std::string default_of(const Option& option) {
  Spec spec;
  return std::visit(
      [&](const auto& slot) -> std::string {
        using Slot = std::decay_t<decltype(slot)>;
        if constexpr (std::is_same_v<Slot, ParameterSlot>) {
          const double value = spec.design.*slot.member;
          if (std::isnan(value)) return "that of mu_static";
          return option.key == "release_angle" ? "180 deg" : fmt::format("{:.6g}", value);
        } else if constexpr (std::is_same_v<Slot, TextSlot>) {
          return fmt::format("\"{}\"", slot(spec));
        } else if constexpr (std::is_same_v<Slot, TextsSlot>) {
          return "[all]";
        } else {
          return fmt::format("{}", slot(spec));
        }
      },
      option.slot);
}

}  // namespace

std::span<const Option> spec_options() { return options; }

std::vector<const Option*> design_parameters() {
  std::vector<const Option*> parameters;
  for (const Option& option : options)
    if (std::holds_alternative<ParameterSlot>(option.slot)) parameters.push_back(&option);
  return parameters;
}

std::vector<const Option*> hop_options() {
  std::vector<const Option*> of_one;
  for (const Option& option : options)
    if (option.section == "scene" || (option.section == "design" && option.key != "points"))
      of_one.push_back(&option);
  return of_one;
}

std::vector<const Option*> design_parameters(const Spec& spec) {
  std::vector<const Option*> parameters = design_parameters();
  std::erase_if(parameters, [&](const Option* parameter) {
    return parameter->of_coulomb && spec.scene.friction != Friction::coulomb &&
           std::ranges::find(spec.list.columns, parameter->key, &Axis::key) == spec.list.columns.end();
  });
  return parameters;
}

std::vector<double> list_values(const Spec& spec, const Option& parameter) {
  const auto column = std::ranges::find(spec.list.columns, parameter.key, &Axis::key);
  const bool follows = column == spec.list.columns.end() && std::isnan(value_of(parameter, spec.design));
  if (follows) return list_values(spec, *find_option("scene", "mu_static"));
  return column != spec.list.columns.end() ? column->values
                                           : std::vector(spec.list.count, value_of(parameter, spec.design));
}

std::string flag_of(const Option& option) {
  std::string flag = fmt::format("--{}", option.key);
  std::ranges::replace(flag, '_', '-');
  return flag;
}

const Option* find_option(std::string_view section, std::string_view key) {
  const auto found = std::ranges::find_if(options, [&](const Option& o) {
    const bool there =
        o.section == section || (section == "design" && std::holds_alternative<ParameterSlot>(o.slot));
    return o.key == key && (section.empty() || there);
  });
  return found == options.end() ? nullptr : &*found;
}

std::string allowed_values(const Option& option) {
  if (option.choices) return fmt::format("one of {}", fmt::join(option.choices(), ", "));
  if (std::holds_alternative<TextSlot>(option.slot)) return "a string";
  const Range& range = option.range;
  const bool integer = std::holds_alternative<IntegerSlot>(option.slot);
  return fmt::format("{} in {}{}, {}{}{}", integer ? "a whole number" : "a number",
                     range.least_allowed ? '[' : '(', shown(option, range.least), shown(option, range.most),
                     range.most_allowed ? ']' : ')',
                     option.unit == "rad" ? ", in rad or as \"... deg\"" : "");
}

bool in_range(const Option& option, double value) {
  const Range& range = option.range;
  return std::isfinite(value) && (range.least_allowed ? value >= range.least : value > range.least) &&
         (range.most_allowed ? value <= range.most : value < range.most);
}

double parse_number(const Option& option, std::string_view text) {
  const auto trim = [](std::string_view s) {
    const auto first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view{} : s.substr(first, last - first + 1);
  };
  std::string_view digits = trim(text);
  double unit = 1.0;
  for (const auto& [suffix, factor] : {std::pair{"deg", degree}, std::pair{"rad", 1.0}}) {
    if (option.unit != "rad" || !digits.ends_with(suffix)) continue;
    digits = trim(digits.substr(0, digits.size() - 3));
    unit = factor;
    break;
  }
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || digits.empty())
    throw InputError(fmt::format("'{}' is not a number; allowed: {}", text, allowed_values(option)));
  value *= unit;
  if (!in_range(option, value))
    throw InputError(fmt::format("'{}' is not allowed; allowed: {}", text, allowed_values(option)));
  return value;
}

std::string options_help() {
  std::string help =
      "Spec keys (TOML, or --set KEY=VALUE). A key marked * also takes an axis:\n"
      "  slope = { from = \"2 deg\", to = \"50 deg\", count = 241 }     mass_ratio = { from = 0.1, to = 20, "
      "count = 256, "
      "scale = \"log\" }\n"
      "  offset_ratio = { values = [0.6, 0.8, 1.0] }\n";
  std::string_view section;
  for (const Option& option : options) {
    if (option.section != section) help += fmt::format("[{}]\n", section = option.section);
    const bool axis = std::holds_alternative<ParameterSlot>(option.slot);
    const std::string unit =
        option.unit.empty() || option.unit == "1" ? "" : fmt::format(" [{}]", option.unit);
    help += fmt::format("  {:<19}{} {}{}; {}. Default {}.\n", option.key, axis ? '*' : ' ', option.meaning,
                        unit, allowed_values(option), default_of(option));
  }
  return help;
}

}  // namespace leapmap
