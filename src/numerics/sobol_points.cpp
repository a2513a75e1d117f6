// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/sobol_points.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>

#include "numerics/sobol_sequence.hpp"

namespace leapmap {
namespace {

constexpr double student = 2.1314 / 1.9600;  // of 95 %, with 15 degrees of freedom

}  // namespace

SobolPoints::SobolPoints(std::size_t dimensions, std::size_t samples, std::uint64_t seed)
    : samples_(samples), columns_(dimensions, std::vector<double>(samples)) {
  assert(dimensions <= most_sobol_dimensions && samples % replicates == 0);
  if (dimensions == 0) return;
  constexpr int bits = 52;  // so that half a step more is a double, too
  std::mt19937_64 random(seed);
  std::vector<std::array<std::uint64_t, replicates>> shifts(dimensions);
  for (auto& of_dimension : shifts)
    for (std::uint64_t& shift : of_dimension) shift = random() >> (64 - bits);
  const std::vector<double> points = sobol_sequence(dimensions, a_replicate());
  for (std::size_t i = 0; i < a_replicate(); ++i)
    for (std::size_t d = 0; d < dimensions; ++d) {
      const auto digits = static_cast<std::uint64_t>(std::ldexp(points[i * dimensions + d], bits));
      for (std::size_t r = 0; r < replicates; ++r)
        columns_[d][r * a_replicate() + i] =
            std::ldexp(static_cast<double>(digits ^ shifts[d][r]) + 0.5, -bits);
    }
}

double error_of(double whole, std::span<const double> replicates, std::span<const std::size_t> counts) {
  assert(counts.size() == SobolPoints::replicates && replicates.size() == counts.size());
  double sum = 0.0, squares = 0.0;
  std::size_t told = 0;
  for (const std::size_t count : counts) sum += static_cast<double>(count), told += count > 0;
  if (2 * told < counts.size()) return std::numeric_limits<double>::quiet_NaN();
  const double number = static_cast<double>(counts.size()), mean = sum / number;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    if (counts[r] == 0) continue;
    const double part = static_cast<double>(counts[r]) / mean * (replicates[r] - whole);
    squares += part * part;
  }
  return student * std::sqrt(squares / (number * (number - 1.0)));
}

double jackknife_error(std::span<const double> without) {
  assert(without.size() == SobolPoints::replicates);
  const double number = static_cast<double>(without.size());
  double mean = 0.0, squares = 0.0;
  for (const double value : without) mean += value / number;
  for (const double value : without) squares += (value - mean) * (value - mean);
  return student * std::sqrt(squares * (number - 1.0) / number);
}

bool carries_replicates(double carrying, double values) {
  constexpr double share = 0.1;  // of a normal law a third carries a variance, of a uniform one half
  return carrying >= static_cast<double>(SobolPoints::replicates) || carrying >= share * values;
}

}  // namespace leapmap
