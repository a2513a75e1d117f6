// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/map_layout.hpp"

#include <fmt/format.h>

#include "request/request.hpp"
#include "spec/options.hpp"

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

MapLayout layout_of(const Spec& spec) {
  MapLayout layout;
  for (const Axis& axis : spec.axes) layout.axes.push_back(describe(*find_option("", axis.key), axis.values));
  if (spec.axes.empty())
    for (const Option* parameter : design_parameters(spec))
      layout.columns.push_back(describe(*parameter, list_values(spec, *parameter)));
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
  return spec.axes.empty() ? fmt::format("Jumps of {} hoop designs", spec.list.count)
                           : fmt::format("Jumps of passive hoops over {}", fmt::join(names, " x "));
}

}  // namespace leapmap
