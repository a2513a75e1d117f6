// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/writer.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <cassert>
#include <filesystem>

#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "support/posix.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;
using hdf5::check;

/// Attributes of the root; that of the tiles goes when the map is whole.
constexpr const char *tiles_attribute = "tiles_done", *checksum_attribute = tiles_checksum_attribute,
                     *statuses_attribute = "status_counts", *seconds_attribute = "wall_time";

std::string_view filetype_of(const Tiling& tiling) {
  return tiling.is_part() ? shard_filetype : map_filetype;
}

void refuse_existing_map(const std::string& path, const Tiling& tiling, bool overwrite, Locking locking) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  hdf5::refuse_other_file(path, filetype_of(tiling), locking);
  if (!overwrite) throw InputError(path + ": exists already; allowed: another -o, or --overwrite");
}

std::vector<hsize_t> place_of(const Tile& tile) { return {tile.start.begin(), tile.start.end()}; }

}  // namespace

std::uint32_t checksum_of(std::uint32_t before, std::span<const std::byte> bytes,
                          std::uint32_t skipped_filters) {
  const std::uint32_t sum = libdeflate_crc32(before, bytes.data(), bytes.size());
  return libdeflate_crc32(sum, &skipped_filters, sizeof skipped_filters);
}

bool has_part(const std::string& path, Locking locking) {
  std::error_code ignored;  // of a folder that may not be entered: creating the file there tells
  return fs::exists(part_of(path), ignored) && !hdf5::File::blank(part_of(path), locking);
}

namespace {

std::uint32_t tiles_checksum(hid_t file, const MapLayout& layout, const Tiling& tiling, std::size_t tiles,
                             const std::string& path) {
  const std::vector<hdf5::Handle> datasets = open_fields(file, layout);
  std::uint32_t sum = 0;
  std::vector<std::byte> bytes;
  for (std::size_t t = 0; t < tiles; ++t) {
    const std::vector<hsize_t> place = place_of(tiling.tile(t));
    for (const hdf5::Handle& dataset : datasets) {
      const std::uint32_t skipped = hdf5::read_chunk(dataset, place, bytes, path + ": reading a tile");
      sum = checksum_of(sum, bytes, skipped);
    }
  }
  return sum;
}

}  // namespace

bool tiles_are_as_written(hid_t file, const MapLayout& layout, const Tiling& tiling, std::size_t tiles,
                          const std::string& path) {
  if (!hdf5::has_attribute(file, checksum_attribute)) return true;
  const std::vector<std::int64_t> told = hdf5::read_integers(file, checksum_attribute);
  return told.size() == 1 && told[0] == tiles_checksum(file, layout, tiling, tiles, path);
}

void write_tiles_checksum(hid_t file, const MapLayout& layout, const Tiling& tiling,
                          const std::string& path) {
  hdf5::write_attribute(file, checksum_attribute,
                        std::int64_t{tiles_checksum(file, layout, tiling, tiling.size(), path)});
}

MapWriter::MapWriter(const std::string& path, const MapLayout& layout, const Tiling& tiling)
    : path_(path), part_(part_of(path)), layout_(&layout), tiling_(&tiling) {}

MapWriter MapWriter::begin(const std::string& path, const MapLayout& layout, const Tiling& tiling,
                           std::span<const hdf5::Attribute> attributes, bool overwrite, Locking locking,
                           std::span<const hdf5::Source> sources) {
  const std::vector<std::int64_t> there = identity_of(path);
  refuse_existing_map(path, tiling, overwrite, locking);
  MapWriter writer(path, layout, tiling);
  hdf5::refuse_other_unfinished(writer.part_, filetype_of(tiling), locking);
  if (!overwrite && has_part(path, locking))
    throw InputError(fmt::format(
        "{}: an interrupted sweep left it; allowed: --resume to continue it, another -o, or --overwrite to "
        "start again",
        writer.part_));
  writer.file_ = hdf5::File::create(writer.part_, filetype_of(tiling), locking);
  writer.begun_ = true;
  writer.replace_ = overwrite;
  if (identity_of(path) != there)  // it came, or changed, before the unfinished file kept others away
    refuse_existing_map(path, tiling, overwrite, locking);
  hdf5::annotate(writer.file_, attributes);
  writer.virtual_ = !sources.empty();
  writer.datasets_ = lay_out(writer.file_, layout, tiling, sources);
  writer.write_progress();
  // A map of one tile holds nothing to resume before it is whole.
  if (tiling.size() > 1) writer.file_.flush();
  return writer;
}

MapWriter MapWriter::resume(const std::string& path, const MapLayout& layout, const Tiling& tiling,
                            bool overwrite, Locking locking) {
  refuse_existing_map(path, tiling, overwrite, locking);
  MapWriter writer(path, layout, tiling);
  writer.replace_ = overwrite;
  hdf5::refuse_other_unfinished(writer.part_, filetype_of(tiling), locking);
  writer.file_ = hdf5::File::change(writer.part_, locking);
  return writer;
}

MapWriter::~MapWriter() {
  if (!file_.is_open()) return;
  datasets_.clear();
  committed_ == 0 && begun_ ? file_.discard() : file_.abandon();
}

void MapWriter::verify() {
  const auto one = [&](const char* name) {
    const std::vector<std::int64_t> values = hdf5::read_integers(file_, name);
    if (values.size() != 1) throw BrokenFile(fmt::format("{}: {} is not one number", part_, name));
    return values[0];
  };
  check_layout(file_, *layout_, *tiling_, part_);
  const std::int64_t tiles = hdf5::has_attribute(file_, tiles_attribute)
                                 ? one(tiles_attribute)
                                 : static_cast<std::int64_t>(tiling_->size());
  const std::vector<std::int64_t> statuses = hdf5::read_integers(file_, statuses_attribute);
  if (tiles < 0 || static_cast<std::size_t>(tiles) > tiling_->size() || statuses.size() != status_count)
    throw BrokenFile(part_ + ": its attributes do not match its spec");
  progress_.tiles = static_cast<std::size_t>(tiles);
  std::ranges::copy(statuses, progress_.statuses.begin());
  progress_.seconds = hdf5::read_number(file_, seconds_attribute);
  datasets_ = open_fields(file_, *layout_);

  if (!tiles_are_as_written(file_, *layout_, *tiling_, progress_.tiles, part_))
    throw BrokenFile(part_ + ": its chunks are not what was written");
  checksum_ = static_cast<std::uint32_t>(one(checksum_attribute));
  committed_ = progress_.designs();
}

void MapWriter::write(const EncodedTile& tile) {
  assert(tile.number == progress_.tiles && tile.chunks.size() == datasets_.size());
  const Tile here = tiling_->tile(tile.number);
  for (std::size_t i = 0; i < datasets_.size(); ++i) {
    const auto& [bytes, skipped_filters] = tile.chunks[i];
    put(here, i, tile.chunks[i]);
    checksum_ = checksum_of(checksum_, bytes, skipped_filters);
  }
  ++progress_.tiles;
  for (std::size_t s = 0; s < status_count; ++s) progress_.statuses[s] += tile.statuses[s];
  file_.bytes().rethrow_failure();  // a full disk is told of now, not at the next commit
}

void MapWriter::put(const Tile& tile, std::size_t field, const EncodedChunk& chunk) {
  const std::vector<hsize_t> place = place_of(tile);
  hdf5::initialise();
  check(H5Dwrite_chunk(datasets_[field], H5P_DEFAULT, chunk.skipped_filters, place.data(), chunk.bytes.size(),
                       chunk.bytes.data()),
        part_ + ": cannot be written");
}

void MapWriter::take_over(const MapProgress& progress, std::uint32_t checksum) {
  progress_ = progress;
  checksum_ = checksum;
}

void MapWriter::write_progress() {
  const std::vector<hdf5::Attribute> progress{
      {tiles_attribute, static_cast<std::int64_t>(progress_.tiles)},
      {checksum_attribute, std::int64_t{checksum_}},
      {statuses_attribute, std::vector(progress_.statuses.begin(), progress_.statuses.end())},
      {seconds_attribute, progress_.seconds}};
  hdf5::annotate(file_, progress);
}

void MapWriter::close_datasets() {
  for (hdf5::Handle& dataset : datasets_) dataset.close(part_ + ": cannot be written");
  datasets_.clear();
}

void MapWriter::commit(std::span<const hdf5::Attribute> attributes) {
  write_progress();
  hdf5::annotate(file_, attributes);
  file_.flush();
  committed_ = progress_.designs();
}

bool MapWriter::finish(std::span<const hdf5::Attribute> attributes) {
  assert(progress_.tiles == tiling_->size());
  write_progress();
  hdf5::annotate(file_, attributes);
  hdf5::remove_attribute(file_, tiles_attribute);
  close_datasets();
  const auto verify = [&](hid_t written) {
    check_layout(written, *layout_, *tiling_, part_);
    if (!virtual_ && !tiles_are_as_written(written, *layout_, *tiling_, tiling_->size(), part_))
      throw BrokenFile(part_ + ": its chunks are not what was written");
  };
  // Whatever becomes of its name.
  return file_.finish(path_, replace_, verify, [&] { committed_ = progress_.designs(); });
}

void MapWriter::keep(std::span<const hdf5::Attribute> attributes) {
  commit(attributes);
  close_datasets();
  file_.close();
  file_ = {};
}

}  // namespace leapmap
