// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/reader.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <exception>
#include <filesystem>

#include "leapmap/errors.hpp"
#include "map/hdf5_trust.hpp"
#include "map/hdf5_virtual.hpp"
#include "map/layout.hpp"
#include "map/schema.hpp"
#include "map/shard_name.hpp"
#include "model/fields.hpp"

namespace leapmap {
namespace {

using hdf5::check;
using hdf5::Handle;

struct Names {
  std::vector<std::string> all;
  std::exception_ptr failure;  ///< what gathering them threw
};

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* context) noexcept {
  auto& names = *static_cast<Names*>(context);
  try {
    names.all.emplace_back(name);
    return 0;
  } catch (...) {  // none may pass through C: HDF5 would stay locked
    names.failure = std::current_exception();
    return -1;
  }
}

MapReader::Dimension read_dimension(hid_t dataset, const std::string& name) {
  const std::vector<hsize_t> shape = hdf5::shape_of(dataset);
  if (shape.size() != 1 || shape[0] == 0)
    throw IoError(name + ": a dimension of a map has one row of values, at least one");
  hdf5::bytes_in_memory(dataset, name);
  MapReader::Dimension dimension{name, hdf5::read_text(dataset, "units"), shape[0], {}};
  if (name == "design") return dimension;
  if (shape[0] > static_cast<hsize_t>(most_axis_values))
    throw IoError(fmt::format("{}: has {} values; allowed: at most {}", name, shape[0], most_axis_values));
  dimension.values = hdf5::read_block(dataset, {0}, {shape[0]}, "reading " + name);
  return dimension;
}

}  // namespace

MapReader::MapReader(const std::string& path, Locking locking, Accept accept)
    : path_(path), own_(hdf5::File::open(path, locking)), file_(own_) {
  survey(accept);
}

MapReader::MapReader(const std::string& path, hid_t file, Accept accept) : path_(path), file_(file) {
  survey(accept);
}

void MapReader::survey(Accept accept) {
  const std::string filetype =
      hdf5::has_attribute(file_, "filetype") ? hdf5::read_text(file_, "filetype") : "";
  if (filetype == shard_filetype && accept == Accept::maps)
    throw InputError(fmt::format("{}: is shard {} of a map; allowed: the joined map (leapmap join)", path_,
                                 attribute(shard_attribute)));
  if (filetype != map_filetype && filetype != shard_filetype)
    throw IoError(
        fmt::format("{}: is not a leapmap map (its attribute filetype is not \"{}\")", path_, map_filetype));
  const std::vector<std::int64_t> version = hdf5::read_integers(file_, "version");
  if (version.size() != 2 || version[0] < 1 || version[1] < 0)
    throw BrokenFile(path_ + ": its version is not a pair of whole numbers");
  if (version[0] > format_major)
    throw IoError(fmt::format("{}: has format version {}; this program reads up to {}: use a newer leapmap",
                              path_, version[0], format_major));

  Names names;
  const herr_t listed = H5Literate(file_, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect_name, &names);
  if (names.failure) std::rethrow_exception(names.failure);
  check(listed, path_ + ": listing datasets");
  for (const std::string& name : names.all) {
    H5O_info_t info;
    check(H5Oget_info_by_name(file_, name.c_str(), &info, H5P_DEFAULT), path_ + ": listing datasets");
    if (info.type != H5O_TYPE_DATASET) continue;  // the group that tells viewers what to plot
    const Handle dataset = open(name);
    const htri_t scale = H5DSis_scale(dataset);
    if (scale < 0) hdf5::fail(path_ + ": reading " + name);
    if ((scale > 0 || name == label_name) && !hdf5::sources_of(dataset).empty())
      throw BrokenFile(fmt::format("{}: {} is in other files", path_, name));
    if (scale > 0) {
      dimensions_.push_back(read_dimension(dataset, name));
    } else if (name == label_name) {
      has_labels_ = true;
    } else {
      fields_.push_back(name);
    }
  }
  if (dimensions_.empty()) throw IoError(path_ + ": has no dimensions");
  if (dimensions_.size() > 1 &&
      std::ranges::any_of(dimensions_, [](const Dimension& d) { return d.values.empty(); }))
    throw IoError(path_ + ": is a list and has other dimensions than design");
  double designs = 1.0;
  for (const Dimension& dimension : dimensions_) designs *= static_cast<double>(dimension.size);
  if (designs > most_designs) throw IoError(path_ + ": claims more than 10^12 designs");
  std::vector<hsize_t> expected;
  for (const Dimension& dimension : dimensions_) expected.push_back(dimension.size);
  if (has_labels_ && hdf5::shape_of(open(label_name)) != expected)
    throw IoError(path_ + ": lacks a label for some designs");
  for (const std::string& name : fields_) {
    const Handle dataset = open(name);
    if (hdf5::shape_of(dataset) != expected)
      throw IoError(fmt::format("{}: {} lacks the map's dimensions", path_, name));
    const std::vector<std::string> shards = hdf5::sources_of(dataset);
    if (shards.empty()) continue;  // a list's column
    if (!shards_.empty() && shards != shards_)
      throw BrokenFile(fmt::format("{}: {} is in other files than the fields before it", path_, name));
    shards_ = shards;
  }
  if (!shards_.empty()) check_shards();
}

/// HDF5 has fill values for what is not there, and would take what another sweep left under a shard's name.
void MapReader::check_shards() const {
  const std::string again = "allowed: the shards that it was made from, or a new leapmap join";
  if (!hdf5::has_attribute(file_, shard_checksums_attribute))
    throw BrokenFile(path_ + ": lacks the checksums of its shards");
  const std::vector<std::int64_t> told =
      hdf5::read_integers(file_, shard_checksums_attribute, shards_.size());
  if (told.size() != shards_.size()) throw BrokenFile(path_ + ": lacks the checksum of some shard");
  for (std::size_t k = 0; k < shards_.size(); ++k) {
    const std::string path = hdf5::path_beside(path_, shards_[k]);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
      throw BrokenFile(fmt::format("{}: its shard {} does not exist; {}", path_, path, again));
    const MapReader shard(path, Locking::if_possible, Accept::shards_too);
    const auto named = shard_by_name(shards_[k]);
    // Tiles of one status may have the sum of others: the name, the spec and the fields count as well.
    if (!shard.shards_.empty() || !named || text_of(*named) != shard.attribute(shard_attribute) ||
        shard.attribute("spec") != attribute("spec") || shard.fields_ != fields_ ||
        shard.shape() != shape() || !hdf5::has_attribute(shard.file_, tiles_checksum_attribute) ||
        hdf5::read_integers(shard.file_, tiles_checksum_attribute)[0] != told[k])
      throw BrokenFile(fmt::format("{}: its shard {} is a different one; {}", path_, path, again));
    // HDF5 reads the shard's chunks behind this map's back.
    for (const std::string& field : fields_)
      hdf5::refuse_inflation(shard.open(field), std::vector<std::size_t>(shape().size(), 0), shape(),
                             fmt::format("{}: {}", path, field));
  }
}

std::vector<std::size_t> MapReader::shape() const {
  std::vector<std::size_t> shape;
  for (const Dimension& dimension : dimensions_) shape.push_back(dimension.size);
  return shape;
}

Tiling MapReader::blocks(const std::string& field) const {
  constexpr std::size_t most_values = std::size_t{1} << 22;
  const Handle dataset = open(field);
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, field);
  std::vector<hsize_t> chunk(dimensions_.size());
  const std::vector<std::size_t> whole = shape();
  if (H5Pget_layout(creation) != H5D_CHUNKED ||
      H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data()) != static_cast<int>(chunk.size()))
    return Tiling(whole);
  std::vector<std::size_t> block;
  std::size_t values = 1;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    block.push_back(std::min<std::size_t>(chunk[i], whole[i]));
    values *= block.back();
  }
  return values <= most_values ? Tiling(whole, block) : Tiling(whole);
}

std::string MapReader::unit(const std::string& field) const { return hdf5::read_text(open(field), "units"); }

std::vector<std::string> MapReader::labels() const {
  if (!has_labels_) return {};
  return hdf5::read_texts(open(label_name), most_label_bytes, path_ + ": reading labels");
}

bool MapReader::is_whole() const { return !hdf5::has_attribute(file_, "tiles_done"); }

StatusCounts MapReader::status_counts() const {
  StatusCounts counts{};
  const std::vector<std::int64_t> read = hdf5::read_integers(file_, "status_counts");
  std::copy_n(read.begin(), std::min(read.size(), counts.size()), counts.begin());
  const auto designs = static_cast<std::int64_t>(designs_of(shape()));
  std::int64_t left = designs;
  for (const std::int64_t count : counts) {
    if (count < 0 || count > left) throw BrokenFile(path_ + ": is damaged: its status_counts are invalid");
    left -= count;
  }
  return counts;
}

std::string MapReader::attribute(const std::string& name) const {
  if (!hdf5::has_attribute(file_, name)) return "";
  const Handle attribute(H5Aopen(file_, name.c_str(), H5P_DEFAULT), H5Aclose, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, name);
  if (H5Tget_class(type) == H5T_STRING) return hdf5::read_text(file_, name);
  const Handle space(H5Aget_space(attribute), H5Sclose, name);
  if (H5Sget_simple_extent_npoints(space) != 1) return "";
  return fmt::format("{}", hdf5::read_number(file_, name));
}

std::vector<double> MapReader::read(const std::string& field, const Tile& block) const {
  std::vector<double> values =
      hdf5::read_block(open(field), block.start, block.extent, fmt::format("{}: reading {}", path_, field));
  rethrow_failure();
  return values;
}

std::vector<std::uint64_t> MapReader::read_words(const std::string& field, const Tile& block) const {
  std::vector<std::uint64_t> words =
      hdf5::read_words(open(field), block.start, block.extent, fmt::format("{}: reading {}", path_, field));
  rethrow_failure();
  return words;
}

/// A shard that could not be opened has left fill values.
void MapReader::rethrow_failure() const {
  if (!shards_.empty() && own_.is_open()) own_.bytes().rethrow_failure();
}

Handle MapReader::open(const std::string& dataset) const {
  return {H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose,
          fmt::format("{}: opening {}", path_, dataset)};
}

}  // namespace leapmap
