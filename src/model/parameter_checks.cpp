// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/units.hpp"
#include "model/model.hpp"
#include "model/own_units.hpp"
#include "model/parameters.hpp"

namespace leapmap {
namespace {

std::string shown(double value, std::string_view unit) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  const bool upright = unit == "rad" && std::abs(value) == std::numbers::pi / 2.0;
  return upright ? (value > 0 ? "90 deg" : "-90 deg") : fmt::format("{}", value);
}

[[noreturn]] void refuse(std::string_view place, const Parameter& parameter, double value,
                         std::string_view what, std::string_view allowed) {
  throw InputError(fmt::format("{}{}{} = {} {}; allowed: {}", place, place.empty() ? "" : ": ",
                               parameter.name, value, what, allowed));
}

[[noreturn]] void refuse_unused(std::string_view place, const Parameter& parameter, double value,
                                const Scene& scene) {
  refuse(place, parameter, value, no_use(scene, parameter.only_of), with_model(parameter.only_of));
}

[[noreturn]] void refuse_range(std::string_view place, const Parameter& parameter, double value) {
  refuse(place, parameter, value, "is out of range" + meant_degrees(parameter.range, parameter.unit, value),
         allowed_values(parameter.range, parameter.unit));
}

/// Whether a design may have that value in the scene, used or not.
bool is_allowed(const Parameter& parameter, double value, double usual, const Scene& scene) {
  const auto* member = std::get_if<double Design::*>(&parameter.member);
  if (!has(scene, parameter.only_of) || (member && is_unused_by_law(*member, scene)))
    return is_usual(value, usual);
  return parameter.range.holds(value) || (std::isnan(value) && std::isnan(usual));
}

/// The first parameter whose value the design may not have, or nullptr.
const Parameter* first_refused(const Design& design, const Scene& scene) {
  constexpr Design usual;
  for (const Parameter& parameter : parameters())
    if (const auto* member = std::get_if<double Design::*>(&parameter.member))
      if (!is_allowed(parameter, design.**member, usual.**member, scene)) return &parameter;
  return nullptr;
}

/// Whether its motor, if it is to bring the pendulum to an angle, has a finite gain: as stiffly as can be it
/// would swing about it indefinitely.
bool has_gain(const Design& design, const Scene& scene) {
  return scene.model != Mechanism::pendulum || scene.motor_law != MotorLaw::angle ||
         std::isfinite(design.motor_gain);
}

}  // namespace

std::string allowed_values(const Range& range, std::string_view unit, std::string_view what) {
  const OwnUnit* own = find_own_unit(unit);
  return fmt::format("{} in {}{}, {}{}{}", what, range.least_allowed ? '[' : '(', shown(range.least, unit),
                     shown(range.most, unit), range.most_allowed ? ']' : ')',
                     own ? fmt::format(", in {} or as \"... {}\"", own->name, own->example) : "");
}

std::string meant_degrees(const Range& range, std::string_view unit, double value) {
  const bool fits = unit == "rad" && !range.holds(value) && range.holds(degrees(value));
  return fits ? fmt::format(" (did you mean {}deg?)", value) : "";
}

std::string no_use(const Scene& scene, const OnlyOf& only_of) {
  if (only_of.model && *only_of.model != scene.model)
    return fmt::format("has no effect because the model is {}", name_of(scene.model));
  return fmt::format("has no effect because the contact {}", model_of(scene).meaning);
}

std::string with_model(const OnlyOf& only_of) {
  std::vector<std::string> keys;
  const auto add = [&](std::string_view key, std::string_view name) {
    keys.push_back(fmt::format("with {} = \"{}\", on the command line --{} {} or --set {}={}", key, name, key,
                               name, key, name));
  };
  if (only_of.model) add("model", name_of(*only_of.model));
  if (only_of.friction) add("friction", model_of(*only_of.friction).name);
  return fmt::format("{}", fmt::join(keys, ", and "));
}

bool is_usual(double value, double usual) {
  return value == usual || (std::isnan(usual) && (std::isnan(value) || value == Design{}.mu_static));
}

void check_scene(const Scene& scene) {
  constexpr Scene usual;
  for (const Parameter& parameter : parameters()) {
    const auto* member = std::get_if<double Scene::*>(&parameter.member);
    if (!member) continue;
    const double value = scene.**member;
    if (!has(scene, parameter.only_of) && value != usual.**member) refuse_unused({}, parameter, value, scene);
    if (!parameter.range.holds(value)) refuse_range({}, parameter, value);
  }
  if (scene.settle < 0 || scene.settle > 1'000'000)
    throw InputError(
        fmt::format("settle = {} is out of range; allowed: a whole number in [0, 1000000]", scene.settle));
  if (scene.most_period < 1 || scene.most_period > 64)
    throw InputError(fmt::format("most_period = {} is out of range; allowed: a whole number in [1, 64]",
                                 scene.most_period));
  if (!(scene.gait_tolerance > 0.0 && scene.gait_tolerance <= 1.0))
    throw InputError(fmt::format("gait_tolerance = {} is out of range; allowed: a number in (0, 1]",
                                 scene.gait_tolerance));
  if (scene.jumps < 1 || scene.jumps > most_jumps)
    throw InputError(fmt::format("jumps = {} is out of range; allowed: a whole number in [1, {}]",
                                 scene.jumps, most_jumps));
}

bool is_unused_by_law(double Design::*member, const Scene& scene) {
  const MotorLaw law = scene.motor_law;
  if (scene.model != Mechanism::pendulum) return false;
  if (member == &Design::motor_target) return law == MotorLaw::constant;
  if (member == &Design::motor_gain) return law != MotorLaw::speed && law != MotorLaw::angle;
  return member == &Design::motor_damping && law != MotorLaw::angle;
}

std::string no_use_by_law(const Scene& scene) {
  return fmt::format("has no effect with motor_law = \"{}\"", name_of(scene.motor_law));
}

std::string with_law(std::string_view parameter) {
  return parameter == "motor_target"
             ? "with motor_law = \"until_angle\", \"until_speed\", \"speed\" or \"angle\""
         : parameter == "motor_gain" ? "with motor_law = \"speed\" or \"angle\""
                                     : "with motor_law = \"angle\"";
}

void check_gain(const Design& design, const Scene& scene, std::string_view place) {
  if (has_gain(design, scene)) return;
  throw InputError(
      fmt::format("{}{}motor_gain = inf: motor_law = \"angle\" needs a gain; allowed: a finite number, for "
                  "example 5",
                  place, place.empty() ? "" : ": "));
}

bool is_allowed(const Design& design, const Scene& scene) {
  return !first_refused(design, scene) && has_gain(design, scene);
}

void check_design(const Design& design, const Scene& scene, std::string_view place) {
  const Parameter* refused = first_refused(design, scene);
  if (!refused) return check_gain(design, scene, place);
  const auto member = std::get<double Design::*>(refused->member);
  const double value = design.*member;
  if (!has(scene, refused->only_of)) refuse_unused(place, *refused, value, scene);
  if (is_unused_by_law(member, scene))
    refuse(place, *refused, value, no_use_by_law(scene), with_law(refused->name));
  refuse_range(place, *refused, value);
}

}  // namespace leapmap
