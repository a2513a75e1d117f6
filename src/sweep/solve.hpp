// SPDX-License-Identifier: GPL-3.0-or-later
/// Many designs on all threads, a block at a time, for whoever wants outcomes elsewhere than in one array.
#pragma once

#include <functional>

#include "leapmap/solve.hpp"

namespace leapmap {

/// Designs `first` to `first + designs.size() - 1` are to be put into `designs`; or their outcomes be taken.
/// Both are called on any thread, once for each block of neighbours; blocks are the same whatever the number
/// of threads.
using GiveDesigns = std::function<void(std::size_t first, std::span<Design> designs)>;
using TakeOutcomes = std::function<void(std::size_t first, std::span<const Outcome> outcomes)>;

/// Solves `count` designs. Each is checked: throws InputError with its number.
void solve_blocks(std::size_t count, const GiveDesigns& give, const TakeOutcomes& take, const Scene& scene,
                  const SolveOptions& options);

}  // namespace leapmap
