// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "audit/audit.hpp"
#include "cli/output.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "engine/engine.hpp"
#include "engine/map_layout.hpp"
#include "engine/parallel.hpp"
#include "engine/places.hpp"
#include "request/request.hpp"
#include "request/solver.hpp"
#include "shards/shard.hpp"
#include "spec/designs.hpp"

namespace leapmap::cli {
namespace {

/// What lies where the map is to be, and what the sweep would make of it. Returns how many designs need not
/// be solved again.
std::size_t print_existing(const SweepArguments& arguments, const std::string& map) {
  std::error_code ignored;
  if (std::filesystem::exists(map, ignored) && !arguments.overwrite)
    say("exists   {}: the sweep will refuse it without --overwrite, or if it is not a map\n", map);
  if (!has_part(map, arguments.locking)) return 0;
  const std::string part = part_of(map);
  const std::size_t designs = designs_in(MapReader(part, arguments.locking).status_counts());
  say("exists   {} holds {} designs: {}\n", part, grouped(designs),
      arguments.resume      ? "the sweep will resume it"
      : arguments.overwrite ? "the sweep will overwrite them"
                            : "the sweep will refuse it without --resume or --overwrite");
  return arguments.resume ? designs : 0;
}

/// What the sweep, and what reads its map, take at most. The constants are measured, with room to spare: what
/// the program or Python takes by itself, and what HDF5 keeps of a file's own structure.
std::string memory_line(const Spec& spec, const MapLayout& layout, const Tiling& tiling, int threads) {
  constexpr double program = 3e7, python = 1e8, most_structure = 4e7, explorer_per_design = 70.0;
  constexpr std::size_t most_on_page = 4'000'000;  // analysis/explorer, MOST_DESIGNS
  const double file = map_file_bytes(layout, tiling), designs = static_cast<double>(tiling.designs());
  double axis_values = 0.0;
  for (const Axis& axis : spec.axes) axis_values += static_cast<double>(axis.values.size());
  const double held =
      40.0 * axis_values + (spec.axes.empty() ? 72.0 * static_cast<double>(spec.list.count) : 0.0);
  const double structure = std::min(0.01 * file, most_structure);
  const double tile = static_cast<double>(tiling.largest_tile()) * (sizeof(Outcome) + sizeof(Design));
  const double samples = static_cast<double>(spec.scatter.samples),
               spreads = static_cast<double>(spec.scatter.spreads.size());
  const double made =
      spreads > 0.0
          ? 8.0 * samples * (spreads + threads * (spreads + 2.0 * static_cast<double>(layout.fields.size())))
          : 0.0;
  const double sweep = made + program + held + structure + threads * tile +
                       std::min(file, static_cast<double>(most_waiting_bytes(threads)));
  std::string line = fmt::format("at most {} for the sweep with its cross-check; {} for leapmap info",
                                 spoken_bytes(sweep), spoken_bytes(program + held + structure));
  if (spec.axes.size() >= 2)
    line += tiling.designs() > most_on_page
                ? "; too many designs for the explorer"
                : fmt::format("; {} for the explorer",
                              spoken_bytes(python + file + explorer_per_design * designs));
  return line;
}

/// Of parts for jobs of their own: how long the longest takes and how large its file is, and how many of them
/// a time limit asks for. seconds: of the whole map on one thread.
void print_shards(const SweepArguments& arguments, const Spec& spec, const std::string& map,
                  const MapLayout& layout, const Tiling& tiling, double seconds) {
  constexpr double spare = 0.8;  // of the time limit: machines differ, and jobs start and end
  const auto threads = static_cast<std::size_t>(thread_count(arguments.threads));
  const std::vector<double> efforts =
      tile_efforts(spec, tiling, std::max<std::size_t>(arguments.shards, 1), arguments.threads);
  const double all = std::accumulate(efforts.begin(), efforts.end(), 0.0);
  const auto sums_of = [](const std::vector<double>& tiles, std::size_t parts) {
    std::vector<double> sums;
    for (const std::vector<std::size_t>& share : share_tiles(tiles, parts)) {
      sums.push_back(0.0);
      for (const std::size_t t : share) sums.back() += tiles[t];
    }
    return sums;
  };
  // What the slowest shard takes, whose tiles are shared by threads in turn.
  const auto longest = [&](std::size_t shards) {
    double most = 0.0;
    for (const std::vector<std::size_t>& share : share_tiles(efforts, shards)) {
      std::vector<double> tiles;
      for (const std::size_t t : share) tiles.push_back(efforts[t]);
      most = std::max(most, std::ranges::max(sums_of(tiles, threads)));
    }
    return seconds * most / all;
  };
  std::size_t shards = arguments.shards;
  const std::size_t most = std::min(tiling.size(), most_shards);
  if (arguments.time_limit > 0.0) {
    const double limit = spare * 3600.0 * arguments.time_limit;
    const double least = std::ceil(seconds / static_cast<double>(threads) / limit);
    std::size_t fits = std::clamp<std::size_t>(static_cast<std::size_t>(std::min(least, 1e9)), 1, most);
    while (fits < most && longest(fits) > limit) fits = std::min(most, fits + 1 + fits / 64);
    say("limit    {} per job: {} shards{}\n", spoken_duration(3600.0 * arguments.time_limit), grouped(fits),
        longest(fits) <= limit ? "" : ", and even then the longest takes more");
    if (shards == 0) shards = fits;
  }
  if (shards > tiling.size()) {
    say("shards   {} are more than its {} chunks, which cannot be divided\n", grouped(shards),
        grouped(tiling.size()));
    return;
  }
  const double even = 1.0 / static_cast<double>(shards);
  say("shards   {}: about {} designs each, the longest {} on {} threads, {:.2f} times the mean, and {} on "
      "disk; memory as above\n",
      grouped(shards),
      grouped(static_cast<std::size_t>(std::ceil(static_cast<double>(tiling.designs()) * even))),
      spoken_duration(longest(shards)), threads, std::ranges::max(sums_of(efforts, shards)) / (all * even),
      spoken_bytes(map_file_bytes(layout, tiling) * even));
  if (!map.empty())
    say("         leapmap sweep ... --shard 1/{0} to --shard {0}/{0}, then leapmap join {1}\n", shards, map);
}

std::string which_are_solved(const Spec& spec) {
  const std::string_view along = interpolated_along(spec, request_of(spec));
  return along.empty() ? "all solved" : fmt::format("some solved, the others interpolated along {}", along);
}

}  // namespace

void print_plan(const SweepArguments& arguments, const Spec& spec, const std::string& map,
                const Tiling& tiling) {
  const MapLayout layout = layout_of(spec);
  const int threads = thread_count(arguments.threads);
  say("map      {}\n", map.empty() ? "(none: use -o or output.file)" : map);
  if (arguments.retry_failed) {
    const StatusCounts counts = MapReader(map, arguments.locking).status_counts();
    say("retry    {} failed designs\n",
        grouped(static_cast<std::uint64_t>(counts[static_cast<std::size_t>(Status::failed)])));
    return;
  }
  const std::size_t already = map.empty() ? 0 : print_existing(arguments, map);
  if (spec.axes.empty()) say("list     {} designs {}\n", grouped(spec.list.count), spec.list.path);
  for (const Axis& axis : spec.axes)
    say("axis     {} from {:.6g} to {:.6g}, {} values\n", axis.key, axis.values.front(), axis.values.back(),
        axis.values.size());
  say("designs  {} in {} chunks of {}\n", grouped(tiling.designs()), grouped(tiling.size()),
      fmt::join(tiling.tile_shape(), " x "));
  if (!spec.scatter.spreads.empty())
    say("samples  {} manufactured hoops per design, {}\n",
        grouped(static_cast<std::uint64_t>(spec.scatter.samples)), which_are_solved(spec));
  say("method   {}, tolerance {:g}\n", resolved_method(spec), spec.numerics.tolerance);
  std::vector<std::string_view> fields;
  for (const Field* field : layout.fields) fields.push_back(field->name);
  say("check    {:g} of them, by {}\n", spec.numerics.audit, auditor_of(spec.numerics, spec.scene));
  say("fields   {} in {}\n", fmt::join(fields, ", "), spec.output.precision);
  say("memory   {}\n", memory_line(spec, layout, tiling, threads));
  say("file     about {}{}\n", spoken_bytes(map_file_bytes(layout, tiling)),
      layout.compression > 0 ? " before compression" : "");
  const double alone =
      seconds_per_design(spec, request_of(spec), 0.5) * static_cast<double>(tiling.designs() - already);
  const double seconds = alone / static_cast<double>(std::clamp<std::size_t>(
                                     tiling.size(), 1, static_cast<std::size_t>(threads)));
  if (const std::string places = told_places(); !places.empty()) say("places   {}\n", places);
  say("time     about {} on {} threads\n", spoken_duration(seconds), threads);
  if (arguments.shards > 0 || arguments.time_limit > 0.0)
    print_shards(arguments, spec, map, layout, tiling, alone);
}

}  // namespace leapmap::cli
