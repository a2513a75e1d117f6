// SPDX-License-Identifier: GPL-3.0-or-later
/// How long work takes.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

namespace leapmap {

inline double seconds(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace leapmap
