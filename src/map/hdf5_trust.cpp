// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5_trust.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>

#include "leapmap/errors.hpp"
#include "support/printable.hpp"

namespace leapmap::hdf5 {
namespace {

constexpr std::size_t most_objects = 4096;
constexpr hsize_t most_chunk_bytes = hsize_t{1} << 28;
constexpr std::size_t most_deflation = 1032;  // of zlib's format: 258 bytes a code of two bits

struct Survey {
  std::string refusal;  ///< empty: nothing found
  std::size_t objects = 0;
  SourceNames sources;
  std::exception_ptr failure;  ///< what looking at it threw
};

/// Whether the filters are ours: each at most once, in our order. Deflated twice, a few bytes would take any
/// memory.
bool has_our_filters(const Handle& creation) {
  constexpr std::array ours{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32};
  const int filters = H5Pget_nfilters(creation);
  auto next = ours.begin();
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    next = std::find(
        next, ours.end(),
        H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, nullptr));
    if (next++ == ours.end()) return false;
  }
  return filters >= 0;
}

/// What is wrong with a dataset; empty: nothing.
std::string refusal_of_dataset(hid_t dataset, const std::string& name) {
  const std::string what = "looking at a dataset";
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, what),
      type(H5Dget_type(dataset), H5Tclose, what);
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL) return refusal_of_sources(creation, name);
  if (H5Pget_external_count(creation) != 0) return "has its values in another file";
  if (H5Tdetect_class(type, H5T_REFERENCE) != 0) return "holds references";
  if (!has_our_filters(creation)) return "is packed by a filter that leapmap does not use";
  if (H5Dget_storage_size(dataset) > file_bytes(dataset)) return "says that it is larger than the file";
  if (layout != H5D_CHUNKED) return {};
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  hsize_t bytes = H5Tget_size(type);
  for (int i = 0; i < rank && bytes <= most_chunk_bytes; ++i)
    bytes = chunk[static_cast<std::size_t>(i)] > most_chunk_bytes
                ? most_chunk_bytes + 1
                : bytes * chunk[static_cast<std::size_t>(i)];
  return bytes > most_chunk_bytes ? "has chunks larger than leapmap writes" : "";
}

std::string refusal_of_link(hid_t group, const char* name, const H5L_info_t& link, SourceNames& sources) {
  if (link.type == H5L_TYPE_SOFT) return {};  // leads nowhere but into the same file
  if (link.type != H5L_TYPE_HARD) return "is a link into another file";
  const Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose, "opening an object");
  const H5I_type_t kind = H5Iget_type(object);
  if (kind == H5I_GROUP) return {};
  if (kind != H5I_DATASET) return "is neither a dataset nor a group";
  std::string refusal = refusal_of_dataset(object, name);
  if (refusal.empty())
    for (std::string& file : sources_of(object)) sources.insert(std::move(file));
  return refusal;
}

/// One link of the file; > 0 ends the visit.
herr_t visit(hid_t group, const char* name, const H5L_info_t* link, void* context) {
  auto& survey = *static_cast<Survey*>(context);
  try {
    if (++survey.objects > most_objects) {
      survey.refusal = "holds more objects than any file of leapmap's";
      return 1;
    }
    const std::string refusal = refusal_of_link(group, name, *link, survey.sources);
    if (refusal.empty()) return 0;
    survey.refusal = fmt::format("{} {}", printable(name), refusal);
    return 1;
  } catch (...) {  // none may pass through C: HDF5 would stay locked
    survey.failure = std::current_exception();
    return -1;
  }
}

}  // namespace

SourceNames refuse_foreign_parts(hid_t file, const std::string& path) {
  Survey survey;
  const herr_t visited = H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &survey);
  if (survey.failure) std::rethrow_exception(survey.failure);
  check(visited, path + ": cannot be surveyed");
  if (!survey.refusal.empty()) throw ForeignFile(fmt::format("{}: is refused: {}", path, survey.refusal));
  return std::move(survey.sources);
}

std::size_t bytes_in_memory(hid_t dataset, const std::string& what) {
  const Handle type(H5Dget_type(dataset), H5Tclose, what);
  const std::size_t size = H5Tget_size(type);
  std::size_t most = std::min<hsize_t>(H5Dget_storage_size(dataset), file_bytes(dataset));
  most = most > SIZE_MAX / most_deflation ? SIZE_MAX : most * most_deflation;
  std::size_t bytes = size;
  for (const hsize_t extent : shape_of(dataset))
    bytes = extent == 0 ? 0 : bytes > most / extent ? most + 1 : bytes * extent;
  if (bytes > most) throw IoError(what + ": it says that it holds more values than the file has bytes for");
  return bytes;
}

}  // namespace leapmap::hdf5
