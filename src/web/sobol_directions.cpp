// SPDX-License-Identifier: GPL-3.0-or-later
/// Prints the directions of GSL's Sobol' sequence as a header for without_gsl.cpp: the binary digits by which
/// point 2^k, counted from 0, differs from the one before.
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "numerics/sobol_sequence.hpp"

int main() {
  using namespace leapmap;
  constexpr std::size_t bits = 16;
  const std::vector<double> points =
      sobol_sequence(most_sobol_dimensions, (std::size_t{1} << (bits - 1)) + 1);
  const auto digits = [&](std::size_t point, std::size_t dimension) {
    return static_cast<std::uint32_t>(std::ldexp(points[point * most_sobol_dimensions + dimension], 30));
  };
  std::printf("#pragma once\n#include <cstdint>\nnamespace leapmap {\n");
  std::printf("inline constexpr int direction_bits = %zu;\n", bits);
  std::printf("inline constexpr std::uint32_t sobol_directions[%zu][%zu] = {\n", most_sobol_dimensions, bits);
  for (std::size_t d = 0; d < most_sobol_dimensions; ++d) {
    std::printf("  {");
    for (std::size_t k = 0; k < bits; ++k)
      std::printf("%s%u", k > 0 ? ", " : "",
                  digits(std::size_t{1} << k, d) ^ digits((std::size_t{1} << k) - 1, d));
    std::printf("},\n");
  }
  return std::printf("};\n}  // namespace leapmap\n") > 0 && std::fflush(stdout) == 0 ? 0 : 1;
}
