// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/join.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "map/schema.hpp"
#include "map/writer.hpp"
#include "support/printable.hpp"
#include "sweep/audit.hpp"
#include "sweep/begin_map.hpp"
#include "sweep/designs.hpp"
#include "sweep/map_layout.hpp"
#include "sweep/map_spec.hpp"
#include "sweep/provenance.hpp"
#include "sweep/shard.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;

/// Numbers as Slurm's --array takes them: 3,5-7.
std::string array_of(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0, j = 0; i < numbers.size(); i = j) {
    for (j = i + 1; j < numbers.size() && numbers[j] == numbers[j - 1] + 1;) ++j;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (j > i + 1) text += fmt::format("-{}", numbers[j - 1]);
  }
  return text;
}

/// The numbers of shards that files beside the map say by their names, whole or not.
std::set<std::size_t> totals_beside(const std::string& map) {
  const fs::path path(map), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string stem = path.stem().string() + ".", extension = path.extension().string();
  std::set<std::size_t> totals;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (name.ends_with(".part")) name.resize(name.size() - 5);
    if (!name.starts_with(stem) || !name.ends_with(extension) ||
        name.size() <= stem.size() + extension.size())
      continue;
    const std::string middle = name.substr(stem.size(), name.size() - stem.size() - extension.size());
    const auto dash = middle.find("-of-");
    if (dash == std::string::npos) continue;
    std::array<std::size_t, 2> numbers{};
    const std::array<std::string, 2> digits{middle.substr(0, dash), middle.substr(dash + 4)};
    bool good = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const char *first = digits[i].data(), *last = first + digits[i].size();
      const auto [stop, wrong] = std::from_chars(first, last, numbers[i]);
      good = good && wrong == std::errc() && stop == last;
    }
    if (good && numbers[0] >= 1 && numbers[0] <= numbers[1] && numbers[1] <= most_shards)
      totals.insert(numbers[1]);
  }
  if (error) throw IoError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  return totals;
}

std::size_t shards_of(const std::string& map, std::size_t asked) {
  if (asked > 0) return asked;
  const std::set<std::size_t> totals = totals_beside(map);
  if (totals.empty())
    throw InputError(
        fmt::format("{}: no shard of it lies beside it; allowed: a map whose shards leapmap sweep SPEC -o {} "
                    "--shard I/N made, such as {}",
                    map, shell_quoted(map), shard_path(map, {1, 8})));
  if (totals.size() > 1)
    throw InputError(
        fmt::format("{}: shards of {} and of {} lie beside it; allowed: --shards with the number that counts",
                    map, *totals.begin(), *std::next(totals.begin())));
  return *totals.begin();
}

/// All shards are there and whole.
void refuse_missing(const std::string& map, std::size_t shards) {
  std::vector<std::size_t> again, unfinished;
  for (std::size_t i = 1; i <= shards; ++i) {
    const std::string path = shard_path(map, {i, shards});
    std::error_code ignored;
    if (fs::exists(path, ignored)) continue;
    again.push_back(i);
    if (fs::exists(part_of(path), ignored)) unfinished.push_back(i);
  }
  if (again.empty()) return;
  throw InputError(fmt::format(
      "{}: {} of its {} shards {} not there{}; run them again, with --resume: --array={}", map, again.size(),
      shards, again.size() == 1 ? "is" : "are",
      unfinished.empty() ? "" : fmt::format(", {} of them unfinished", unfinished.size()), array_of(again)));
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
    MapWriter writer = MapWriter::begin(map_, layout_, *tiling_, opening(), options_.overwrite, locking_);
    sums_.resize(tiling_->size());
    for (std::size_t i = 1; i <= shards_; ++i)
      if (!copy(i, writer)) return std::nullopt;
    std::uint32_t checksum = 0;
    for (const Sum& sum : sums_)
      checksum =
          static_cast<std::uint32_t>(crc32_combine(checksum, sum.checksum, static_cast<z_off_t>(sum.bytes)));
    writer.take_over(progress_, checksum);
    JoinReport report{shards_, tiling_->size(), tiling_->designs(), progress_.statuses, true, audit_};
    std::vector<hdf5::Attribute> closing;
    if (audit_) closing = audit_attributes(*audit_);
    report.durable = writer.finish(closing);
    return report;
  }

 private:
  struct Sum {
    std::uint32_t checksum = 0;
    std::uint64_t bytes = 0;
  };

  std::string path_of(std::size_t shard) const { return shard_path(map_, {shard, shards_}); }

  /// Reads what every shard says of itself, before anything is written.
  void survey() {
    std::vector<std::size_t> holder;  // of each tile: the shard that has it
    for (std::size_t i = 1; i <= shards_; ++i) {
      const std::string path = path_of(i);
      const MapReader shard(path, locking_, Accept::shards_too);
      if (!hdf5::has_attribute(shard.file(), shard_attribute))
        throw InputError(fmt::format("{}: is a whole map and no shard; allowed: what --shard {}/{} makes",
                                     path, i, shards_));
      if (const std::string told = shard.attribute(shard_attribute); told != text_of(Shard{i, shards_}))
        throw InputError(
            fmt::format("{}: is shard {}, whatever its name says; allowed: shard {}/{} under that name", path,
                        told, i, shards_));
      if (!shard.is_whole())
        throw InputError(fmt::format("{}: is not whole; run it again, with --resume: --array={}", path, i));
      const Spec spec = spec_of(shard, path);
      if (i == 1) {
        spec_ = spec;
        layout_ = layout_of(spec_);
        tiling_.emplace(tiling_of(spec_));
        for (const char* name : same_everywhere) same_.emplace_back(name, shard.attribute(name));
        holder.resize(tiling_->size());
      } else if (const auto difference = first_difference(spec_, spec)) {
        throw InputError(fmt::format("{}: is of another spec than {}: {}; allowed: shards of one spec", path,
                                     path_of(1), *difference));
      }
      refuse_other_program(shard, path);
      add_up(shard);
      for (const std::size_t t :
           tiles_in(hdf5::read_integers(shard.file(), shard_tiles_attribute), tiling_->size())) {
        if (holder[t] != 0)
          throw InputError(
              fmt::format("{}: holds tile {} as {} does; allowed: shards that one program has cut", path, t,
                          path_of(holder[t])));
        holder[t] = i;
      }
    }
    if (const auto hole = std::ranges::find(holder, 0u); hole != holder.end())
      throw InputError(fmt::format("{}: no shard holds tile {}; allowed: shards that one program has cut",
                                   map_, hole - holder.begin()));
  }

  void refuse_other_program(const MapReader& shard, const std::string& path) const {
    if (hdf5::read_integers(shard.file(), "version") != std::vector<std::int64_t>{format_major, format_minor})
      throw InputError(
          path + ": has another format version than this program writes; allowed: the program that made it");
    for (const auto& [name, value] : same_)
      if (shard.attribute(name) != value)
        throw InputError(fmt::format(
            "{}: was made by another leapmap: {} is {} there and {} in {}, which may change bits; "
            "allowed: shards of one program and instruction set (leapmap --instruction-set)",
            path, name, shard.attribute(name), value, path_of(1)));
  }

  void add_up(const MapReader& shard) {
    const StatusCounts counts = shard.status_counts();
    for (std::size_t s = 0; s < counts.size(); ++s) progress_.statuses[s] += counts[s];
    progress_.seconds += hdf5::read_number(shard.file(), "wall_time");
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
    attributes.emplace_back("shards", static_cast<std::int64_t>(shards_));
    if (audit_) attributes.emplace_back("audit_method", audit_method_);
    return attributes;
  }

  /// Copies a shard's chunks. Returns false if a stop was requested.
  bool copy(std::size_t number, MapWriter& writer) {
    const std::string path = path_of(number);
    const MapReader shard(path, locking_, Accept::shards_too);
    const std::vector<std::size_t> tiles =
        tiles_in(hdf5::read_integers(shard.file(), shard_tiles_attribute), tiling_->size());
    check_layout(shard.file(), layout_, *tiling_);
    const std::vector<hdf5::Handle> fields = open_fields(shard.file(), layout_);
    EncodedChunk chunk;
    std::uint32_t checksum = 0;
    for (const std::size_t t : tiles) {
      if (options_.stop_requested && options_.stop_requested()) return false;
      const Tile tile = tiling_->tile(t);
      const std::vector<hsize_t> place(tile.start.begin(), tile.start.end());
      for (std::size_t f = 0; f < fields.size(); ++f) {
        chunk.skipped_filters = hdf5::read_chunk(fields[f], place, chunk.bytes, path + ": reading a tile");
        checksum = checksum_of(checksum, chunk.bytes, chunk.skipped_filters);
        sums_[t].checksum = checksum_of(sums_[t].checksum, chunk.bytes, chunk.skipped_filters);
        sums_[t].bytes += chunk.bytes.size() + sizeof chunk.skipped_filters;
        writer.put(tile, f, chunk);
      }
      ++progress_.tiles;
      done_ += tile.count;
      if (options_.progress) options_.progress(done_, tiling_->designs());
    }
    const std::vector<std::int64_t> told = hdf5::read_integers(shard.file(), "tiles_checksum");
    if (told.size() != 1 || told[0] != checksum)
      throw BrokenFile(
          fmt::format("{}: its tiles are not what was written; run it again, with --overwrite: --array={}",
                      path, number));
    return true;
  }

  static constexpr std::array same_everywhere{"program_version", "git_revision", "instruction_set"};

  const std::string map_;
  std::size_t shards_;
  const JoinOptions& options_;
  Locking locking_;
  Spec spec_;
  MapLayout layout_;
  std::optional<Tiling> tiling_;
  std::vector<std::pair<std::string, std::string>> same_;
  MapProgress progress_;
  std::optional<AuditReport> audit_;
  std::string audit_method_;
  std::vector<Sum> sums_;  ///< of each tile's chunks
  std::size_t done_ = 0;   ///< designs
};

}  // namespace

std::optional<JoinReport> join(const std::string& path, const JoinOptions& options) {
  const std::string map = behind_links(path);
  std::error_code ignored;
  if (fs::exists(map, ignored) && !options.overwrite)
    throw InputError(map +
                     ": exists already; allowed: another name for the shards and the map, or --overwrite");
  const std::size_t shards = shards_of(map, options.shards);
  refuse_missing(map, shards);
  return Joining(map, shards, options).run();
}

}  // namespace leapmap
