// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/variable.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "hoop/body.hpp"

namespace leapmap {
namespace {

constexpr double turn = 2.0 * std::numbers::pi, most_of_body = 1e6;

const std::array body_table{
    BodyNumber{"diameter", &Body::diameter, "m", true, "outer diameter of the hoop", {2e-9, most_of_body}},
    BodyNumber{"mass",
               &Body::mass,
               "kg",
               true,
               "mass of the ring and everything on it except the weights",
               {1e-9, most_of_body}},
    BodyNumber{"inertia",
               &Body::inertia,
               "kg m2",
               false,
               "moment of inertia of that ring about the axis; default: of a thin ring",
               {0.0, most_of_body}},
    BodyNumber{"mass", &Weight::mass, "kg", true, "mass of {}", {0.0, most_of_body}},
    BodyNumber{"at",
               &Weight::at,
               "m",
               true,
               "distance of the centre of {} from the axis, up to the radius",
               {0.0, 0.5 * most_of_body}},
    BodyNumber{
        "angle", &Weight::angle, "rad", false, "direction of the centre of {}; default: 0", {-turn, turn}},
    BodyNumber{"inertia",
               &Weight::inertia,
               "kg m2",
               false,
               "moment of inertia of {} about its own centre; default: 0",
               {0.0, most_of_body}}};

constexpr std::string_view section = "hoop.";

/// "hoop.slug.mass" as "slug" and "mass", "hoop.mass" as "" and "mass".
std::pair<std::string_view, std::string_view> split(std::string_view key) {
  key.remove_prefix(section.size());
  const std::size_t dot = key.find('.');
  return dot == key.npos ? std::pair{std::string_view{}, key}
                         : std::pair{key.substr(0, dot), key.substr(dot + 1)};
}

}  // namespace

std::string BodyNumber::meaning_of(std::string_view weight) const {
  std::string text(meaning);
  if (const std::size_t gap = text.find("{}"); gap != text.npos) text.replace(gap, 2, weight);
  return text;
}

std::span<const BodyNumber> body_numbers() { return body_table; }

const BodyNumber* find_body_number(std::string_view key) {
  if (!key.starts_with(section)) return nullptr;
  const auto [weight, name] = split(key);
  const bool of_weight = key.find('.', section.size()) != key.npos;
  for (const BodyNumber& row : body_table)
    if (row.name == name && row.of_weight() == of_weight) return &row;
  return nullptr;
}

std::string_view weight_of(std::string_view key) { return split(key).first; }

bool is_body_mass(std::string_view key) {
  const BodyNumber* row = find_body_number(key);
  return row && row->unit == "kg";
}

double& Variable::in(Design& design, Body& body) const {
  if (parameter_) return design.*parameter_;
  return ring_ ? body.*ring_ : body.weights[weight_].*of_weight_;
}

double Variable::of(const Design& design, const Body& body) const {
  if (parameter_) return design.*parameter_;
  return ring_ ? body.*ring_ : body.weights[weight_].*of_weight_;
}

double Variable::derivative(const Design& by, const Body& body, const ByScale& by_scale) const {
  if (parameter_) return by.*parameter_;
  using Number = Dual<double, 1>;
  const void* const here =
      ring_ ? static_cast<const void*>(&(body.*ring_)) : &(body.weights[weight_].*of_weight_);
  const auto ratios = reduce_by<Number>(body, [&](const auto& part, const auto member) {
    const double& number = part.*member;
    return &number == here ? Number::parameter(number, 0) : Number(number);
  });
  return by.mass_ratio * ratios.mass_ratio.by[0] + by.offset_ratio * ratios.offset_ratio.by[0] +
         by.inertia_factor * ratios.inertia_factor.by[0] +
         by_scale.mass * ratios.total_mass.by[0] / ratios.total_mass.value +
         (ring_ == &Body::diameter ? by_scale.size / body.diameter : 0.0);
}

std::vector<Variable> variables_of(const Body& body) {
  std::vector<Variable> given;
  const auto add = [&](const std::string& key) {
    if (const auto variable = find_variable(key, &body); variable && !std::isnan(variable->of({}, body)))
      given.push_back(*variable);
  };
  for (const BodyNumber& row : body_table) {
    if (!row.of_weight()) add(std::string(section) + std::string(row.name));
    for (const Weight& weight : body.weights)
      if (row.of_weight()) add(std::string(section) + weight.name + "." + std::string(row.name));
  }
  return given;
}

std::vector<Variable> parameters_of(std::span<const Variable> variables) {
  std::vector<Variable> found;
  const auto add = [&](std::string_view key) {
    if (std::none_of(found.begin(), found.end(), [&](const Variable& one) { return one.key == key; }))
      found.push_back(*find_variable(key, nullptr));
  };
  for (const Variable& variable : variables)
    if (!variable.of_body())
      add(variable.key);
    else
      for (const std::string_view ratio : {"mass_ratio", "offset_ratio", "inertia_factor"}) add(ratio);
  return found;
}

std::optional<Variable> find_variable(std::string_view key, const Body* body) {
  Variable variable;
  variable.key = key;
  const auto all = parameters();
  if (const auto row =
          std::find_if(all.begin(), all.end(), [&](const Parameter& one) { return one.name == key; });
      row != all.end()) {
    const auto* member = std::get_if<double Design::*>(&row->member);
    if (!member) return {};
    variable.parameter_ = *member;
    variable.unit = row->unit, variable.range = row->range, variable.only_of = row->only_of;
    variable.order = static_cast<std::size_t>(row - all.begin());
    return variable;
  }
  const BodyNumber* row = body ? find_body_number(key) : nullptr;
  if (!row) return {};
  variable.unit = row->unit, variable.range = row->range;
  variable.order = all.size() + static_cast<std::size_t>(row - body_table.data());
  if (!row->of_weight()) {
    variable.ring_ = std::get<double Body::*>(row->member);
    return variable;
  }
  const auto weight = std::find_if(body->weights.begin(), body->weights.end(),
                                   [&](const Weight& one) { return one.name == split(key).first; });
  if (weight == body->weights.end()) return {};
  variable.weight_ = static_cast<std::size_t>(weight - body->weights.begin());
  variable.of_weight_ = std::get<double Weight::*>(row->member);
  variable.order += (variable.weight_ + 1) * body_table.size();
  if (variable.of_weight_ == &Weight::at) variable.range.most = 0.5 * body->diameter;
  return variable;
}

}  // namespace leapmap
