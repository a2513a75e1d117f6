// SPDX-License-Identifier: GPL-3.0-or-later
/// What an audit found of later jumps and gaits, for people.
#pragma once

#include "leapmap/audit.hpp"

namespace leapmap::cli {

/// Prints a line of later jumps and one of gaits, where the audit looked at any.
void say_sequences(const AuditReport& report);

}  // namespace leapmap::cli
