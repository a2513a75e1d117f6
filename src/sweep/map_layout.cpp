// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/map_layout.hpp"

#include <fmt/format.h>

#include "model/model.hpp"
#include "sweep/options.hpp"
#include "sweep/scatter.hpp"
#include "sweep/solver.hpp"

namespace leapmap {
namespace {

/// Units that are products of the hoop's own are numbers to other programs, and told in words.
MapAxis describe(const Option& option, std::vector<double> values) {
  const bool own = option.unit != "rad" && option.unit != "1";
  return {std::string(option.key), std::string(own ? "1" : option.unit),
          own ? fmt::format("{}, in {}", option.meaning, option.unit) : std::string(option.meaning),
          std::move(values)};
}

}  // namespace

bool stores(const Spec& spec, const Field& field) {
  const bool silent = !has(spec.scene, field) || field.by_name;
  return stores(spec.output, field.name) && !(spec.output.fields.empty() && silent);
}

MapLayout layout_of(const Spec& spec) {
  MapLayout layout;
  for (const Axis& axis : spec.axes) layout.axes.push_back(describe(*find_option("", axis.key), axis.values));
  if (spec.axes.empty())
    for (const Option* parameter : design_parameters(spec))
      layout.columns.push_back(describe(*parameter, list_values(spec, *parameter)));
  layout.labels = spec.list.labels;
  for (const Field* field : fields_of(spec.scene))
    if (stores(spec, *field)) layout.fields.push_back(field);
  const GradientWanted derivatives = gradients_of(spec);
  for (const auto of : derivatives.of)
    for (const std::size_t by : derivatives.by)
      layout.fields.push_back(find_gradient(of, differentiable[by]));
  for (const Field* field : scatter_fields_of(spec)) layout.fields.push_back(field);
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
  return spec.axes.empty() ? fmt::format("Jumps of {} hoop designs", spec.list.count)
                           : fmt::format("Jumps of passive hoops over {}", fmt::join(names, " x "));
}

}  // namespace leapmap
