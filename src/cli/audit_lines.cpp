// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/audit_lines.hpp"

#include <fmt/format.h>

#include <cmath>

#include "boundaries/cliff.hpp"
#include "cli/info_place.hpp"
#include "cli/output.hpp"
#include "cli/spoken.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {

namespace {

/// "; 3 inconclusive", or nothing.
std::string and_some(std::size_t designs, std::string_view what) {
  return designs > 0 ? fmt::format("; {} {}", grouped(designs), what) : "";
}

/// Wilson's upper bound of a share, of which so many of a sample were found: with 95 % confidence it is less.
double most_likely_share(std::size_t found, std::size_t sample) {
  constexpr double z = 1.959963984540054;
  const double n = static_cast<double>(sample), p = static_cast<double>(found) / n, z2 = z * z;
  return (p + z2 / (2.0 * n) + z * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n))) / (1.0 + z2 / n);
}

/// What the audit states of the whole map, if it says enough.
std::string statement(const AuditReport& report) {
  const std::size_t judged = report.designs - report.failed - report.undecided;
  constexpr std::size_t enough = 20;
  if (judged < enough) return "";
  const std::size_t wrong = report.flag_mismatches + report.beyond_tolerance;
  return fmt::format("; of the map at most {:.2g} % are wrong (95 % confidence)",
                     100.0 * most_likely_share(wrong, judged));
}

}  // namespace

void say_audit(const AuditReport& report) {
  const auto error = [](double most) {
    return std::isnan(most) ? "not measured" : fmt::format("{:.1e}", most);
  };
  say("check    {} designs by {}: height within {} diameters, time within {}, motion within {}, {} flags "
      "differ{}{}{}{}\n",
      grouped(report.designs), printable(report.method), error(report.max_abs_height_error),
      error(report.max_rel_time_error), error(report.max_rel_motion_error), grouped(report.flag_mismatches),
      and_some(report.beyond_tolerance, "beyond the tolerance"), and_some(report.undecided, "inconclusive"),
      and_some(report.failed, "failed, not compared"), statement(report));
  if (report.refereed > 0)
    say("referee  {} of them by the independent reference solver: {} wrong, largest error {}{}\n",
        grouped(report.refereed), grouped(report.overruled), error(report.referee_max_error),
        and_some(report.referee_undecided, "inconclusive"));
  if (report.gradient_designs > 0)
    say("gradient {} of them by differences in long double: {} wrong, largest error {}{}\n",
        grouped(report.gradient_designs), grouped(report.gradients_wrong), error(report.gradient_max_error),
        and_some(report.gradient_undecided, "inconclusive"));
  if (report.jumps_compared + report.jumps_beyond + report.sequences_wrong > 0)
    say("jumps    {} later jumps: {} designs wrong, largest error {} over its growth{}\n",
        grouped(report.jumps_compared), grouped(report.sequences_wrong), error(report.jump_max_error),
        and_some(report.jumps_beyond, "more not compared, because errors grow too much"));
  if (report.gaits > 0)
    say("gaits    {} by integration over one period: {} wrong, largest error {}, of a multiplier {}{}\n",
        grouped(report.gaits), grouped(report.gaits_wrong), error(report.gait_max_error),
        error(report.multiplier_max_error), and_some(report.gaits_undecided, "inconclusive"));
}

std::string settled_line(const Outcome& outcome, long settle, ShownUnits& units) {
  if (outcome.status != Status::jumped)
    return fmt::format("After this release it does not jump: {}.", outcome_text(discrete(outcome, false)));
  if (outcome.gait_period == 0)
    return fmt::format(
        "After this release it makes fewer than {} jumps: it is trapped, or reaches the rolling limit.",
        settle);
  if (outcome.gait_period == Outcome::no_gait)
    return fmt::format("After this release no period was found within {} jumps, or errors grow too much.",
                       settle);
  const auto shown = [&](const char* field, double value) {
    return units.with_unit(value, *find_field(field));
  };
  return fmt::format(
      "After this release its jumps converge to a gait of period {}: {}, {} down the plane, {} and {} lost "
      "per jump; Floquet multiplier {:.6f}.",
      outcome.gait_period, shown("gait_height", outcome.gait_height), shown("gait_speed", outcome.gait_speed),
      shown("gait_jump_time", outcome.gait_jump_time), shown("gait_energy_lost", outcome.gait_energy_lost),
      outcome.gait_multiplier);
}

std::string later_jumps_line(const AuditReport& report, const Outcome& outcome) {
  if (outcome.jumps() < 2) return {};
  const std::string grown =
      std::isnan(outcome.sequence_condition)
          ? ""
          : fmt::format(" Errors have grown {:.2g}-fold at the last{}.", outcome.sequence_condition,
                        outcome.sequence_condition > 1e12
                            ? ": the last jumps are typical, not those of this hoop"
                            : "");
  return fmt::format("Later jumps: {} of {} compared, {} {:.1e} over the growth of errors.{}",
                     report.jumps_compared, outcome.jumps() - 1,
                     report.first_wrong_sequence ? "which DISAGREE: off by" : "all within",
                     report.jump_max_error, grown);
}

}  // namespace leapmap::cli
