// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/sobol_indices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace leapmap {
namespace {

/// Sums over pairs, from which their correlation follows.
struct PairSums {
  double count = 0.0, sum = 0.0, squares = 0.0, fourths = 0.0,
         products = 0.0;  // products of pairs, all else of both

  void add(double a, double b) {
    count += 1.0, sum += a + b, squares += a * a + b * b, products += a * b;
    fourths += a * a * a * a + b * b * b * b;
  }
  void add(const PairSums& other, double times) {
    count += times * other.count, sum += times * other.sum, squares += times * other.squares;
    fourths += times * other.fourths, products += times * other.products;
  }
  /// 2 E[(a - m)(b - m)] over E[(a - m)^2 + (b - m)^2], m the mean of both.
  double correlation() const {
    const double mean = sum / (2.0 * count), variance = squares / (2.0 * count) - mean * mean;
    return count > 0.0 && variance > 1e-14 * squares / count ? (products / count - mean * mean) / variance
                                                             : std::numeric_limits<double>::quiet_NaN();
  }
  /// How many values bring the variance: few where a few are far from all others, beyond a discontinuity,
  /// say.
  double carrying() const { return squares * squares / fourths; }
  /// To what the correlation is known at best: one part in so many.
  double resolution() const { return 2.0 / carrying(); }
};

struct Correlation {
  Estimate estimate;
  double pairs;
};

Correlation correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t each = a.size() / SobolPoints::replicates;
  // Sums about the mean lose no digits.
  double middle = 0.0;
  std::size_t told = 0;
  for (const double value : a)
    if (value == value) middle += value, ++told;
  if (told > 0) middle /= static_cast<double>(told);
  PairSums whole;
  std::array<PairSums, SobolPoints::replicates> parts;
  for (std::size_t r = 0; r < SobolPoints::replicates; ++r) {
    for (std::size_t i = r * each; i < (r + 1) * each; ++i)
      if (a[i] == a[i] && b[i] == b[i]) parts[r].add(a[i] - middle, b[i] - middle);
    whole.add(parts[r], 1.0);
  }
  std::array<double, SobolPoints::replicates> without;
  std::ranges::transform(parts, without.begin(), [&](const PairSums& part) {
    PairSums others = whole;
    others.add(part, -1.0);
    return others.correlation();
  });
  const double value = whole.correlation();
  const bool is_known = value == value && carries_replicates(0.5 * whole.carrying(), whole.count);
  const double error = std::hypot(jackknife_error(without), whole.resolution());
  return {{value, is_known ? error : std::numeric_limits<double>::quiet_NaN()},
          whole.count / static_cast<double>(a.size())};
}

}  // namespace

std::vector<std::vector<std::size_t>> pick_and_freeze(std::size_t inputs) {
  std::vector<std::size_t> a(inputs), b(inputs);
  std::iota(a.begin(), a.end(), std::size_t{0});
  std::iota(b.begin(), b.end(), inputs);
  std::vector<std::vector<std::size_t>> samples{a, b};
  for (std::size_t i = 0; i < inputs; ++i) {
    samples.push_back(a);
    samples.back()[i] = b[i];
  }
  return samples;
}

std::vector<SobolIndex> sobol_indices(std::span<const std::vector<double>> outputs) {
  std::vector<SobolIndex> indices;
  for (std::size_t i = 2; i < outputs.size(); ++i) {
    const Correlation first = correlation(outputs[1], outputs[i]), same = correlation(outputs[0], outputs[i]);
    indices.push_back({first.estimate,
                       {1.0 - same.estimate.value, same.estimate.error},
                       std::min(first.pairs, same.pairs)});
  }
  return indices;
}

}  // namespace leapmap
