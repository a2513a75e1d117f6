// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/layout.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "leapmap/errors.hpp"
#include "numerics/nan.hpp"

namespace leapmap {
namespace {

using hdf5::check;
using hdf5::Handle;

constexpr std::uint64_t no_word = 0;
constexpr float nanf = std::numeric_limits<float>::quiet_NaN();
constexpr const char* label_long_name = "name of the design in its list";
constexpr const char* design_long_name = "number of the design in its list, from 0";

void describe(hid_t dataset, std::string_view unit, std::string_view long_name) {
  hdf5::write_attribute(dataset, "long_name", long_name);
  hdf5::write_attribute(dataset, "units", unit);
}

Handle write_axis(hid_t file, const MapAxis& axis, const Handle* scale) {
  return hdf5::write_series(file, axis.name, axis.unit, axis.long_name, axis.values, scale);
}

/// The dimensions of a map as dimension scales: its axes, or `design` counting a list's designs from 0.
std::vector<Handle> write_scales(hid_t file, const MapLayout& layout, std::size_t designs) {
  std::vector<Handle> scales;
  for (const MapAxis& axis : layout.axes) scales.push_back(write_axis(file, axis, nullptr));
  if (!layout.axes.empty()) return scales;
  std::vector<std::int64_t> numbers(designs);
  std::iota(numbers.begin(), numbers.end(), 0);
  const hsize_t count = designs;
  scales.push_back(hdf5::create_dataset(file, {"design", H5T_STD_I64LE, {&count, 1}}));
  check(H5Dwrite(scales[0], H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        "writing design");
  describe(scales[0], "1", design_long_name);
  check(H5DSset_scale(scales[0], "design"), "making a dimension scale");
  return scales;
}

void close(std::vector<Handle>& handles, const std::string& what) {
  for (Handle& handle : handles) handle.close(what);
}

void attach(hid_t dataset, const std::vector<Handle>& scales) {
  for (std::size_t i = 0; i < scales.size(); ++i)
    check(H5DSattach_scale(dataset, scales[i], static_cast<unsigned>(i)), "attaching a dimension scale");
}

std::vector<hsize_t> to_hsize(const std::vector<std::size_t>& extents) {
  return {extents.begin(), extents.end()};
}

Handle create_field(hid_t file, const Field& field, const MapLayout& layout, const Tiling& tiling,
                    std::span<const hdf5::Source> sources) {
  const std::vector<hsize_t> shape = to_hsize(tiling.shape()), chunk = to_hsize(tiling.tile_shape());
  const auto* code = std::get_if<Code>(&field.source);
  const bool word = std::holds_alternative<Word>(field.source);
  const hid_t type = code                       ? H5T_STD_U8LE
                     : word                     ? H5T_STD_U64LE
                     : is_single(layout, field) ? H5T_IEEE_F32LE
                                                : H5T_IEEE_F64LE;
  const void* fill = fill_value(layout, field);
  const std::string name(field.name);
  Handle dataset = hdf5::create_dataset(
      file, sources.empty() ? hdf5::DatasetPlan{name, type, shape, chunk, fill, layout.compression, true}
                            : hdf5::DatasetPlan{name, type, shape, {}, fill, 0, false, sources});
  describe(dataset, field.unit, field.long_name);
  if (word) return dataset;
  if (!code) {
    // netCDF wants the fill value in the dataset's own type
    is_single(layout, field) ? hdf5::write_attribute(dataset, "_FillValue", std::array{nanf})
                             : hdf5::write_attribute(dataset, "_FillValue", std::array{nan});
    return dataset;
  }
  hdf5::write_attribute(dataset, "_FillValue", std::array{code->fill});
  if (code->names.empty()) return dataset;
  std::vector<std::uint8_t> values(code->names.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i);
  hdf5::write_attribute(dataset, "flag_values", values);
  hdf5::write_attribute(dataset, "flag_meanings", fmt::format("{}", fmt::join(code->names, " ")));
  return dataset;
}

Handle create_group(hid_t parent, const char* name, std::string_view nexus_class) {
  Handle group(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
               fmt::format("creating group {}", name));
  hdf5::write_attribute(group, "NX_class", nexus_class);
  return group;
}

/// NeXus's way to say what to plot (NXdata: signal and axes), for silx and H5Web. Links are soft: netCDF's
/// readers pass over them and do not see each dataset twice.
void write_nexus(hid_t file, const MapLayout& layout) {
  hdf5::write_attribute(file, "NX_class", "NXroot");
  hdf5::write_attribute(file, "default", "entry");
  const Handle entry = create_group(file, "entry", "NXentry"), data = create_group(entry, "data", "NXdata");
  hdf5::write_attribute(entry, "default", "data");
  std::vector<std::string> axes, signals;
  for (const MapAxis& axis : layout.axes) axes.push_back(axis.name);
  if (axes.empty()) axes.push_back("design");
  for (const Field* field : layout.fields) signals.emplace_back(field->name);
  for (const auto* names : {&axes, &signals})
    for (const std::string& name : *names)
      check(H5Lcreate_soft(("/" + name).c_str(), data, name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
            "linking " + name);
  hdf5::write_attribute(data, "axes", axes);
  hdf5::write_attribute(data, "signal", signals.front());
  signals.erase(signals.begin());
  if (!signals.empty()) hdf5::write_attribute(data, "auxiliary_signals", signals);
}

}  // namespace

const void* fill_value(const MapLayout& layout, const Field& field) {
  if (const auto* code = std::get_if<Code>(&field.source)) return &code->fill;
  if (std::holds_alternative<Word>(field.source)) return &no_word;
  return is_single(layout, field) ? static_cast<const void*>(&nanf) : &nan;
}

bool is_single(const MapLayout& layout, const Field& field) {
  return layout.single && !std::holds_alternative<Word>(field.source) && !field.of_proof;
}

std::size_t value_bytes(const MapLayout& layout, const Field& field) {
  if (std::holds_alternative<Code>(field.source)) return 1;
  return is_single(layout, field) ? 4 : 8;
}

std::uint64_t map_bytes(const MapLayout& layout, const Tiling& tiling) {
  std::uint64_t per_design = layout.axes.empty() ? 8 + 8 * layout.columns.size() : 0;
  for (const Field* field : layout.fields) per_design += value_bytes(layout, *field);
  std::size_t label = 0;
  for (const std::string& each : layout.labels) label = std::max(label, each.size());
  per_design += label;
  return per_design * tiling.designs();
}

std::vector<Handle> lay_out(hid_t file, const MapLayout& layout, const Tiling& tiling,
                            std::span<const hdf5::Source> sources) {
  std::vector<Handle> scales = write_scales(file, layout, tiling.whole_designs());
  for (const MapAxis& column : layout.columns)
    write_axis(file, column, &scales[0]).close("writing " + column.name);
  if (!layout.labels.empty())
    hdf5::write_series(file, label_name, "1", label_long_name, layout.labels, &scales[0])
        .close("writing labels");
  std::vector<Handle> fields;
  for (const Field* field : layout.fields) {
    fields.push_back(create_field(file, *field, layout, tiling, sources));
    attach(fields.back(), scales);
  }
  close(scales, "writing a dimension");
  write_nexus(file, layout);
  return fields;
}

void check_layout(hid_t file, const MapLayout& layout, const Tiling& tiling, const std::string& path) {
  const auto check_one = [&](const std::string& name, const std::string& unit, const std::string& long_name,
                             const std::vector<double>& values) {
    Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "opening " + name);
    bool same =
        hdf5::read_text(dataset, "units") == unit && hdf5::read_text(dataset, "long_name") == long_name;
    if (!values.empty()) {
      same = same && hdf5::shape_of(dataset) == std::vector<hsize_t>{values.size()} &&
             hdf5::read_block(dataset, {0}, {values.size()}, "reading " + name) == values;
    }
    if (!same) throw BrokenFile(fmt::format("{}: {} differs from what was written", path, name));
    return dataset;
  };
  for (const auto* axes : {&layout.axes, &layout.columns})
    for (const MapAxis& axis : *axes) check_one(axis.name, axis.unit, axis.long_name, axis.values);
  if (layout.axes.empty()) {
    std::vector<double> numbers(tiling.whole_designs());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    check_one("design", "1", design_long_name, numbers);
    if (!layout.labels.empty() && !hdf5::holds(file, label_name, layout.labels))
      throw BrokenFile(path + ": label differs from what was written");
  }
  for (const Field* field : layout.fields) {
    const Handle dataset =
        check_one(std::string(field->name), std::string(field->unit), std::string(field->long_name), {});
    if (hdf5::sources_of(dataset).empty() && hdf5::chunk_of(dataset) != to_hsize(tiling.tile_shape()))
      throw BrokenFile(fmt::format("{}: {} is stored in other chunks", path, field->name));
  }
}

std::vector<Handle> open_fields(hid_t file, const MapLayout& layout) {
  std::vector<Handle> datasets;
  for (const Field* field : layout.fields) {
    const std::string name(field->name);
    datasets.emplace_back(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "opening " + name);
  }
  return datasets;
}

}  // namespace leapmap
