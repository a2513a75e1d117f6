// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/join.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "audit/audit.hpp"
#include "engine/begin_map.hpp"
#include "engine/map_layout.hpp"
#include "engine/provenance.hpp"
#include "map/schema.hpp"
#include "map/shard_name.hpp"
#include "map/writer.hpp"
#include "shards/join_faults.hpp"
#include "shards/shard.hpp"
#include "spec/designs.hpp"
#include "spec/map_spec.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;

/// The numbers of shards that files beside the map say by their names, whole or not.
std::set<std::size_t> totals_beside(const std::string& map) {
  const fs::path path(map), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::set<std::size_t> totals;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (name.ends_with(".part")) name.resize(name.size() - 5);
    const auto shard = shard_by_name(name);
    if (shard && name == shard_path(path.filename().string(), *shard)) totals.insert(shard->of);
  }
  if (error) throw IoError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  return totals;
}

std::size_t shards_of(const std::string& map, std::size_t asked) {
  if (asked > 0) return asked;
  const std::set<std::size_t> totals = totals_beside(map);
  if (totals.empty())
    throw InputError(fmt::format(
        "{}: no shard lies beside it; allowed: shards of leapmap sweep SPEC -o {} --shard I/N, for "
        "example {}",
        map, shell_quoted(map), shard_path(map, {1, 8})));
  if (totals.size() > 1)
    throw InputError(
        fmt::format("{}: shards of {} and of {} lie beside it; allowed: --shards with one of these numbers",
                    map, *totals.begin(), *std::next(totals.begin())));
  return *totals.begin();
}

/// What an interrupted join has left is of no use to anybody.
void remove_unfinished(const std::string& map, Locking locking) {
  if (!has_part(map, locking)) return;
  const std::string part = part_of(map);
  try {
    if (!hdf5::has_attribute(hdf5::File::open(part, locking), shards_attribute)) return;
  } catch (const BrokenFile&) {
    return;  // whoever made it, it is refused
  }
  std::error_code error;
  if (!fs::remove(part, error) && error)
    throw IoError(
        fmt::format("{}: what an interrupted join left cannot be removed: {}", part, error.message()));
}

/// What all shards have to share, and what they add up to.
class Joining {
 public:
  Joining(const std::string& map, std::size_t shards, const JoinOptions& options)
      : map_(map),
        shards_(shards),
        options_(options),
        locking_(options.lock ? Locking::required : Locking::if_possible) {}

  std::optional<JoinReport> run() {
    survey();
    MapWriter writer =
        MapWriter::begin(map_, layout_, *tiling_, opening(), options_.overwrite, locking_, sources_);
    sums_.resize(tiling_->size());
    for (std::size_t i = 1; i <= shards_; ++i)
      if (!copy(i, writer)) return std::nullopt;
    std::uint32_t checksum = 0;
    for (const Sum& sum : sums_) checksum = followed_by(checksum, sum);
    writer.take_over(progress_, checksum);
    JoinReport report{shards_, tiling_->size(), tiling_->designs(), progress_.statuses, true, audit_, spec_};
    std::vector<hdf5::Attribute> closing;
    if (audit_) closing = audit_attributes(*audit_);
    if (options_.as_virtual) closing.emplace_back(shard_checksums_attribute, checksums_);
    report.durable = writer.finish(closing);
    return report;
  }

 private:
  struct Sum {
    std::uint32_t checksum = 0;
    std::uint64_t bytes = 0;
  };

  /// The checksum of what one was of, with that behind it.
  static std::uint32_t followed_by(std::uint32_t checksum, const Sum& next) {
    return static_cast<std::uint32_t>(
        crc32_combine(checksum, next.checksum, static_cast<z_off_t>(next.bytes)));
  }

  std::string path_of(std::size_t shard) const { return shard_path(map_, {shard, shards_}); }

  /// Reads what every shard says of itself, before anything is written.
  void survey() {
    JoinFaults faults(map_, shards_);
    std::vector<std::size_t> there;
    for (std::size_t i = 1; i <= shards_; ++i) {
      std::error_code ignored;
      if (fs::exists(path_of(i), ignored))
        there.push_back(i);
      else
        faults.note(i, fs::exists(part_of(path_of(i)), ignored) ? "unfinished" : "");
    }
    std::vector<std::size_t> holder;  // of each tile: the shard that has it
    for (const std::size_t i : there) {
      try {
        look_at(i, holder);
      } catch (const IoError& error) {
        faults.note(i, fmt::format("{} cannot be read: {}", path_of(i), error.what()), true);
      }
    }
    faults.tell();
    if (const auto hole = std::ranges::find(holder, 0u); hole != holder.end())
      throw InputError(fmt::format("{}: no shard holds chunk {}; allowed: shards from a single partitioning",
                                   map_, hole - holder.begin()));
  }

  void look_at(std::size_t i, std::vector<std::size_t>& holder) {
    const std::string path = path_of(i);
    const MapReader shard(path, locking_, Accept::shards_too);
    if (!hdf5::has_attribute(shard.file(), shard_attribute))
      throw InputError(fmt::format("{}: is a whole map, not a shard; allowed: the file of --shard {}/{}",
                                   path, i, shards_));
    if (const std::string told = shard.attribute(shard_attribute); told != text_of(Shard{i, shards_}))
      throw InputError(
          fmt::format("{}: is shard {} despite its name; allowed: shard {}/{}", path, told, i, shards_));
    if (!shard.is_whole()) throw BrokenFile("it is incomplete");
    const Spec spec = spec_of(shard, path);
    if (shard.shape() != shape_of(spec)) throw BrokenFile("its dimensions are not those of its spec");
    if (!tiling_) {
      spec_ = spec;
      first_ = path;
      layout_ = layout_of(spec_);
      // Shards of another leapmap may be cut into other tiles than this one's would be.
      tiling_.emplace(shard.blocks(std::string(layout_.fields.front()->name)));
      for (const char* name : bits_depend_on) same_.emplace_back(name, shard.attribute(name));
    } else if (const auto difference = first_difference(spec_, spec)) {
      throw InputError(fmt::format("{}: has another spec than {}: {}; allowed: shards of one spec", path,
                                   first_, *difference));
    }
    refuse_other_program(shard, path);
    add_up(shard);
    const std::vector<std::size_t> tiles = tiles_held(shard.file(), tiling_->size());
    check_layout(shard.file(), layout_, *tiling_, path);
    holder.resize(tiling_->size());
    for (const std::size_t t : tiles) {
      if (holder[t] != 0)
        throw InputError(
            fmt::format("{}: holds chunk {}, and so does {}; allowed: shards from a single partitioning",
                        path, t, path_of(holder[t])));
      holder[t] = i;
    }
    if (options_.as_virtual && !tiles.empty()) sources_.push_back(source_of(path, tiles));
  }

  /// Where a shard's tiles lie. Tiles that follow one another along the last dimension are one block, as HDF5
  /// takes its time over many.
  hdf5::Source source_of(const std::string& path, const std::vector<std::size_t>& tiles) const {
    hdf5::Source source{fs::path(path).filename().string(), {}};
    for (const std::size_t t : tiles) {
      const Tile tile = tiling_->tile(t);
      const std::vector<hsize_t> start(tile.start.begin(), tile.start.end()),
          extent(tile.extent.begin(), tile.extent.end());
      if (!source.blocks.empty()) {
        hdf5::Block& last = source.blocks.back();
        std::vector<hsize_t> next = last.start;
        next.back() += last.extent.back();
        if (next == start && std::equal(extent.begin(), extent.end() - 1, last.extent.begin())) {
          last.extent.back() += extent.back();
          continue;
        }
      }
      source.blocks.push_back({start, extent});
    }
    return source;
  }

  void refuse_other_program(const MapReader& shard, const std::string& path) const {
    if (hdf5::read_integers(shard.file(), "version") != std::vector<std::int64_t>{format_major, format_minor})
      throw InputError(
          path + ": has another format version than this program writes; allowed: the program that made it");
    for (const auto& [name, value] : same_)
      if (shard.attribute(name) != value)
        throw InputError(fmt::format(
            "{}: was made by another leapmap: {} is {} there and {} in {}, which may change bits; "
            "allowed: shards of one program, instruction set (leapmap --instruction-set) and C library",
            path, name, shard.attribute(name), value, first_));
  }

  void add_up(const MapReader& shard) {
    const StatusCounts counts = shard.status_counts();
    for (std::size_t s = 0; s < counts.size(); ++s) progress_.statuses[s] += counts[s];
    progress_.seconds += hdf5::read_number(shard.file(), "wall_time");
    threads_ = std::max(threads_, hdf5::read_integer(shard.file(), "threads", 1));
    if (!hdf5::has_attribute(shard.file(), "audit_first_mismatch")) return;
    const AuditReport audit = read_audit(shard);
    if (!audit_) {
      audit_ = begin_audit(spec_);
      audit_method_ = shard.attribute("audit_method");
    }
    merge(*audit_, audit);
  }

  std::vector<hdf5::Attribute> opening() const {
    std::vector<hdf5::Attribute> attributes = provenance(spec_, map_filetype, title_of(spec_));
    for (const auto& [name, value] : same_)
      std::ranges::find(attributes, name, &hdf5::Attribute::first)->second =
          value;  // who solved it, not who joins
    attributes.emplace_back(shards_attribute, static_cast<std::int64_t>(shards_));
    attributes.emplace_back("threads", threads_);
    if (audit_) attributes.emplace_back("audit_method", audit_method_);
    return attributes;
  }

  /// Copies a shard's chunks, or only reads them where they stay. Returns false if a stop was requested.
  bool copy(std::size_t number, MapWriter& writer) {
    const std::string path = path_of(number);
    const MapReader shard(path, locking_, Accept::shards_too);
    const std::vector<std::size_t> tiles = tiles_held(shard.file(), tiling_->size());
    check_layout(shard.file(), layout_, *tiling_, path);
    const std::vector<hdf5::Handle> fields = open_fields(shard.file(), layout_);
    EncodedChunk chunk;
    std::uint32_t checksum = 0;
    for (const std::size_t t : tiles) {
      if (options_.stop_requested && options_.stop_requested()) return false;
      const Tile tile = tiling_->tile(t);
      const std::vector<hsize_t> place(tile.start.begin(), tile.start.end());
      for (std::size_t f = 0; f < fields.size(); ++f) {
        chunk.skipped_filters = hdf5::read_chunk(fields[f], place, chunk.bytes, path + ": reading a tile");
        sums_[t].checksum = checksum_of(sums_[t].checksum, chunk.bytes, chunk.skipped_filters);
        sums_[t].bytes += chunk.bytes.size() + sizeof chunk.skipped_filters;
        if (!options_.as_virtual) writer.put(tile, f, chunk);
      }
      checksum = followed_by(checksum, sums_[t]);
      ++progress_.tiles;
      done_ += tile.count;
      if (options_.progress) options_.progress(done_, tiling_->designs());
    }
    const std::vector<std::int64_t> told = hdf5::read_integers(shard.file(), "tiles_checksum");
    if (told.size() != 1 || told[0] != checksum)
      throw BrokenFile(fmt::format(
          "{}: its chunks are not what was written; remove it, then run it again: --array={}", path, number));
    if (!tiles.empty()) checksums_.push_back(told[0]);
    return true;
  }

  const std::string map_;
  std::size_t shards_;
  const JoinOptions& options_;
  Locking locking_;
  Spec spec_;
  MapLayout layout_;
  std::optional<Tiling> tiling_;
  std::string first_;  ///< the shard that the others are compared with
  std::vector<std::pair<std::string, std::string>> same_;
  std::int64_t threads_ = 1;  ///< the most that a shard had
  MapProgress progress_;
  std::optional<AuditReport> audit_;
  std::string audit_method_;
  std::vector<Sum> sums_;                ///< of each tile's chunks
  std::vector<hdf5::Source> sources_;    ///< of a virtual map: the shards that have tiles
  std::vector<std::int64_t> checksums_;  ///< of their tiles, one a source
  std::size_t done_ = 0;                 ///< designs
};

}  // namespace

std::optional<JoinReport> join(const std::string& path, const JoinOptions& options) {
  const std::string map = behind_links(path);
  std::error_code ignored;
  if (fs::exists(map, ignored) && !options.overwrite)
    throw InputError(map +
                     ": exists already; allowed: another name for the shards and the map, or --overwrite");
  if (options.as_virtual && fs::path(map).filename().string().find('%') != std::string::npos)
    throw InputError(map +
                     ": has a % in its name, which HDF5's virtual datasets interpret; allowed: another "
                     "name for the shards and the map, or a join without --virtual");
  const std::size_t shards = shards_of(map, options.shards);
  remove_unfinished(map, options.lock ? Locking::required : Locking::if_possible);
  return Joining(map, shards, options).run();
}

}  // namespace leapmap
