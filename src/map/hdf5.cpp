// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include "leapmap/errors.hpp"
#include "map/hdf5_trust.hpp"

namespace leapmap::hdf5 {
namespace {

/// HDF5's reasons go from the call that was made to what really went wrong; the last one is worth telling.
herr_t keep_description(unsigned, const H5E_error2_t* error, void* reason) noexcept {
  try {
    if (error->desc && *error->desc) *static_cast<std::string*>(reason) = error->desc;
    return 0;
  } catch (const std::bad_alloc&) {  // none may pass through C: HDF5 would stay locked
    return -1;
  }
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

/// An attribute to be written: the one that is there if it has that type and shape, else a new one. HDF5
/// numbers attributes as they are created, up to 65,535, so that one written again and again must not be a
/// new one.
Handle writable_attribute(hid_t object, const std::string& name, hid_t type, hid_t space,
                          const std::string& what) {
  if (has_attribute(object, name)) {
    Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
    const Handle old_type(H5Aget_type(attribute), H5Tclose, what),
        old_space(H5Aget_space(attribute), H5Sclose, what);
    if (H5Tequal(old_type, type) > 0 && H5Sextent_equal(old_space, space) > 0) return attribute;
  }
  remove_attribute(object, name);
  return {H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what};
}

void write(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, hid_t space,
           const void* values) {
  const std::string what = fmt::format("writing attribute {}", name);
  check(H5Awrite(writable_attribute(object, name, file_type, space, what), memory_type, values), what);
}

/// What a series looks like to HDF5: one pointer to all values, and types in the file and in memory.
struct SeriesView {
  Handle text;  ///< the type of texts, where they are
  std::vector<const char*> texts;
  const void* values = nullptr;
  hid_t file_type = H5I_INVALID_HID, memory_type = H5I_INVALID_HID;
};

SeriesView view_of(const SeriesValues& values) {
  SeriesView view;
  if (const auto* numbers = std::get_if<std::vector<double>>(&values)) {
    view.values = numbers->data();
    view.file_type = H5T_IEEE_F64LE, view.memory_type = H5T_NATIVE_DOUBLE;
  } else if (const auto* codes = std::get_if<Codes>(&values)) {
    view.values = codes->values.data();
    view.file_type = H5T_STD_U8LE, view.memory_type = H5T_NATIVE_UINT8;
  } else {
    for (const std::string& text : std::get<std::vector<std::string>>(values))
      view.texts.push_back(text.c_str());
    view.text = text_type();
    view.values = view.texts.data();
    view.file_type = view.memory_type = view.text;
  }
  return view;
}

/// The dataspaces of a block, in memory and in the file.
std::pair<Handle, Handle> select(hid_t dataset, const std::vector<std::size_t>& start,
                                 const std::vector<std::size_t>& extent, const std::string& what) {
  const std::vector<hsize_t> from(start.begin(), start.end()), by(extent.begin(), extent.end());
  Handle file(H5Dget_space(dataset), H5Sclose, what);
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, from.data(), nullptr, by.data(), nullptr), what);
  Handle memory(H5Screate_simple(static_cast<int>(by.size()), by.data(), nullptr), H5Sclose, what);
  return {std::move(memory), std::move(file)};
}

hssize_t points_of(hid_t attribute, const std::string& what) {
  const Handle space(H5Aget_space(attribute), H5Sclose, what);
  return H5Sget_simple_extent_npoints(space);
}

/// Whether a dataset of texts holds these.
bool holds_texts(hid_t dataset, const std::vector<std::string>& texts, const std::string& what) {
  const Handle type = text_type(), space(H5Dget_space(dataset), H5Sclose, what);
  std::vector<char*> read(texts.size());
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), what);
  const bool same = std::ranges::equal(
      read, texts, [](const char* there, const std::string& here) { return (there ? there : "") == here; });
  check(H5Dvlen_reclaim(type, space, H5P_DEFAULT, read.data()), what);
  return same;
}

/// Memory for the texts of others' files, which may all point at one that is as long as the file.
struct TextMemory {
  std::size_t most_bytes = 0;
};
void* allocate_text(std::size_t bytes, void* memory) noexcept {
  return bytes <= static_cast<TextMemory*>(memory)->most_bytes ? std::malloc(bytes) : nullptr;
}
void free_text(void* text, void*) noexcept { std::free(text); }

}  // namespace

void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_description, &reason);
  H5Eclear2(H5E_DEFAULT);
  std::ranges::replace(reason, '\n', ' ');
  if (reason.empty()) throw IoError(what);
  throw IoError(reason.starts_with(what) ? reason : fmt::format("{}: {}", what, reason));
}

void initialise() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();
  [[maybe_unused]] static const herr_t no_plugins =
      H5PLset_loading_state(0);  // no file makes us run other code
  [[maybe_unused]] thread_local const herr_t quiet = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Handle create_dataset(hid_t file, const DatasetPlan& plan) {
  const std::string what = fmt::format("creating dataset {}", plan.name);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), what);
  check(H5Pset_obj_track_times(creation, false), what);  // the same spec gives the same bytes
  if (!plan.chunk.empty())
    check(H5Pset_chunk(creation, static_cast<int>(plan.chunk.size()), plan.chunk.data()), what);
  if (plan.compression > 0) {
    if (H5Tget_size(plan.type) > 1) check(H5Pset_shuffle(creation), what);
    check(H5Pset_deflate(creation, static_cast<unsigned>(plan.compression)), what);
  }
  if (plan.checksums) check(H5Pset_fletcher32(creation), what);
  if (plan.fill) check(H5Pset_fill_value(creation, plan.type, plan.fill), what);
  add_sources(creation, plan.sources, plan.shape, plan.name);
  const Handle space(H5Screate_simple(static_cast<int>(plan.shape.size()), plan.shape.data(), nullptr),
                     H5Sclose, what);
  return {H5Dcreate2(file, plan.name.c_str(), plan.type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
          what};
}

std::size_t size_of(const SeriesValues& values) {
  if (const auto* codes = std::get_if<Codes>(&values)) return codes->values.size();
  if (const auto* numbers = std::get_if<std::vector<double>>(&values)) return numbers->size();
  return std::get<std::vector<std::string>>(values).size();
}

Handle write_series(hid_t file, const std::string& name, std::string_view unit, std::string_view long_name,
                    const SeriesValues& values, const Handle* scale) {
  const SeriesView view = view_of(values);
  const hsize_t count = size_of(values);
  Handle dataset = create_dataset(file, {name, view.file_type, {&count, 1}});
  check(H5Dwrite(dataset, view.memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, view.values), "writing " + name);
  write_attribute(dataset, "long_name", long_name);
  write_attribute(dataset, "units", unit);
  if (const auto* codes = std::get_if<Codes>(&values)) {
    write_attribute(dataset, "flag_values", codes->allowed);
    write_attribute(dataset, "flag_meanings", codes->meanings);
  }
  check(scale ? H5DSattach_scale(dataset, *scale, 0) : H5DSset_scale(dataset, name.c_str()),
        "scaling " + name);
  return dataset;
}

bool holds(hid_t file, const std::string& name, const SeriesValues& values) {
  const std::string what = "reading " + name;
  const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  if (shape_of(dataset) != std::vector<hsize_t>{size_of(values)}) return false;
  if (const auto* texts = std::get_if<std::vector<std::string>>(&values))
    return holds_texts(dataset, *texts, what);
  const SeriesView view = view_of(values);
  const std::size_t bytes = size_of(values) * H5Tget_size(view.memory_type);
  std::vector<std::byte> read(bytes);
  check(H5Dread(dataset, view.memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), what);
  return bytes == 0 || std::memcmp(read.data(), view.values, bytes) == 0;
}

std::vector<std::string> read_texts(hid_t dataset, std::size_t most_bytes, const std::string& what) {
  const Handle there(H5Dget_type(dataset), H5Tclose, what),
      type = text_type(), space(H5Dget_space(dataset), H5Sclose, what),
      transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose, what);
  const std::vector<hsize_t> shape = shape_of(dataset);
  if (H5Tis_variable_str(there) <= 0 || shape.size() != 1) throw IoError(what + ": it is not a row of texts");
  bytes_in_memory(dataset, what);
  refuse_inflation(dataset, {0}, {shape[0]}, what);
  TextMemory memory{most_bytes + 1};  // with the zero at its end
  check(H5Pset_vlen_mem_manager(transfer, allocate_text, &memory, free_text, &memory), what);
  std::vector<char*> read(shape[0]);
  const herr_t done = H5Dread(dataset, type, H5S_ALL, H5S_ALL, transfer, read.data());
  std::vector<std::string> texts;
  for (const char* text : read) texts.emplace_back(text ? text : "");
  check(H5Dvlen_reclaim(type, space, transfer, read.data()), what);
  check(done, what);
  return texts;
}

void write_attribute(hid_t object, const std::string& name, std::string_view text) {
  const std::string terminated(text);
  const char* pointer = terminated.c_str();
  const Handle type = text_type();
  write(object, name, type, type, scalar(), &pointer);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const Handle type = text_type();
  write(object, name, type, type, simple(texts.size()), pointers.data());
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

void write_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values) {
  write(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, simple(values.size()), values.data());
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

bool has_attribute(hid_t object, const std::string& name) {
  const htri_t exists = H5Aexists(object, name.c_str());
  if (exists < 0) fail(fmt::format("reading attribute {}", name));
  return exists > 0;
}

void remove_attribute(hid_t object, const std::string& name) {
  if (has_attribute(object, name))
    check(H5Adelete(object, name.c_str()), fmt::format("replacing attribute {}", name));
}

std::string read_text(hid_t object, const std::string& name) {
  const std::string what = fmt::format("reading attribute {}", name);
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Handle file_type(H5Aget_type(attribute), H5Tclose, what);
  if (H5Tget_class(file_type) != H5T_STRING || H5Tis_variable_str(file_type) <= 0)
    throw IoError(what + ": it is not text");
  if (points_of(attribute, what) != 1) throw IoError(what + ": it is not one text");
  const Handle type = text_type();
  char* text = nullptr;
  check(H5Aread(attribute, type, &text), what);
  std::string copy = text ? text : "";
  H5free_memory(text);
  return copy;
}

double read_number(hid_t object, const std::string& name, bool may_be_infinite) {
  const std::string what = fmt::format("reading attribute {}", name);
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Handle type(H5Aget_type(attribute), H5Tclose, what);
  const H5T_class_t kind = H5Tget_class(type);
  if (points_of(attribute, what) != 1 || (kind != H5T_INTEGER && kind != H5T_FLOAT))
    throw IoError(what + ": it is not one number");
  double value = 0.0;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), what);
  if (std::isnan(value) || (std::isinf(value) && !may_be_infinite))
    throw IoError(fmt::format("{}: it is {}", what, value));
  return value;
}

std::vector<std::int64_t> read_integers(hid_t object, const std::string& name, std::size_t most) {
  const std::string what = fmt::format("reading attribute {}", name);
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const hssize_t count = points_of(attribute, what);
  if (count < 1 || static_cast<std::size_t>(count) > most)
    throw IoError(fmt::format("{}: it is not 1 to {} numbers", what, most));
  const Handle type(H5Aget_type(attribute), H5Tclose, what);
  if (H5Tget_class(type) != H5T_INTEGER) throw IoError(what + ": it is not a whole number");
  std::vector<std::int64_t> values(static_cast<std::size_t>(count));
  check(H5Aread(attribute, H5T_NATIVE_INT64, values.data()), what);
  return values;
}

std::int64_t read_integer(hid_t object, const std::string& name, std::int64_t least, std::int64_t most) {
  const std::vector<std::int64_t> values = read_integers(object, name, 1);
  if (values[0] < least || values[0] > most)
    throw BrokenFile(fmt::format("reading attribute {}: it is {}", name, values[0]));
  return values[0];
}

std::uint32_t read_chunk(hid_t dataset, const std::vector<hsize_t>& place, std::vector<std::byte>& bytes,
                         const std::string& what) {
  hsize_t size = 0;
  std::uint32_t skipped_filters = 0;
  check(H5Dget_chunk_storage_size(dataset, place.data(), &size), what);
  if (size > file_bytes(dataset)) throw IoError(what + ": a chunk exceeds its file");
  bytes.resize(size);
  check(H5Dread_chunk(dataset, H5P_DEFAULT, place.data(), &skipped_filters, bytes.data()), what);
  return skipped_filters;
}

std::vector<double> read_block(hid_t dataset, const std::vector<std::size_t>& start,
                               const std::vector<std::size_t>& extent, const std::string& what) {
  refuse_inflation(dataset, start, extent, what);
  const auto [memory, file] = select(dataset, start, extent, what);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(memory)));
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, file, H5P_DEFAULT, values.data()), what);
  return values;
}

void write_block(hid_t dataset, const std::vector<std::size_t>& start, const std::vector<std::size_t>& extent,
                 std::span<const double> values, const std::string& what) {
  const auto [memory, file] = select(dataset, start, extent, what);
  check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, file, H5P_DEFAULT, values.data()), what);
}

std::vector<std::uint64_t> read_words(hid_t dataset, const std::vector<std::size_t>& start,
                                      const std::vector<std::size_t>& extent, const std::string& what) {
  refuse_inflation(dataset, start, extent, what);
  const auto [memory, file] = select(dataset, start, extent, what);
  std::vector<std::uint64_t> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(memory)));
  check(H5Dread(dataset, H5T_NATIVE_UINT64, memory, file, H5P_DEFAULT, values.data()), what);
  return values;
}

void write_words(hid_t dataset, const std::vector<std::size_t>& start, const std::vector<std::size_t>& extent,
                 std::span<const std::uint64_t> values, const std::string& what) {
  const auto [memory, file] = select(dataset, start, extent, what);
  check(H5Dwrite(dataset, H5T_NATIVE_UINT64, memory, file, H5P_DEFAULT, values.data()), what);
}

std::uint64_t file_bytes(hid_t object) {
  const Handle file(H5Iget_file_id(object), H5Fclose, "examining a file");
  hsize_t bytes = 0;
  check(H5Fget_filesize(file, &bytes), "examining a file");
  return bytes;
}

std::vector<hsize_t> chunk_of(hid_t dataset) {
  const Handle plan(H5Dget_create_plist(dataset), H5Pclose, "examining chunks");
  if (H5Pget_layout(plan) != H5D_CHUNKED) return {};
  std::vector<hsize_t> chunk(H5S_MAX_RANK);
  const int rank = H5Pget_chunk(plan, H5S_MAX_RANK, chunk.data());
  if (rank < 0) fail("examining chunks");
  chunk.resize(static_cast<std::size_t>(rank));
  return chunk;
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
