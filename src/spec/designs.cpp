// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/designs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "hoop/body.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"
#include "support/printable.hpp"

namespace leapmap {

std::vector<std::size_t> shape_of(const Spec& spec) {
  if (spec.axes.empty()) return {spec.list.count};
  std::vector<std::size_t> shape;
  for (const Axis& axis : spec.axes) shape.push_back(axis.values.size());
  return shape;
}

Tiling tiling_of(const Spec& spec) {
  const std::vector<std::size_t> shape = shape_of(spec);
  const bool proves = std::ranges::any_of(proof_fields(), [&](const Field& field) {
    return std::ranges::find(spec.output.fields, field.name) != spec.output.fields.end();
  });
  constexpr std::size_t some_cells = 128;  // a second or two; where discontinuities meet more
  if (proves) return Tiling(shape, some_cells);
  if (spec.scatter.spreads.empty() && !model_of(spec.scene).slips) return Tiling(shape);
  if (spec.scatter.spreads.empty()) {
    // Some hoops take a hundred times as long as others: tiles are small enough that shards come out even.
    // But a hoop that jumps on and on fills a lane by itself, and the others stay empty unless more of its
    // tile do the same.
    const std::size_t designs = designs_of(shape), most = std::clamp<std::size_t>(designs / 192, 256, 2048);
    if (spec.scene.settle == 0) return Tiling(shape, most);
    return Tiling(shape, std::max<std::size_t>(most, 512), std::clamp<std::size_t>(designs / 8, 64, 512));
  }
  constexpr std::size_t most_hoops = 1 << 20;  // of a tile: some tenths of a second, with friction seconds
  const std::size_t most =
      std::max<std::size_t>(most_hoops / static_cast<std::size_t>(spec.scatter.samples), 1);
  if (!model_of(spec.scene).slips) return Tiling(shape, most);
  // Along the last axis as long as can be: hoops made after lines of drawings are interpolated.
  std::vector<std::size_t> lines(shape.size(), 1);
  std::size_t left = std::min(most, std::max<std::size_t>(designs_of(shape) / 64, 64));
  for (std::size_t k = shape.size(); k-- > 0;) left /= lines[k] = std::min(shape[k], left);
  return Tiling(shape, lines);
}

const Axis* find_varying(const Spec& spec, std::string_view key) {
  for (const auto* varying : {&spec.axes, &spec.list.columns})
    for (const Axis& axis : *varying)
      if (axis.key == key) return &axis;
  return nullptr;
}

VariedDesigns::VariedDesigns(const Spec& spec, const std::vector<Axis>& axes)
    : design_(spec.design), body_(spec.hoop.value_or(Body{})), held_(held_in_si(spec)) {
  for (const Axis& axis : axes) {
    variables_.push_back(*find_variable(axis.key, spec.hoop ? &*spec.hoop : nullptr));
    varies_body_ = varies_body_ || variables_.back().of_body();
  }
  if (varies_body_) mass_ = reduce_checked(body_).total_mass;
}

Design VariedDesigns::at(std::span<const double> values, Body* wanted) const {
  assert(values.size() == variables_.size());
  Design design = design_;
  Body own;  // not copied where none is needed
  Body& body = wanted ? *wanted : own;
  if (wanted || varies_body_) body = body_;
  for (std::size_t k = 0; k < values.size(); ++k) variables_[k].in(design, body) = values[k];
  if (!varies_body_) return design;
  follow_body(body, body_.diameter, mass_, design);
  hold_in_si(held_, design.mass, design.size, design);
  return design;
}

std::vector<double> list_values(const Spec& spec, const Option& parameter) {
  const auto& columns = spec.list.columns;
  const auto column = std::ranges::find(columns, parameter.key, &Axis::key);
  if (column != columns.end()) return column->values;
  if (std::isnan(value_of(parameter, spec.design)))  // it follows another
    return list_values(spec, *find_option("scene", "mu_static"));
  const DesignSpace space(spec);
  if (!space.varies_body()) return std::vector(spec.list.count, value_of(parameter, spec.design));
  std::vector<double> values;
  for (std::size_t i = 0; i < spec.list.count; ++i) values.push_back(value_of(parameter, space.at(i)));
  for (const SameInSi& held : held_in_si(spec))
    if (held.parameter == member_of(parameter))
      values.assign(spec.list.count, value_of(parameter, spec.design));
  return values;
}

DesignSpace::DesignSpace(const Spec& spec)
    : spec_(spec), varied_(spec, spec.axes.empty() ? spec.list.columns : spec.axes) {}

void DesignSpace::take_values(const std::vector<std::size_t>& position, std::vector<double>& values) const {
  const bool list = spec_.axes.empty();
  const std::vector<Axis>& along = list ? spec_.list.columns : spec_.axes;
  values.clear();
  for (std::size_t k = 0; k < along.size(); ++k) values.push_back(along[k].values[position[list ? 0 : k]]);
}

std::vector<double> DesignSpace::values(std::size_t index) const {
  std::vector<std::size_t> position;
  unravel(index, shape_of(spec_), position);
  std::vector<double> values;
  take_values(position, values);
  return values;
}

Design DesignSpace::at(std::size_t index) const { return varied_.at(values(index)); }

void DesignSpace::fill(const Tile& tile, std::size_t first, std::span<Design> designs,
                       std::span<Body> bodies) const {
  assert(first + designs.size() <= tile.count);
  std::vector<std::size_t> position;
  unravel(first, tile.extent, position);
  for (std::size_t k = 0; k < position.size(); ++k) position[k] += tile.start[k];
  const std::size_t last = position.size() - 1, row = tile.start[last] + tile.extent[last];
  // Along the last axis one parameter changes, unless it is a number of the body.
  const bool in_rows = !spec_.axes.empty() && !varied_.varies_body();
  std::vector<double> values;
  for (std::size_t i = 0; i < designs.size();) {
    take_values(position, values);
    designs[i] = varied_.at(values, bodies.empty() ? nullptr : &bodies[i]);
    ++i, ++position[last];
    // Always the same one is copied: one that has just been changed would have to reach memory first.
    const Design& pattern = designs[i - 1];
    for (; in_rows && i < designs.size() && position[last] < row; ++i, ++position[last]) {
      designs[i] = pattern;
      designs[i].*varied_.variables()[last].parameter() = spec_.axes[last].values[position[last]];
    }
    for (std::size_t k = last; k > 0 && position[k] == tile.start[k] + tile.extent[k]; --k)
      position[k] = tile.start[k], ++position[k - 1];
  }
}

std::string told_design(const Spec& spec, std::size_t number) {
  const bool named = spec.axes.empty() && number < spec.list.labels.size();
  return named ? fmt::format("{} ({})", number, printable(spec.list.labels[number]))
               : fmt::format("{}", number);
}

std::string hop_command(const Spec& spec, const Design& design) {
  std::string command = "leapmap hop";
  for (const Option* parameter : design_parameters(spec))
    if (const double value = value_of(*parameter, design); !std::isnan(value))
      command += fmt::format(" {} {}", flag_of(*parameter), value);
  if (spec.scene.model != Scene{}.model)
    command +=
        fmt::format(" --model {} --motor-law {}", name_of(spec.scene.model), name_of(spec.scene.motor_law));
  if (spec.scene.friction != Scene{}.friction)
    command += fmt::format(" --friction {}", model_of(spec.scene).name);
  const Scales scales = scales_of(spec, design);
  const double wall = 0.5 * wall_in_radii(spec.scene, design.size);
  for (const Parameter& parameter : parameters())
    if (const auto* member = std::get_if<double Scene::*>(&parameter.member);
        member && has(spec.scene, parameter.only_of) && !(*member == &Scene::mass && scales.mass == 0.0))
      command += fmt::format(" --set {}={}", parameter.name,
                             *member == &Scene::radius         ? scales.radius
                             : *member == &Scene::mass         ? scales.mass
                             : *member == &Scene::clear_height ? wall
                                                               : spec.scene.**member);
  if (!spec.scene.motor_in_flight && design.drive_torque != 0.0) command += " --set motor_in_flight=false";
  if (spec.scene.jumps > 1) command += fmt::format(" --set scene.jumps={}", spec.scene.jumps);
  if (spec.scene.settle > 0)
    command += fmt::format(" --set gait.settle={} --set gait.most_period={} --set gait.tolerance={}",
                           spec.scene.settle, spec.scene.most_period, spec.scene.gait_tolerance);
  command +=
      fmt::format(" --set method={} --set tolerance={}", resolved_method(spec), spec.numerics.tolerance);
  if (spec.numerics.absolute_tolerance > 0.0)
    command += fmt::format(" --set absolute_tolerance={}", spec.numerics.absolute_tolerance);
  if (spec.numerics.fixed_step > 0.0)
    command += fmt::format(" --set fixed_step={}", spec.numerics.fixed_step);
  if (spec.numerics.max_steps != Numerics{}.max_steps)
    command += fmt::format(" --set max_steps={}", spec.numerics.max_steps);
  return command;
}

}  // namespace leapmap
