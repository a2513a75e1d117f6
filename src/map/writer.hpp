// SPDX-License-Identifier: GPL-3.0-or-later
/// Writes a map, or a shard of one, tile by tile: a shard's file is the whole map's with holes. Until it is
/// whole it is called FILE.part, which survives whatever stops the program and can be gone on with; FILE
/// itself is only ever a whole map.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "map/hdf5_driver.hpp"
#include "map/layout.hpp"
#include "map/reader.hpp"
#include "map/tile_encoder.hpp"

namespace leapmap {

/// What a map holds so far.
struct MapProgress {
  std::size_t tiles = 0;    ///< the first so many, in the order of their numbers
  StatusCounts statuses{};  ///< designs in them, by how they ended
  double seconds = 0.0;     ///< of work, over all sessions

  std::size_t designs() const { return designs_in(statuses); }
};

class MapWriter {
 public:
  /// Creates FILE.part and everything in it but the values. Refuses (InputError) to replace FILE or FILE.part
  /// unless overwrite is set, any file but a map even then, and while another program holds FILE.part; throws
  /// IoError if it cannot be written. With sources the map is virtual: the values stay in those files, and
  /// nothing is put.
  static MapWriter begin(const std::string& path, const MapLayout& layout, const Tiling& tiling,
                         std::span<const hdf5::Attribute> attributes, bool overwrite,
                         Locking locking = Locking::required, std::span<const hdf5::Source> sources = {});
  /// Opens FILE.part, as of its last commit, to go on with it after verify. Throws as begin does, and
  /// BrokenFile if it is not whole.
  static MapWriter resume(const std::string& path, const MapLayout& layout, const Tiling& tiling,
                          bool overwrite, Locking locking = Locking::required);
  /// Without finish or keep before it: FILE.part is left as of its last commit, or removed if it is new and
  /// that holds no tile.
  ~MapWriter();
  MapWriter(MapWriter&&) = default;

  /// Reads all that is there again. Throws BrokenFile if it is not what was written.
  void verify();
  /// Stores the next tile. One thread at a time.
  void write(const EncodedTile& tile);
  /// Stores a field's chunk of any tile, encoded elsewhere; take_over then says what the file holds.
  void put(const Tile& tile, std::size_t field, const EncodedChunk& chunk);
  void take_over(const MapProgress& progress, std::uint32_t checksum);
  /// Brings all tiles so far to disk at once, and attributes of the root that go with them. Throws IoError if
  /// the disk is full: what was committed stays.
  void commit(std::span<const hdf5::Attribute> attributes = {});
  /// Designs that FILE.part keeps whatever happens.
  std::size_t committed() const { return committed_; }
  /// What was written so far; `seconds` is for the caller to count.
  const MapProgress& progress() const { return progress_; }
  void set_seconds(double seconds) { progress_.seconds = seconds; }
  /// Adds closing attributes, reads everything again, brings it to disk and gives the file its name. Returns
  /// false if a power cut may undo the latter (JournaledFile::rename). Throws BrokenFile if what is read is
  /// not what was written, IoError.
  [[nodiscard]] bool finish(std::span<const hdf5::Attribute> attributes);
  /// Commits and closes the unfinished file, which stays FILE.part.
  void keep(std::span<const hdf5::Attribute> attributes);

  /// The unfinished file, to be read while this writer lives.
  MapReader reader() const { return MapReader(part_, file_, Accept::shards_too); }

 private:
  MapWriter(const std::string& path, const MapLayout& layout, const Tiling& tiling);
  void write_progress();
  void close_datasets();

  std::string path_, part_;
  const MapLayout* layout_;
  const Tiling* tiling_;
  hdf5::File file_;
  std::vector<hdf5::Handle> datasets_;
  MapProgress progress_;
  std::uint32_t checksum_ = 0;  ///< of all chunks so far
  std::size_t committed_ = 0;   ///< designs
  bool begun_ = false;          ///< FILE.part is of this writer's making
  bool replace_ = false;        ///< FILE may be there
  bool virtual_ = false;        ///< the tiles lie in other files
};

/// The name of a map while it is not whole.
inline std::string part_of(const std::string& path) { return path + ".part"; }

/// Whether FILE.part is there with something in it: what an interrupted sweep left. Throws InputError while a
/// sweep is writing it.
bool has_part(const std::string& path, Locking locking = Locking::required);

/// The CRC-32 of chunks so far, and of one more and the mask of the filters skipped for it.
std::uint32_t checksum_of(std::uint32_t before, std::span<const std::byte> bytes,
                          std::uint32_t skipped_filters);

/// Whether the first `tiles` tiles are as they were written: a CRC-32 of them as stored, by tile and then by
/// field, each chunk followed by the mask of the filters skipped for it, is the one that the map tells. True
/// of a map that tells none. Throws IoError, which begins with `path`.
bool tiles_are_as_written(hid_t file, const MapLayout& layout, const Tiling& tiling, std::size_t tiles,
                          const std::string& path);

/// Tells in the map the checksum of all its tiles as they are now. Throws IoError.
void write_tiles_checksum(hid_t file, const MapLayout& layout, const Tiling& tiling, const std::string& path);

}  // namespace leapmap
