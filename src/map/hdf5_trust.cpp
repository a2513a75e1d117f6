// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5_trust.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <span>

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
  const std::string what = "examining a dataset";
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, what),
      type(H5Dget_type(dataset), H5Tclose, what);
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL) return refusal_of_sources(creation, name);
  if (H5Pget_external_count(creation) != 0) return "has its values in another file";
  if (H5Tdetect_class(type, H5T_REFERENCE) != 0) return "holds references";
  if (!has_our_filters(creation)) return "is packed by a filter that leapmap does not use";
  if (H5Dget_storage_size(dataset) > file_bytes(dataset)) return "claims to be larger than the file";
  if (layout != H5D_CHUNKED) return {};
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  const std::vector<hsize_t> extents = shape_of(dataset);
  for (int i = 0; i < rank; ++i)
    if (const auto k = static_cast<std::size_t>(i); chunk[k] > std::max<hsize_t>(extents[k], 1))
      return "has chunks larger than itself";
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
    // Ours lie at most three deep. HDF5 goes all the way down again for each object.
    constexpr std::ptrdiff_t deepest = 8;
    if (const std::string_view place = name; std::ranges::count(place, '/') > deepest) {
      survey.refusal = "is nested deeper than any file of leapmap's";
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
  check(visited, path + ": cannot be examined");
  if (!survey.refusal.empty()) throw ForeignFile(fmt::format("{}: is refused: {}", path, survey.refusal));
  return std::move(survey.sources);
}

namespace {

/// Where in the line of a dataset's filters one stands; nothing: it is none of them.
std::optional<unsigned> place_of_filter(hid_t creation, H5Z_filter_t filter) {
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const auto k = static_cast<unsigned>(i);
    if (H5Pget_filter2(creation, k, &flags, &values, nullptr, 0, nullptr, nullptr) == filter) return k;
  }
  return {};
}

/// Whether a chunk as it is stored inflates to exactly so many bytes.
bool inflates_to(std::span<const std::byte> stored, std::size_t bytes) {
  std::vector<std::byte> values(bytes);
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  return libdeflate_zlib_decompress(decompressor.get(), stored.data(), stored.size(), values.data(),
                                    values.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

}  // namespace

void refuse_inflation(hid_t dataset, const std::vector<std::size_t>& start,
                      const std::vector<std::size_t>& extent, const std::string& what) {
  constexpr std::size_t harmless = std::size_t{1} << 27;  // what a chunk may inflate to without being asked
  constexpr std::size_t checksum_bytes = 4;
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, what),
      type(H5Dget_type(dataset), H5Tclose, what);
  if (H5Pget_layout(creation) != H5D_CHUNKED) return;
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  if (rank != static_cast<int>(start.size())) fail(what);
  std::size_t bytes = H5Tget_size(type);
  for (std::size_t k = 0; k < start.size(); ++k) bytes *= chunk[k];
  const auto deflate = place_of_filter(creation, H5Z_FILTER_DEFLATE);
  const bool has_checksum = place_of_filter(creation, H5Z_FILTER_FLETCHER32).has_value();
  const auto refuse = [&] { throw BrokenFile(what + ": a chunk inflates to more than its values"); };
  std::vector<hsize_t> first, last, at;
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (extent[k] == 0) return;
    first.push_back(start[k] / chunk[k]), last.push_back((start[k] + extent[k] - 1) / chunk[k]);
  }
  at = first;
  for (std::vector<std::byte> stored;;) {
    std::vector<hsize_t> place;
    for (std::size_t k = 0; k < at.size(); ++k) place.push_back(at[k] * chunk[k]);
    hsize_t size = 0;  // of a chunk that was never written
    haddr_t address = 0;
    unsigned skipped_here = 0;
    check(H5Dget_chunk_info_by_coord(dataset, place.data(), &skipped_here, &address, &size), what);
    if (size > bytes + bytes / 1000 + 64) refuse();
    if (deflate && size * most_deflation > harmless) {
      const std::uint32_t skipped = read_chunk(dataset, place, stored, what);
      if (has_checksum) stored.resize(stored.size() - std::min(checksum_bytes, stored.size()));
      if (!(skipped >> *deflate & 1u) && !inflates_to(stored, bytes)) refuse();
    }
    std::size_t k = at.size();
    while (k > 0 && at[k - 1] == last[k - 1]) --k, at[k] = first[k];
    if (k == 0) return;
    ++at[k - 1];
  }
}

std::size_t bytes_in_memory(hid_t dataset, const std::string& what) {
  const Handle type(H5Dget_type(dataset), H5Tclose, what);
  const std::size_t size = H5Tget_size(type);
  std::size_t most = std::min<hsize_t>(H5Dget_storage_size(dataset), file_bytes(dataset));
  most = most > SIZE_MAX / most_deflation ? SIZE_MAX : most * most_deflation;
  std::size_t bytes = size;
  for (const hsize_t extent : shape_of(dataset))
    bytes = extent == 0 ? 0 : bytes > most / extent ? most + 1 : bytes * extent;
  if (bytes > most) throw IoError(what + ": it claims more values than the file has bytes for");
  return bytes;
}

}  // namespace leapmap::hdf5
