// SPDX-License-Identifier: GPL-3.0-or-later
/// Checks the tolerances and goals of a spec.
#pragma once

#include "spec/spec.hpp"

namespace leapmap {

/// Throws InputError if the spec's [scatter] or [goal] is not one that read_spec would accept, or if most of
/// a tolerance's distribution is outside its parameter's domain.
void check_scatter(const Spec& spec);

}  // namespace leapmap
