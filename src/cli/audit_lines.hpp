// SPDX-License-Identifier: GPL-3.0-or-later
/// What the cross-check of a map found, and how later jumps and gaits are reported.
#pragma once

#include <string>

#include "cli/shown_units.hpp"
#include "leapmap/audit.hpp"
#include "leapmap/outcome.hpp"

namespace leapmap::cli {

/// Prints a line for each method that solved some of a map's designs again.
void say_audit(const AuditReport& report);

/// What a release comes to: its gait, after so many jumps.
std::string settled_line(const Outcome& outcome, long settle, ShownUnits& units);

/// How many of a hoop's later jumps the audit has confirmed, and how far to believe them; empty: it makes
/// none.
std::string later_jumps_line(const AuditReport& report, const Outcome& outcome);

}  // namespace leapmap::cli
