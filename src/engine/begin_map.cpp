// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/begin_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/provenance.hpp"
#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "spec/map_spec.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

bool exists(const std::string& path) {
  std::error_code ignored;  // of a folder that may not be entered: creating the file there tells
  return std::filesystem::exists(path, ignored);
}

/// What a sweep that goes on, or finds its map whole, has to share with the one that began: the format, the
/// program, as far as numbers depend on it, the spec, and of a shard its tiles.
void refuse_other_beginning(const MapReader& part, const std::string& name, const Spec& spec,
                            std::span<const hdf5::Attribute> now) {
  constexpr std::string_view allowed = "another -o, or --overwrite without --resume to start again";
  const auto value_now = [&](std::string_view key) {
    const auto found = std::ranges::find(now, key, &hdf5::Attribute::first);
    return found == now.end() ? nullptr : &found->second;
  };
  const auto text_now = [&](std::string_view key) {
    const auto* value = value_now(key);
    return value ? std::get<std::string>(*value) : std::string();
  };
  if (hdf5::has_attribute(part.file(), shards_attribute))
    throw InputError(fmt::format("{}: leapmap join made it, of {} shards; allowed: leapmap join, {}", name,
                                 part.attribute(shards_attribute), allowed));
  if (hdf5::read_integers(part.file(), "version") != std::vector<std::int64_t>{format_major, format_minor})
    throw InputError(fmt::format("{}: has another format version; allowed: {}", name, allowed));
  const std::string shard = part.attribute(shard_attribute), shard_now = text_now(shard_attribute);
  if (shard != shard_now)
    throw InputError(fmt::format("{}: is {}; allowed here: {}, or {}", name,
                                 shard.empty() ? "a whole map" : "shard " + shard,
                                 shard_now.empty() ? "a whole map" : "shard " + shard_now, allowed));
  for (const std::string key : bits_depend_on)
    if (part.attribute(key) != text_now(key))
      throw InputError(fmt::format(
          "{}: was started by another leapmap: {} is {} there and {} here; allowed: that one{}, {}", name,
          key, part.attribute(key), text_now(key), key == "instruction_set" ? " by --instruction-set" : "",
          allowed));
  if (const auto difference = first_difference(spec_of(part, name), spec))
    throw InputError(fmt::format(
        "{}: was started with another spec: {}; allowed: that spec{}, {}", name, *difference,
        shard.empty() ? fmt::format(" (leapmap info --spec {})", shell_quoted(name)) : "", allowed));
  if (const auto* tiles = value_now(shard_tiles_attribute)) {
    const auto& bits = std::get<std::vector<std::int64_t>>(*tiles);
    if (hdf5::read_integers(part.file(), shard_tiles_attribute, bits.size()) != bits)
      throw InputError(
          fmt::format("{}: was started with other chunks of the map; allowed: {}", name, allowed));
  }
}

}  // namespace

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
    throw IoError(fmt::format(
        "{}; it cannot be resumed; allowed: --overwrite without --resume to start again", error.what()));
  }
}

void refuse_own_input(const Spec& spec, const std::string& map) {
  for (const std::string& input : {spec.origin, spec.points})
    for (const std::string& output : {map, part_of(map)})
      if (!input.empty() && same_file(input, output))
        throw InputError(fmt::format("{}: is an input of the sweep; allowed: another -o", output));
}

bool is_done(const std::string& map, const Spec& spec, std::span<const hdf5::Attribute> opening,
             const SweepOptions& options, Locking locking) {
  if (!options.resume || options.overwrite || exists(part_of(map)) || !exists(map)) return false;
  const MapReader whole(map, locking, Accept::shards_too);
  // Shards are joined, so that all of it has to be right; a map of another program is a map.
  if (options.shard || hdf5::has_attribute(whole.file(), shard_attribute)) {
    refuse_other_beginning(whole, map, spec, opening);
  } else if (const auto difference = first_difference(spec_of(whole, map), spec)) {
    throw InputError(fmt::format(
        "{}: exists already, with another spec: {}; allowed: another -o, or --overwrite", map, *difference));
  }
  return true;
}

}  // namespace leapmap
