// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop --gradient: how one design's outcome changes with its parameters.
#pragma once

#include "cli/json.hpp"
#include "spec/spec.hpp"

namespace leapmap::cli {

/// A table: a row for each quantity that the design has, a column for each parameter of its model.
void print_gradient(const Spec& spec);

/// The same as JSON: {"jump_height": {"slope": ..., ...}, ...}
Json gradient_json(const Spec& spec);

}  // namespace leapmap::cli
