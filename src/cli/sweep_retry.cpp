// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>

#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "leapmap/errors.hpp"
#include "spec/map_spec.hpp"
#include "support/printable.hpp"
#include "sweep/retry.hpp"

namespace leapmap::cli {

int retry_sweep(const SweepArguments& arguments, const Spec& spec, const std::string& map) {
  Spec there;
  std::error_code ignored;
  if (!std::filesystem::exists(map, ignored) && std::filesystem::exists(part_of(map), ignored))
    throw InputError(fmt::format("{}: does not exist yet, only {}; allowed: first {}", map, part_of(map),
                                 sweep_command(arguments, map, "--resume")));
  {
    const MapReader reader(map, arguments.locking);
    there = spec_of(reader, map);
  }
  if (const auto difference = first_difference(there, spec, true))
    throw InputError(
        fmt::format("{}: holds other designs: {}; allowed: its own spec (leapmap info --spec {})", map,
                    *difference, shell_quoted(map)));
  there.numerics = retry_numerics(there.numerics, spec.numerics, there.scene);
  note_signals();
  const auto report =
      retry_with(map, there, arguments.threads, arguments.locking, [] { return noted_signal() != 0; });
  if (!report) {
    tell(fmt::format("interrupted; {} is unchanged", map));
    return 128 + noted_signal();
  }
  if (!report->durable) tell_of_folder(map);
  if (arguments.quiet) return 0;
  say("retried  {} failed designs by {} at tolerance {:g}: {} solved, {} failed again\n",
      grouped(report->retried), resolved_method(there), there.numerics.tolerance,
      grouped(report->retried - report->still_failed), grouped(report->still_failed));
  print_totals(report->statuses);
  if (report->retried > 0 && !there.scatter.spreads.empty())
    say("note     yields and quantiles of these designs are unchanged; only a new sweep computes them\n");
  say("map      {}\n", map);
  return 0;
}

}  // namespace leapmap::cli
