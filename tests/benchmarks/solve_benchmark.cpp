// SPDX-License-Identifier: GPL-3.0-or-later
/// Seconds that leapmap::solve takes for a million designs on all cores and for one: for python_benchmark.py.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "leapmap/solve.hpp"

int main() {
  using namespace leapmap;
  constexpr int side = 1000, repeats = 200;
  std::vector<Design> designs;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      designs.push_back(
          {.slope = 0.1 + 0.7 * i / (side - 1), .mass_ratio = 0.5 * std::pow(20.0, j / (side - 1.0))});
  const auto seconds_of = [](const auto& call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  double sum = 0.0;
  const double many = seconds_of([&] { sum += solve(designs).back().jump_height; });
  const double one = seconds_of([&] {
    for (int i = 0; i < repeats; ++i) sum += solve(Design{}).jump_height;
  });
  std::printf("%.6f %.9f %s\n", many, one / repeats, sum > 0.0 ? "" : "no jump");
}
