// SPDX-License-Identifier: GPL-3.0-or-later
#include "request/request.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "model/model.hpp"
#include "model/parameters.hpp"
#include "model/variable.hpp"
#include "spec/spec.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap {
namespace {

/// Quantities whose statistics a map of manufactured hoops has by default.
constexpr double Outcome::*usual[]{&Outcome::jump_height, &Outcome::jump_time};

bool is_asked_for(const Spec& spec, const Field& row) {
  if (std::ranges::find(spec.output.fields, row.name) != spec.output.fields.end()) return true;
  const OfMade& made = std::get<OfMade>(row.source);
  if (made.statistic == Statistic::worst_case) return false;
  if (!made.of) return made.statistic != Statistic::yield || !spec.goals.empty();
  if (made.error) return false;
  if (spec.output.fields.empty()) return std::ranges::find(usual, made.of) != std::end(usual);
  return std::ranges::any_of(spec.output.fields, [&](const std::string& name) {
    const auto* quantity = std::get_if<Quantity>(&find_field(name)->source);
    return quantity && quantity->member == made.of;
  });
}

bool is_statistic(const Field* column) { return std::holds_alternative<OfMade>(column->source); }

/// Whether a column of nominal designs is of jumps after the first.
bool is_of_later_jumps(const Field* column) {
  if (const auto* derivative = std::get_if<Derivative>(&column->source)) return derivative->of.jump > 1;
  return column->of_sequence && !is_statistic(column);
}

/// Whether some design of the spec may have a resisting torque.
bool is_resisted(const Spec& spec) {
  constexpr std::string_view name = "resisting_torque";
  const auto is_it = [&](const Axis& axis) { return axis.key == name; };
  return spec.design.resisting_torque != 0.0 || std::ranges::any_of(spec.axes, is_it) ||
         std::ranges::any_of(spec.list.columns, is_it) ||
         std::ranges::find(spec.scatter.spreads, name, &Spread::parameter) != spec.scatter.spreads.end();
}

/// The derivatives by what the spec gives: its parameters, and in place of the ratios the numbers of [hoop].
std::vector<const Field*> given_columns(const Spec& spec, const std::vector<OutcomeNumber>& of) {
  const std::vector<std::string>& by = spec.output.gradients_by;
  std::vector<const Field*> columns = derivative_columns(spec.scene, of, by);
  if (by.empty() && !is_resisted(spec))
    std::erase_if(columns, [](const Field* column) {
      return std::get<Derivative>(column->source).by == &Design::resisting_torque;
    });
  if (spec.hoop && by.empty())
    std::erase_if(columns, [](const Field* column) {
      return follows_from_body(std::get<Derivative>(column->source).by);
    });
  if (!spec.hoop) return columns;
  for (const OutcomeNumber& quantity : of)
    for (const Variable& variable : variables_of(*spec.hoop))
      if (by.empty() || std::ranges::find(by, variable.key) != by.end())
        columns.push_back(find_body_gradient(quantity, variable.key));
  return columns;
}

}  // namespace

std::vector<const Field*> columns_of(const Spec& spec) {
  std::vector<const Field*> columns;
  for (const Field* field : fields_of(spec.scene))
    if (stores(spec.output, *field)) columns.push_back(field);
  std::vector<OutcomeNumber> derived;
  for (const std::string& name : spec.output.gradients) derived.push_back(*number_of(*find_field(name)));
  std::ranges::copy(given_columns(spec, derived), std::back_inserter(columns));
  for (const Field& row : proof_fields())
    if (std::ranges::find(spec.output.fields, row.name) != spec.output.fields.end()) columns.push_back(&row);
  if (spec.scatter.spreads.empty()) return columns;
  for (const Field& row : scatter_fields())
    if (is_asked_for(spec, row)) columns.push_back(&row);
  return columns;
}

Request request_of(const Spec& spec) { return request_of(spec, columns_of(spec)); }

Request request_of(const Spec& spec, std::vector<const Field*> columns) {
  return {.scene = spec.scene,
          .numerics = spec.numerics,
          .columns = std::move(columns),
          .scatter = spec.scatter,
          .goals = spec.goals,
          .hoop = spec.hoop,
          .held = held_in_si(spec)};
}

Request request_of_outcomes(const Spec& spec) {
  std::vector<const Field*> columns = fields_of(spec.scene);
  std::erase_if(columns, [](const Field* field) { return field->by_default == ByDefault::left_out; });
  return request_of(spec, std::move(columns));
}

Request request_with_ways(const Spec& spec) {
  Request request = request_of_outcomes(spec);
  for (const Field* field : fields_of(spec.scene))
    if (field->of_way) request.columns.push_back(field);
  return request;
}

Request request_of_everything(const Spec& spec) { return request_of(spec, fields_of(spec.scene)); }

Request request_of_sample(const Request& request) {
  Request sample = request;
  sample.scatter = {}, sample.goals.clear();
  sample.columns = {find_field("status")};
  for (const Goal& goal : request.goals) add_column(sample.columns, find_field(goal.field));
  for (const Field* quantity : quantities_of(statistics_of(request))) add_column(sample.columns, quantity);
  return sample;
}

void add_column(std::vector<const Field*>& columns, const Field* column) {
  if (std::ranges::find(columns, column) == columns.end()) columns.push_back(column);
}

bool wants(const Request& request, std::string_view field) {
  return std::ranges::find(request.columns, field, &Field::name) != request.columns.end();
}

bool wants_samples(const Request& request) { return std::ranges::any_of(request.columns, is_statistic); }

bool wants_proofs(const Request& request) {
  return std::ranges::any_of(request.columns,
                             [](const Field* column) { return column->of_proof.has_value(); });
}

bool derives_by_body(const Request& request) {
  return std::ranges::any_of(request.columns, [](const Field* column) {
    const auto* derivative = std::get_if<Derivative>(&column->source);
    return derivative && !derivative->by;
  });
}

bool wants_gaits(const Request& request) {
  return request.scene.settle > 0 && std::ranges::any_of(request.columns, [](const Field* column) {
           return column->of_gait && !is_statistic(column);
         });
}

Scene scene_asked(const Request& request) {
  Scene scene = request.scene;
  if (std::ranges::none_of(request.columns, is_of_later_jumps)) scene.jumps = 1;
  return scene;
}

Scene scene_followed(const Request& request) {
  Scene scene = scene_asked(request);
  if (wants_gaits(request)) scene.jumps = std::max(scene.jumps, scene.settle);
  return scene;
}

GradientWanted derivatives_of(const Request& request) {
  GradientWanted wanted;
  for (const Field* column : request.columns) {
    const auto* derivative = std::get_if<Derivative>(&column->source);
    if (!derivative) continue;
    if (!wanted.wants(derivative->of)) wanted.of.push_back(derivative->of);
    const auto add = [&](double Design::*by) {
      const std::size_t place = place_of(by);
      if (std::ranges::find(wanted.by, place) == wanted.by.end()) wanted.by.push_back(place);
    };
    if (derivative->by)
      add(derivative->by);
    else {  // by way of these
      for (double Design::*ratio : body_ratios) add(ratio);
      for (const SameInSi& held : request.held) add(held.parameter);
    }
  }
  return wanted;
}

std::vector<const Field*> derivative_columns(const Scene& scene, const std::vector<OutcomeNumber>& of,
                                             const std::vector<std::string>& by) {
  std::vector<const Field*> columns;
  for (const OutcomeNumber& quantity : of)
    for (double Design::*member : differentiable) {
      const auto parameter = std::ranges::find_if(parameters(), [&](const Parameter& row) {
        const auto* same = std::get_if<double Design::*>(&row.member);
        return same && *same == member;
      });
      if (has(scene, parameter->only_of) &&
          (by.empty() || std::ranges::find(by, parameter->name) != by.end()))
        columns.push_back(find_gradient(quantity, member));
    }
  return columns;
}

std::vector<const Field*> statistics_of(const Request& request) {
  std::vector<const Field*> statistics;
  std::ranges::copy_if(request.columns, std::back_inserter(statistics), is_statistic);
  return statistics;
}

}  // namespace leapmap
