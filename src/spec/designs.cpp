// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/designs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "model/model.hpp"
#include "spec/options.hpp"
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
  if (spec.scatter.spreads.empty() && !model_of(spec.scene).slips) return Tiling(shape);
  if (spec.scatter.spreads.empty()) {
    // Some hoops take a hundred times as long as others: small enough that shards come out even.
    const std::size_t designs = designs_of(shape);
    return Tiling(shape, std::clamp<std::size_t>(designs / 512, 128, 2048));
  }
  constexpr std::size_t most_hoops = 1 << 20;  // of a tile: some tenths of a second, with friction seconds
  return Tiling(shape, std::max<std::size_t>(most_hoops / static_cast<std::size_t>(spec.scatter.samples), 1));
}

DesignSpace::DesignSpace(const Spec& spec) : spec_(spec) {
  for (const Axis& axis : spec.axes.empty() ? spec.list.columns : spec.axes)
    members_.push_back(member_of(axis.key));
}

Design DesignSpace::at_position(const std::vector<std::size_t>& position) const {
  Design design = spec_.design;
  const bool list = spec_.axes.empty();
  for (std::size_t i = 0; i < members_.size(); ++i)
    design.*members_[i] =
        list ? spec_.list.columns[i].values[position[0]] : spec_.axes[i].values[position[i]];
  return design;
}

Design DesignSpace::at(std::size_t index) const {
  std::vector<std::size_t> position;
  unravel(index, shape_of(spec_), position);
  return at_position(position);
}

void DesignSpace::fill(const Tile& tile, std::size_t first, std::span<Design> designs) const {
  assert(first + designs.size() <= tile.count);
  std::vector<std::size_t> position;
  unravel(first, tile.extent, position);
  for (std::size_t k = 0; k < position.size(); ++k) position[k] += tile.start[k];
  if (spec_.axes.empty()) {
    for (Design& design : designs) design = at_position(position), ++position[0];
    return;
  }
  const std::size_t last = members_.size() - 1, row = tile.start[last] + tile.extent[last];
  for (std::size_t i = 0; i < designs.size();) {  // row after row along the last axis
    const Design current = at_position(position);
    for (; i < designs.size() && position[last] < row; ++i, ++position[last]) {
      designs[i] = current;
      designs[i].*members_[last] = spec_.axes[last].values[position[last]];
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
  if (spec.scene.friction != Scene{}.friction)
    command += fmt::format(" --friction {}", model_of(spec.scene).name);
  for (const Parameter& parameter : parameters())
    if (const auto* member = std::get_if<double Scene::*>(&parameter.member);
        member && has(spec.scene.friction, parameter.only_of) &&
        !(*member == &Scene::mass && spec.scene.mass == 0.0))
      command += fmt::format(" --set {}={}", parameter.name, spec.scene.**member);
  if (spec.scene.jumps > 1) command += fmt::format(" --set scene.jumps={}", spec.scene.jumps);
  if (spec.scene.settle > 0)
    command += fmt::format(" --set gait.settle={} --set gait.most_period={} --set gait.tolerance={}",
                           spec.scene.settle, spec.scene.most_period, spec.scene.gait_tolerance);
  command += fmt::format(" --set method={} --set tolerance={}", resolved_method(spec.numerics),
                         spec.numerics.tolerance);
  if (spec.numerics.absolute_tolerance > 0.0)
    command += fmt::format(" --set absolute_tolerance={}", spec.numerics.absolute_tolerance);
  if (spec.numerics.fixed_step > 0.0)
    command += fmt::format(" --set fixed_step={}", spec.numerics.fixed_step);
  if (spec.numerics.max_steps != Numerics{}.max_steps)
    command += fmt::format(" --set max_steps={}", spec.numerics.max_steps);
  return command;
}

}  // namespace leapmap
