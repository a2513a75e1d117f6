// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/reader.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <filesystem>

#include "map/schema.hpp"
#include "support/errors.hpp"

namespace leapmap {
namespace {

using hdf5::check;
using hdf5::Handle;

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

int format_version(hid_t file, const std::string& path) {
  const std::string what = path + ": reading the format's version";
  const Handle attribute(H5Aopen(file, "version", H5P_DEFAULT), H5Aclose, what);
  const Handle space(H5Aget_space(attribute), H5Sclose, what);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 1 || count > 8) throw IoError(what + ": it has no major number");
  std::vector<std::int32_t> version(static_cast<std::size_t>(count));
  check(H5Aread(attribute, H5T_NATIVE_INT32, version.data()), what);
  return version[0];
}

std::vector<double> read_all(hid_t dataset, const std::string& name) {
  const std::vector<hsize_t> shape = hdf5::shape_of(dataset);
  if (shape.size() != 1 || shape[0] == 0)
    throw IoError(name + ": a dimension of a map has one row of values, at least one");
  std::vector<double> values(shape[0]);
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "reading " + name);
  return values;
}

}  // namespace

MapReader::MapReader(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw IoError(path + ": there is no such file");
  file_ = hdf5::open_file(path);
  if (!hdf5::has_attribute(file_, "filetype") || hdf5::read_text(file_, "filetype") != map_filetype)
    throw IoError(
        fmt::format("{}: is not a leapmap map (its attribute filetype is not \"{}\")", path, map_filetype));
  if (const int major = format_version(file_, path); major > format_major)
    throw IoError(fmt::format("{}: has format version {}; this program reads up to {}: use a newer leapmap",
                              path, major, format_major));

  std::vector<std::string> names;
  check(H5Literate(file_, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect_name, &names),
        path + ": listing datasets");
  for (const std::string& name : names) {
    const Handle dataset = open(name);
    if (H5DSis_scale(dataset) > 0) {
      dimensions_.push_back({name, hdf5::read_text(dataset, "units"), read_all(dataset, name)});
    } else {
      fields_.push_back(name);
    }
  }
  if (dimensions_.empty()) throw IoError(path + ": has no dimensions");
  std::vector<hsize_t> expected;
  for (const Dimension& dimension : dimensions_) expected.push_back(dimension.values.size());
  for (const std::string& name : fields_)
    if (hdf5::shape_of(open(name)) != expected)
      throw IoError(fmt::format("{}: {} does not lie along the map's dimensions", path, name));
}

std::vector<std::size_t> MapReader::shape() const {
  std::vector<std::size_t> shape;
  for (const Dimension& dimension : dimensions_) shape.push_back(dimension.values.size());
  return shape;
}

std::string MapReader::unit(const std::string& field) const { return hdf5::read_text(open(field), "units"); }

std::string MapReader::attribute(const std::string& name) const {
  if (!hdf5::has_attribute(file_, name)) return "";
  const Handle attribute(H5Aopen(file_, name.c_str(), H5P_DEFAULT), H5Aclose, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, name);
  if (H5Tget_class(type) == H5T_STRING) return hdf5::read_text(file_, name);
  const Handle space(H5Aget_space(attribute), H5Sclose, name);
  if (H5Sget_simple_extent_npoints(space) != 1) return "";
  double value = 0.0;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), "reading attribute " + name);
  return fmt::format("{}", value);
}

std::vector<double> MapReader::read(const std::string& field, const Tile& block) const {
  const std::string what = fmt::format("{}: reading {}", path_, field);
  const Handle dataset = open(field);
  const std::vector<hsize_t> start(block.start.begin(), block.start.end()),
      extent(block.extent.begin(), block.extent.end());
  const Handle space(H5Dget_space(dataset), H5Sclose, what);
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), what);
  const Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose,
                      what);
  std::vector<double> values(block.count);
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()), what);
  return values;
}

Handle MapReader::open(const std::string& dataset) const {
  return {H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose,
          fmt::format("{}: opening {}", path_, dataset)};
}

}  // namespace leapmap
