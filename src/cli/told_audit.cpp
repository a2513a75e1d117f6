// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/told_audit.hpp"

#include <fmt/format.h>

#include "cli/output.hpp"
#include "cli/spoken.hpp"

namespace leapmap::cli {

void say_sequences(const AuditReport& report) {
  if (report.jumps_compared + report.jumps_beyond > 0)
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

}  // namespace leapmap::cli
