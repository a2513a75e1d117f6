// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/begin_map.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "support/printable.hpp"
#include "sweep/map_spec.hpp"

namespace leapmap {
namespace {

bool exists(const std::string& path) {
  std::error_code ignored;  // of a folder that may not be entered: creating the file there tells
  return std::filesystem::exists(path, ignored);
}

/// What a resumed sweep has to share with the one that began: the spec, the format, and the program, as far
/// as numbers depend on it.
void refuse_other_beginning(const MapReader& part, const std::string& name, const Spec& spec,
                            std::span<const hdf5::Attribute> now) {
  constexpr std::string_view allowed = "another -o, or --overwrite without --resume to start anew";
  if (hdf5::read_integers(part.file(), "version") != std::vector<std::int64_t>{format_major, format_minor})
    throw InputError(fmt::format("{}: has another format version; allowed: {}", name, allowed));
  for (const auto& [key, value] : now)
    if (key == shard_tiles_attribute &&
        hdf5::read_integers(part.file(), key) != std::get<std::vector<std::int64_t>>(value))
      throw InputError(fmt::format("{}: was begun with other tiles of the map; allowed: {}", name, allowed));
  for (const auto& [key, value] : now)
    if (key == "program_version" || key == "git_revision" || key == "instruction_set" ||
        key == shard_attribute)
      if (part.attribute(key) != std::get<std::string>(value))
        throw InputError(fmt::format(
            "{}: was begun by another leapmap: {} is {} there and {} here; allowed: that one{}, {}", name,
            key, part.attribute(key), std::get<std::string>(value),
            key == "instruction_set" ? " by --instruction-set" : "", allowed));
  if (const auto difference = first_difference(spec_of(part, name), spec))
    throw InputError(
        fmt::format("{}: was begun with another spec: {}; allowed: that spec (leapmap info --spec {}), {}",
                    name, *difference, shell_quoted(name), allowed));
}

}  // namespace

std::string behind_links(const std::string& map) {
  constexpr int most_links = 40;  // as the kernel: links may form a ring
  std::filesystem::path path = map;
  std::error_code error;
  for (int i = 0; i < most_links && std::filesystem::is_symlink(path, error); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return path.string();
}

MapWriter begin_map(const std::string& map, const Spec& spec, const MapLayout& layout, const Tiling& tiling,
                    std::span<const hdf5::Attribute> opening, const SweepOptions& options, Locking locking) {
  const std::string part = part_of(map);
  if (!options.resume || !has_part(map, locking))
    return MapWriter::begin(map, layout, tiling, opening, options.overwrite, locking);
  try {
    MapWriter writer = MapWriter::resume(map, layout, tiling, options.overwrite, locking);
    refuse_other_beginning(writer.reader(), part, spec, opening);
    writer.verify();
    return writer;
  } catch (const ForeignFile&) {
    throw;
  } catch (const BrokenFile& error) {
    throw IoError(
        fmt::format("{}; it cannot be gone on with: --overwrite without --resume starts anew", error.what()));
  }
}

void refuse_own_input(const Spec& spec, const std::string& map) {
  for (const std::string& input : {spec.origin, spec.points})
    for (const std::string& output : {map, part_of(map)}) {
      std::error_code ignored;  // one of them is not there
      if (!input.empty() && std::filesystem::equivalent(input, output, ignored))
        throw InputError(fmt::format("{}: is what the sweep is made from; allowed: another -o", output));
    }
}

bool is_done(const std::string& map, const Spec& spec, const SweepOptions& options, Locking locking) {
  if (!options.resume || options.overwrite || exists(part_of(map)) || !exists(map)) return false;
  if (const auto difference =
          first_difference(spec_of(MapReader(map, locking, Accept::shards_too), map), spec))
    throw InputError(fmt::format(
        "{}: exists already, of another spec: {}; allowed: another -o, or --overwrite", map, *difference));
  return true;
}

}  // namespace leapmap
