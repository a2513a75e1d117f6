// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/writer.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>
#include <unistd.h>

#include <array>
#include <cassert>
#include <filesystem>
#include <limits>

#include "support/errors.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;
using hdf5::check;
using hdf5::Handle;

void describe(hid_t dataset, std::string_view unit, std::string_view long_name) {
  hdf5::write_attribute(dataset, "long_name", long_name);
  hdf5::write_attribute(dataset, "units", unit);
}

/// One parameter's values, as a dataset of its own.
Handle write_values(hid_t file, const MapAxis& axis) {
  const hsize_t count = axis.values.size();
  Handle dataset = hdf5::create_dataset(file, {axis.name, H5T_IEEE_F64LE, {&count, 1}});
  check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, axis.values.data()),
        "writing " + axis.name);
  describe(dataset, axis.unit, axis.long_name);
  return dataset;
}

/// The dimensions of a map as dimension scales: its axes, or `design` counting a list's designs from 0.
std::vector<Handle> write_scales(hid_t file, const MapLayout& layout, std::size_t designs) {
  std::vector<Handle> scales;
  for (const MapAxis& axis : layout.axes) scales.push_back(write_values(file, axis));
  if (layout.axes.empty()) {
    std::vector<std::int64_t> numbers(designs);
    for (std::size_t i = 0; i < designs; ++i) numbers[i] = static_cast<std::int64_t>(i);
    const hsize_t count = designs;
    scales.push_back(hdf5::create_dataset(file, {"design", H5T_STD_I64LE, {&count, 1}}));
    check(H5Dwrite(scales[0], H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
          "writing design");
    describe(scales[0], "1", "number of the design in its list, from 0");
  }
  for (std::size_t i = 0; i < scales.size(); ++i)
    check(H5DSset_scale(scales[i], layout.axes.empty() ? "design" : layout.axes[i].name.c_str()),
          "making a dimension scale");
  return scales;
}

void attach(hid_t dataset, const std::vector<Handle>& scales) {
  for (std::size_t i = 0; i < scales.size(); ++i)
    check(H5DSattach_scale(dataset, scales[i], static_cast<unsigned>(i)), "attaching a dimension scale");
}

Handle create_field(hid_t file, const Field& field, bool single, std::span<const hsize_t> shape,
                    std::span<const hsize_t> chunk) {
  const std::string name(field.name);
  const auto* code = std::get_if<Code>(&field.source);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr float nanf = std::numeric_limits<float>::quiet_NaN();
  Handle dataset = code     ? hdf5::create_dataset(file, {name, H5T_STD_U8LE, shape, chunk, &code->fill})
                   : single ? hdf5::create_dataset(file, {name, H5T_IEEE_F32LE, shape, chunk, &nanf})
                            : hdf5::create_dataset(file, {name, H5T_IEEE_F64LE, shape, chunk, &nan});
  describe(dataset, field.unit, field.long_name);
  if (!code) {
    // netCDF wants the fill value in the dataset's own type
    single ? hdf5::write_attribute(dataset, "_FillValue", std::array{nanf})
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

std::vector<hsize_t> to_hsize(const std::vector<std::size_t>& extents) {
  return {extents.begin(), extents.end()};
}

/// Nothing that is there already is replaced unasked, nor what an interrupted sweep left.
void refuse_existing(const std::string& path, bool overwrite) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw InputError(path + ": is a folder; allowed: a file's name");
  if (overwrite) return;
  if (fs::exists(path, ignored))
    throw InputError(path + ": exists already; allowed: another -o, or --overwrite");
  if (fs::exists(path + ".part", ignored))
    throw InputError(
        path + ".part: is what an interrupted sweep left; allowed: another -o, or --overwrite to start anew");
}

}  // namespace

std::uint64_t map_bytes(const MapLayout& layout, const Tiling& tiling) {
  std::uint64_t per_design = layout.axes.empty() ? 8 + 8 * layout.columns.size() : 0;
  for (const Field* field : layout.fields)
    per_design += std::holds_alternative<Code>(field->source) ? 1 : layout.single ? 4 : 8;
  return per_design * tiling.designs();
}

MapWriter::MapWriter(const std::string& path, const MapLayout& layout, const Tiling& tiling,
                     std::span<const hdf5::Attribute> attributes, bool overwrite)
    : path_(path), part_(path + ".part"), fields_(layout.fields), time_unit_(layout.time_unit) {
  refuse_existing(path, overwrite);
  file_ = hdf5::create_file(part_);
  try {
    hdf5::annotate(file_, attributes);
    const std::vector<Handle> scales = write_scales(file_, layout, tiling.designs());
    for (const MapAxis& column : layout.columns) attach(write_values(file_, column), scales);
    const std::vector<hsize_t> shape = to_hsize(tiling.shape()), chunk = to_hsize(tiling.tile_shape());
    for (const Field* field : fields_) {
      datasets_.push_back(create_field(file_, *field, layout.single, shape, chunk));
      attach(datasets_.back(), scales);
    }
    flush();
  } catch (...) {
    ::unlink(part_.c_str());
    throw;
  }
}

MapWriter::~MapWriter() {
  if (settled_) return;
  datasets_.clear();
  file_.close();
  ::unlink(part_.c_str());
}

void MapWriter::write(const Tile& tile, std::span<const Outcome> outcomes) {
  assert(outcomes.size() == tile.count);
  const std::string what = part_ + ": cannot be written";
  const std::vector<hsize_t> start = to_hsize(tile.start), extent = to_hsize(tile.extent);
  const Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose,
                      what);
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const Handle space(H5Dget_space(datasets_[i]), H5Sclose, what);
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), what);
    if (const auto* quantity = std::get_if<Quantity>(&fields_[i]->source)) {
      const double unit = quantity->is_time ? time_unit_ : 1.0;
      quantities_.resize(outcomes.size());
      for (std::size_t j = 0; j < outcomes.size(); ++j) quantities_[j] = outcomes[j].*quantity->member * unit;
      check(H5Dwrite(datasets_[i], H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, quantities_.data()), what);
    } else {
      const auto& code = std::get<Code>(fields_[i]->source);
      codes_.resize(outcomes.size());
      for (std::size_t j = 0; j < outcomes.size(); ++j) codes_[j] = code.value(outcomes[j]);
      check(H5Dwrite(datasets_[i], H5T_NATIVE_UINT8, memory, space, H5P_DEFAULT, codes_.data()), what);
    }
  }
}

void MapWriter::flush() { check(H5Fflush(file_, H5F_SCOPE_LOCAL), part_ + ": cannot be written"); }

void MapWriter::close_datasets() {
  for (hdf5::Handle& dataset : datasets_)
    if (!dataset.close()) hdf5::fail(part_ + ": cannot be written");
  datasets_.clear();
}

void MapWriter::finish(std::span<const hdf5::Attribute> attributes) {
  hdf5::annotate(file_, attributes);
  close_datasets();
  hdf5::finish_file(std::move(file_), part_, path_);
  settled_ = true;
}

std::string MapWriter::keep_part() {
  settled_ = true;  // even if closing fails: what reached the disk may still be of use
  close_datasets();
  hdf5::finish_file(std::move(file_), part_, part_);
  return part_;
}

}  // namespace leapmap
