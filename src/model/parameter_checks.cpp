// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leapmap/errors.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"

namespace leapmap {
namespace {

constexpr double right_angle = std::numbers::pi / 2.0;

std::string shown(double value, std::string_view unit) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return unit == "rad" && value == right_angle ? "90 deg" : fmt::format("{}", value);
}

[[noreturn]] void refuse(std::string_view place, const Parameter& parameter, double value,
                         std::string_view what, std::string_view allowed) {
  throw InputError(fmt::format("{}{}{} = {} {}; allowed: {}", place, place.empty() ? "" : ": ",
                               parameter.name, value, what, allowed));
}

[[noreturn]] void refuse_unused(std::string_view place, const Parameter& parameter, double value,
                                const Scene& scene) {
  const std::string_view name = model_of(*parameter.only_of).name;
  refuse(place, parameter, value, fmt::format("has no use where the contact {}", model_of(scene).meaning),
         fmt::format("with friction = {}, on the command line --friction {}", name, name));
}

/// Whether a value is what a parameter has unless it is given; mu_kinetic then is mu_static's, or NaN.
bool is_usual(double value, double usual) {
  return value == usual || (std::isnan(usual) && (std::isnan(value) || value == Design{}.mu_static));
}

}  // namespace

std::string allowed_values(const Range& range, std::string_view unit, std::string_view what) {
  return fmt::format("{} in {}{}, {}{}{}", what, range.least_allowed ? '[' : '(', shown(range.least, unit),
                     shown(range.most, unit), range.most_allowed ? ']' : ')',
                     unit == "rad" ? ", in rad or as \"... deg\"" : "");
}

void check_scene(const Scene& scene) {
  constexpr Scene usual;
  for (const Parameter& parameter : parameters()) {
    const auto* member = std::get_if<double Scene::*>(&parameter.member);
    if (!member) continue;
    const double value = scene.**member;
    if (!has(scene.friction, parameter.only_of) && value != usual.**member)
      refuse_unused({}, parameter, value, scene);
    if (!parameter.range.holds(value))
      refuse({}, parameter, value, "is out of range", allowed_values(parameter.range, parameter.unit));
  }
}

namespace {

/// What keeps a design's parameter from being allowed in the scene, if anything does.
enum class Fault { none, unused, out_of_range };
Fault fault_of(const Parameter& parameter, double value, double usual, const Scene& scene) {
  if (!has(scene.friction, parameter.only_of)) return is_usual(value, usual) ? Fault::none : Fault::unused;
  const bool follows = std::isnan(value) && std::isnan(usual);
  return follows || parameter.range.holds(value) ? Fault::none : Fault::out_of_range;
}

}  // namespace

bool is_allowed(const Design& design, const Scene& scene) {
  constexpr Design usual;
  return std::ranges::all_of(parameters(), [&](const Parameter& parameter) {
    const auto* member = std::get_if<double Design::*>(&parameter.member);
    return !member || fault_of(parameter, design.**member, usual.**member, scene) == Fault::none;
  });
}

void check_design(const Design& design, const Scene& scene, std::string_view place) {
  constexpr Design usual;
  for (const Parameter& parameter : parameters()) {
    const auto* member = std::get_if<double Design::*>(&parameter.member);
    if (!member) continue;
    const double value = design.**member;
    const Fault fault = fault_of(parameter, value, usual.**member, scene);
    if (fault == Fault::unused) refuse_unused(place, parameter, value, scene);
    if (fault == Fault::out_of_range)
      refuse(place, parameter, value, "is out of range", allowed_values(parameter.range, parameter.unit));
  }
}

}  // namespace leapmap
