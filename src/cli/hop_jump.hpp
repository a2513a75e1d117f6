// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of hop's report that tells of the jumps: how high, how far, how hard they land.
#pragma once

#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap::cli {

/// Of the first jump, and of those after it a line each. Nothing without a jump.
void print_jump(const Spec& spec, const Outcome& jump);

}  // namespace leapmap::cli
