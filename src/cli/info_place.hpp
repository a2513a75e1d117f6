// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap info MAP --at: one design of a map's space, and what is around it.
#pragma once

#include <string>

#include "leapmap/boundaries.hpp"
#include "spec/spec.hpp"

namespace leapmap::cli {

/// Tells the design's outcome, its derivatives, and the nearest cliffs along each axis and in all. at:
/// AXIS=VALUE,... with every axis of the spec. unit_words: of --units. Throws InputError.
void print_place(const Spec& spec, const std::string& at, const std::string& unit_words);

/// "jumped at lift-off 2", "no_jump" and the like.
std::string outcome_text(const Discrete& outcome);

}  // namespace leapmap::cli
