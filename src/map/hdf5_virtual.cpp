// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5_virtual.hpp"

#include <filesystem>

#include "map/hdf5.hpp"

namespace leapmap::hdf5 {
namespace {

/// A name of one of HDF5's functions that tell a text's length if they are given no place for it.
template <class Get>
std::string text_by(Get get, hid_t creation, std::size_t source) {
  const std::string what = "examining a virtual dataset";
  const ssize_t length = get(creation, source, nullptr, 0);
  if (length < 0) fail(what);
  std::string text(static_cast<std::size_t>(length), '\0');
  if (get(creation, source, text.data(), text.size() + 1) != length) fail(what);
  return text;
}

std::size_t count_of(hid_t creation) {
  std::size_t count = 0;
  check(H5Pget_virtual_count(creation, &count), "examining a virtual dataset");
  return count;
}

/// A plain name: HDF5 has a meaning for folders, and for % in names.
bool lies_beside(const std::string& file) {
  return !file.empty() && file != "." && file != ".." && file.find_first_of("/%") == file.npos;
}

}  // namespace

void add_sources(hid_t creation, std::span<const Source> sources, std::span<const hsize_t> shape,
                 const std::string& name) {
  const std::string what = "laying out " + name;
  for (const Source& source : sources) {
    const Handle part(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose,
                      what);
    H5S_seloper_t add = H5S_SELECT_SET;
    for (const Block& block : source.blocks) {
      check(H5Sselect_hyperslab(part, add, block.start.data(), nullptr, block.extent.data(), nullptr), what);
      add = H5S_SELECT_OR;
    }
    check(H5Pset_virtual(creation, part, source.file.c_str(), name.c_str(), part), what);
  }
}

std::string path_beside(const std::string& map, const std::string& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(map, error);
  return ((error ? std::filesystem::path(map) : real).parent_path() / file).string();
}

std::vector<std::string> sources_of(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, "examining a dataset");
  if (H5Pget_layout(creation) != H5D_VIRTUAL) return {};
  std::vector<std::string> files;
  for (std::size_t k = 0; k < count_of(creation); ++k)
    files.push_back(text_by(H5Pget_virtual_filename, creation, k));
  return files;
}

std::string refusal_of_sources(hid_t creation, const std::string& name) {
  for (std::size_t k = 0; k < count_of(creation); ++k)
    if (!lies_beside(text_by(H5Pget_virtual_filename, creation, k)) ||
        text_by(H5Pget_virtual_dsetname, creation, k) != name)
      return "is a virtual dataset of other files than shards beside it";
  return {};
}

}  // namespace leapmap::hdf5
