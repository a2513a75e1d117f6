// SPDX-License-Identifier: GPL-3.0-or-later
/// What make_solving comes to in one set of kernels (model/kernels.hpp).
#pragma once

#include "study/contestant.hpp"

namespace leapmap {

Solving solving_of(const Contestant& contestant, const Scene& scene, long max_steps);

}  // namespace leapmap
