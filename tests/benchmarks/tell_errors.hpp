// SPDX-License-Identifier: GPL-3.0-or-later
/// What benchmarks of methods say of their answers, beside their speed.
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <span>

#include "leapmap/outcome.hpp"

namespace leapmap {

/// Largest errors where flags are right, how many are wrong, and designs a second; of the first truths.
inline void tell_errors(benchmark::State& state, std::span<const Outcome> outcomes,
                        std::span<const Outcome> truths) {
  double height = 0.0, time = 0.0;
  int wrong = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Outcome &a = outcomes[i], &b = truths[i];
    if (!same_flags(a, b)) {
      ++wrong;
    } else if (a.status == Status::jumped) {
      height = std::max(height, std::abs(a.jump_height - b.jump_height));
      time = std::max(time, std::abs(a.jump_time / b.jump_time - 1.0));
    }
  }
  state.counters["height_error"] = height;
  state.counters["time_error"] = time;
  state.counters["wrong"] = wrong;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(outcomes.size()));
}

/// 10 to the power -arg.
inline double tolerance(const benchmark::State& state) {
  return std::pow(10.0, -static_cast<double>(state.range(0)));
}

}  // namespace leapmap
