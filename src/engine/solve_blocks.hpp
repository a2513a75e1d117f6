// SPDX-License-Identifier: GPL-3.0-or-later
/// Many designs on all cores, asked for and handed over a block at a time: whoever keeps designs or outcomes
/// in a shape of its own need not copy all of them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "leapmap/solve.hpp"
#include "model/fields.hpp"

namespace leapmap {

/// Both from any thread.
struct BlockEnds {
  /// Fills in designs first, first + 1, ...
  std::function<void(std::size_t first, std::span<Design>)> fill;
  /// Takes their outcomes.
  std::function<void(std::size_t first, std::span<const Outcome>)> take;
};

/// Solves so many designs. fields: those that will be looked at; what only others need is not computed.
/// Throws as solve does.
void solve_blocks(std::size_t designs, const Scene& scene, const SolveOptions& options,
                  const std::vector<const Field*>& fields, const BlockEnds& ends);

}  // namespace leapmap
