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
    say("jumps    {} later ones again: {} designs wrong, largest error {:.1e} over its growth{}\n",
        grouped(report.jumps_compared), report.sequences_wrong, report.jump_max_error,
        report.jumps_beyond > 0
            ? fmt::format("; {} more are beyond what doubles know", grouped(report.jumps_beyond))
            : "");
  if (report.gaits > 0)
    say("gaits    {} by integration once round: {} wrong, largest error {:.1e}, of a multiplier {:.1e}{}\n",
        grouped(report.gaits), report.gaits_wrong, report.gait_max_error, report.multiplier_max_error,
        report.gaits_undecided > 0 ? fmt::format("; {} it cannot decide", report.gaits_undecided) : "");
}

std::string settled_line(const Outcome& outcome, long settle) {
  if (outcome.status != Status::jumped)
    return fmt::format("As released it does not jump: {}.", told(discrete(outcome, false)));
  if (outcome.gait_period == 0)
    return fmt::format("As released it does not go on for {} jumps: it stalls, or comes to the runway's end.",
                       settle);
  if (outcome.gait_period == Outcome::no_gait)
    return fmt::format(
        "As released it repeats itself after {} jumps in no gait that was looked for, or its "
        "jumps cannot be told that far.",
        settle);
  return fmt::format(
      "As released it settles on a gait of period {}: {:.6f} diameters, {:.4g} m/s down the plane, {:.6g} (m "
      "+ m_p) "
      "g R lost a jump; multiplier {:.6f}.",
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
                            ? ": of that hoop nothing is known so far on, the jumps are "
                              "some of their kind"
                            : "");
  return fmt::format("Later jumps: {} of {} again, {} {:.1e} over the growth of errors.{}",
                     report.jumps_compared, outcome.jumps() - 1,
                     report.first_wrong_sequence ? "which DISAGREE: off by" : "all within",
                     report.jump_max_error, grown);
}

}  // namespace leapmap::cli
