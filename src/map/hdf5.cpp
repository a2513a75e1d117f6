// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "support/errors.hpp"

namespace leapmap::hdf5 {
namespace {

/// HDF5's reasons go from the call that was made to what really went wrong; the last one is worth telling.
herr_t keep_description(unsigned, const H5E_error2_t* error, void* reason) {
  if (error->desc && *error->desc) *static_cast<std::string*>(reason) = error->desc;
  return 0;
}

/// Of a system call's failure HDF5 tells time, name, buffer and offset, over several lines: the system's own
/// words do.
std::string in_one_line(std::string reason) {
  constexpr std::string_view system_words = "error message = '";
  if (const std::size_t found = reason.find(system_words); found != std::string::npos) {
    const std::size_t start = found + system_words.size();
    return reason.substr(start, reason.find('\'', start) - start);
  }
  std::ranges::replace(reason, '\n', ' ');
  return reason;
}

Handle scalar() { return {H5Screate(H5S_SCALAR), H5Sclose, "creating a dataspace"}; }

Handle simple(hsize_t count) {
  return {H5Screate_simple(1, &count, nullptr), H5Sclose, "creating a dataspace"};
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "creating a string type");
  check(H5Tset_size(type, H5T_VARIABLE), "creating a string type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "creating a string type");
  return type;
}

void write(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, hid_t space,
           const void* values) {
  const std::string what = fmt::format("writing attribute {}", name);
  const Handle attribute(H5Acreate2(object, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, what);
  check(H5Awrite(attribute, memory_type, values), what);
}

}  // namespace

void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_description, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw IoError(reason.empty() ? what : fmt::format("{}: {}", what, in_one_line(reason)));
}

void initialise() {
  static const bool done = [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  static_cast<void>(done);
}

Handle create_file(const std::string& path) {
  initialise();
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw IoError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, path);
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path);
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path);
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18), path);
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, path + ": cannot be created"};
}

Handle open_file(const std::string& path) {
  initialise();
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path + ": cannot be read as HDF5"};
}

Handle create_dataset(hid_t file, const DatasetPlan& plan) {
  const std::string what = fmt::format("creating dataset {}", plan.name);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), what);
  check(H5Pset_obj_track_times(creation, false), what);  // the same spec gives the same bytes
  if (!plan.chunk.empty())
    check(H5Pset_chunk(creation, static_cast<int>(plan.chunk.size()), plan.chunk.data()), what);
  if (plan.fill) check(H5Pset_fill_value(creation, plan.type, plan.fill), what);
  const Handle space(H5Screate_simple(static_cast<int>(plan.shape.size()), plan.shape.data(), nullptr),
                     H5Sclose, what);
  return {H5Dcreate2(file, plan.name.c_str(), plan.type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
          what};
}

void write_attribute(hid_t object, const std::string& name, std::string_view text) {
  const std::string terminated(text);
  const char* pointer = terminated.c_str();
  const Handle type = text_type();
  write(object, name, type, type, scalar(), &pointer);
}

void write_attribute(hid_t object, const std::string& name, double value) {
  write(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, scalar(), &value);
}

void write_attribute(hid_t object, const std::string& name, std::span<const double> values) {
  write(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, simple(values.size()), values.data());
}

void write_attribute(hid_t object, const std::string& name, std::span<const float> values) {
  write(object, name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, simple(values.size()), values.data());
}

void write_attribute(hid_t object, const std::string& name, std::int64_t value) {
  write(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, scalar(), &value);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> values) {
  write(object, name, H5T_STD_I32LE, H5T_NATIVE_INT32, simple(values.size()), values.data());
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::uint8_t> values) {
  write(object, name, H5T_STD_U8LE, H5T_NATIVE_UINT8, simple(values.size()), values.data());
}

void annotate(hid_t object, std::span<const Attribute> attributes) {
  for (const auto& [name, value] : attributes)
    std::visit([&, &key = name](const auto& v) { write_attribute(object, key, v); }, value);
}

void finish_file(Handle file, const std::string& part, const std::string& path) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL), part + ": cannot be written");
  if (!file.close()) fail(part + ": cannot be written");
  const int descriptor = ::open(part.c_str(), O_RDONLY);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!synced) throw IoError(fmt::format("{}: cannot be brought to disk: {}", part, std::strerror(reason)));
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw IoError(fmt::format("{}: cannot be given its name: {}", path, error.message()));
}

bool has_attribute(hid_t object, const std::string& name) { return H5Aexists(object, name.c_str()) > 0; }

std::string read_text(hid_t object, const std::string& name) {
  const std::string what = fmt::format("reading attribute {}", name);
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Handle file_type(H5Aget_type(attribute), H5Tclose, what);
  if (H5Tget_class(file_type) != H5T_STRING || H5Tis_variable_str(file_type) <= 0)
    throw IoError(what + ": it is not text");
  const Handle space(H5Aget_space(attribute), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space) != 1) throw IoError(what + ": it is not one text");
  const Handle type = text_type();
  char* text = nullptr;
  check(H5Aread(attribute, type, &text), what);
  std::string copy = text ? text : "";
  H5free_memory(text);
  return copy;
}

std::vector<hsize_t> shape_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose, "reading a shape");
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) fail("reading a shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  if (rank > 0 && H5Sget_simple_extent_dims(space, shape.data(), nullptr) < 0) fail("reading a shape");
  return shape;
}

}  // namespace leapmap::hdf5
