// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/map_layout.hpp"

#include <fmt/format.h>

#include "request/request.hpp"
#include "spec/designs.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap {
namespace {

/// Units that are products of the hoop's own are numbers to other programs, and told in words.
MapAxis describe(const Spec& spec, const Axis& axis) {
  const Option& option = *find_option("", axis.key);
  const BodyNumber* of_body = find_body_number(axis.key);
  const OwnUnit* unit = find_own_unit(option.unit);
  const bool own = unit && unit->name != unit->si;
  const std::string meaning =
      of_body ? of_body->meaning_of(weight_of(axis.key)) : std::string(option.meaning);
  const bool held = is_held(spec, axis.key);
  return {
      axis.key, std::string(own ? "1" : option.unit),
      own ? fmt::format("{}, in {}{}", meaning, option.unit, held ? " of the nominal hoop" : "") : meaning,
      axis.values};
}

}  // namespace

MapLayout layout_of(const Spec& spec) {
  MapLayout layout;
  for (const Axis& axis : spec.axes) layout.axes.push_back(describe(spec, axis));
  if (spec.axes.empty()) {
    for (const Axis& column : spec.list.columns)
      if (find_body_number(column.key)) layout.columns.push_back(describe(spec, column));
    for (const Option* parameter : design_parameters(spec))
      layout.columns.push_back(describe(spec, {std::string(parameter->key), list_values(spec, *parameter)}));
  }
  layout.labels = spec.list.labels;
  layout.fields = columns_of(spec);
  layout.single = spec.output.precision == "f4";
  layout.compression = static_cast<int>(spec.output.compression);
  return layout;
}

double map_file_bytes(const MapLayout& layout, const Tiling& tiling) {
  constexpr double structure = 5e4;  // HDF5's own, and attributes
  return static_cast<double>(map_bytes(layout, tiling)) + structure;
}

std::string title_of(const Spec& spec) {
  std::vector<std::string_view> names;
  for (const Axis& axis : spec.axes) names.push_back(axis.key);
  const bool driven = spec.scene.model == Mechanism::pendulum;
  return spec.axes.empty()
             ? fmt::format("Jumps of {} {} designs", spec.list.count, driven ? "pendulum" : "hoop")
             : fmt::format("Jumps of {} over {}", driven ? "hoops with a driven pendulum" : "passive hoops",
                           fmt::join(names, " x "));
}

}  // namespace leapmap
