// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/output.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "sweep/audit.hpp"
#include "sweep/designs.hpp"
#include "sweep/engine.hpp"
#include "sweep/map_layout.hpp"
#include "sweep/parallel.hpp"

namespace leapmap::cli {
namespace {

/// What lies where the map is to be, and what the sweep would make of it. Returns how many designs need not
/// be solved again.
std::size_t print_existing(const SweepArguments& arguments, const std::string& map) {
  std::error_code ignored;
  if (std::filesystem::exists(map, ignored) && !arguments.overwrite)
    say("there    {} exists already: it is refused without --overwrite\n", map);
  if (!has_part(map, arguments.locking)) return 0;
  const std::string part = part_of(map);
  const std::size_t designs = designs_in(MapReader(part, arguments.locking).status_counts());
  say("there    {} holds {} designs: {}\n", part, grouped(designs),
      arguments.resume      ? "it is gone on with"
      : arguments.overwrite ? "they are overwritten"
                            : "it is refused without --resume or --overwrite");
  return arguments.resume ? designs : 0;
}

}  // namespace

void print_plan(const SweepArguments& arguments, const Spec& spec, const std::string& map,
                const Tiling& tiling) {
  const MapLayout layout = layout_of(spec);
  const int threads = thread_count(arguments.threads);
  say("map      {}\n", map.empty() ? "(none: give -o or output.file)" : map);
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
  say("designs  {} in {} tiles of {}\n", grouped(tiling.designs()), grouped(tiling.size()),
      fmt::join(tiling.tile_shape(), " x "));
  say("method   {}, tolerance {:g}\n", resolved_method(spec.numerics), spec.numerics.tolerance);
  const double tile_bytes = static_cast<double>(tiling.tile(0).count) * (sizeof(Outcome) + sizeof(Design));
  double axis_values = 0.0;
  for (const Axis& axis : spec.axes) axis_values += static_cast<double>(axis.values.size());
  const double file = static_cast<double>(map_bytes(layout, tiling)) + 5e4;
  const double memory = threads * tile_bytes + std::min(file, static_cast<double>(most_waiting_bytes)) + 2e7 +
                        40.0 * axis_values +
                        (spec.axes.empty() ? 64.0 * static_cast<double>(spec.list.count) : 0.0);
  std::vector<std::string_view> fields;
  for (const Field* field : layout.fields) fields.push_back(field->name);
  say("audit    {:g} of them, again by {}\n", spec.numerics.audit, audit_method(spec.numerics));
  say("fields   {} in {}\n", fmt::join(fields, ", "), spec.output.precision);
  say("memory   about {}, at most\n", spoken_bytes(memory));
  say("file     about {}{}\n", spoken_bytes(file), layout.compression > 0 ? " before compression" : "");
  const double seconds =
      seconds_per_design(spec, 0.5) * static_cast<double>(tiling.designs() - already) / threads;
  say("time     about {} on {} threads\n", spoken_duration(seconds), threads);
}

}  // namespace leapmap::cli
