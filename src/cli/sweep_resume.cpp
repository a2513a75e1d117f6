// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>

#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "map/schema.hpp"
#include "support/errors.hpp"
#include "sweep/map_spec.hpp"

namespace leapmap::cli {
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
    if (key == "program_version" || key == "git_revision" || key == "instruction_set")
      if (part.attribute(key) != std::get<std::string>(value))
        throw InputError(
            fmt::format("{}: was begun by another leapmap: {} is {} there and {} here; allowed: that one, {}",
                        name, key, part.attribute(key), std::get<std::string>(value), allowed));
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

std::string sweep_command(const SweepArguments& arguments, const std::string& map, std::string_view how) {
  std::string command =
      fmt::format("leapmap sweep {} -o {} {}", shell_quoted(arguments.spec), shell_quoted(map), how);
  for (const std::string& set : arguments.overrides) command += " --set " + shell_quoted(set);
  if (arguments.threads > 0) command += fmt::format(" --threads {}", arguments.threads);
  if (arguments.commit_interval != SweepArguments{}.commit_interval)
    command += fmt::format(" --commit-interval {}", arguments.commit_interval);
  if (arguments.locking != Locking::required) command += " --no-lock";
  if (how == "--resume" && exists(map))
    command += " --overwrite";  // the older map, once the new one is whole
  return command;
}

MapWriter open_map(const SweepArguments& arguments, const std::string& map, const Spec& spec,
                   const MapLayout& layout, const Tiling& tiling, std::span<const hdf5::Attribute> opening) {
  const std::string part = part_of(map);
  if (!arguments.resume || !has_part(map, arguments.locking))
    return MapWriter::begin(map, layout, tiling, opening, arguments.overwrite, arguments.locking);
  try {
    MapWriter writer = MapWriter::resume(map, layout, tiling, arguments.overwrite, arguments.locking);
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

void refuse_own_input(const SweepArguments& arguments, const Spec& spec, const std::string& map) {
  for (const std::string& input : {arguments.spec, spec.points})
    for (const std::string& output : {map, part_of(map)}) {
      std::error_code ignored;  // one of them is not there
      if (!input.empty() && std::filesystem::equivalent(input, output, ignored))
        throw InputError(fmt::format("{}: is what the sweep is made from; allowed: another -o", output));
    }
}

bool is_done(const SweepArguments& arguments, const std::string& map, const Spec& spec) {
  if (!arguments.resume || arguments.overwrite || exists(part_of(map)) || !exists(map)) return false;
  if (const auto difference = first_difference(spec_of(MapReader(map, arguments.locking), map), spec))
    throw InputError(fmt::format(
        "{}: exists already, of another spec: {}; allowed: another -o, or --overwrite", map, *difference));
  return true;
}

}  // namespace leapmap::cli
