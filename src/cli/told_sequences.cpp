// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/told_sequences.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/info_place.hpp"
#include "cli/output.hpp"
#include "cli/spoken.hpp"
#include "sweep/cliff.hpp"

namespace leapmap::cli {

void say_sequences(const AuditReport& report) {
  if (report.jumps_compared + report.jumps_beyond + report.sequences_wrong > 0)
    say("jumps    {} later jumps: {} designs wrong, largest error {:.1e} over its growth{}\n",
        grouped(report.jumps_compared), report.sequences_wrong, report.jump_max_error,
        report.jumps_beyond > 0 ? fmt::format("; {} more not compared, because errors grow too much",
                                              grouped(report.jumps_beyond))
                                : "");
  if (report.gaits > 0)
    say("gaits    {} by integration over one period: {} wrong, largest error {:.1e}, of a multiplier "
        "{:.1e}{}\n",
        grouped(report.gaits), report.gaits_wrong, report.gait_max_error, report.multiplier_max_error,
        report.gaits_undecided > 0 ? fmt::format("; {} inconclusive", report.gaits_undecided) : "");
}

std::string settled_line(const Outcome& outcome, long settle) {
  if (outcome.status != Status::jumped)
    return fmt::format("After this release it does not jump: {}.", told(discrete(outcome, false)));
  if (outcome.gait_period == 0)
    return fmt::format(
        "After this release it makes fewer than {} jumps: it is trapped, or reaches the rolling limit.",
        settle);
  if (outcome.gait_period == Outcome::no_gait)
    return fmt::format("After this release no period was found within {} jumps, or errors grow too much.",
                       settle);
  return fmt::format(
      "After this release its jumps converge to a gait of period {}: {:.6f} diameters, {:.4g} m/s down the "
      "plane, {:.6g} (m + m_p) g R lost per jump; Floquet multiplier {:.6f}.",
      outcome.gait_period, outcome.gait_height, outcome.gait_speed, outcome.gait_energy_lost,
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
