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
  std::size_t count = 0;
  double sum = 0.0, squares = 0.0, products = 0.0;  // of both; of both; of pairs

  void add(double a, double b) { ++count, sum += a + b, squares += a * a + b * b, products += a * b; }
  /// 2 E[(a - m)(b - m)] over E[(a - m)^2 + (b - m)^2], m the mean of both.
  double correlation() const {
    const double n = static_cast<double>(count), mean = sum / (2.0 * n);
    const double variance = squares / (2.0 * n) - mean * mean;
    return variance > 1e-14 * squares / n ? (products / n - mean * mean) / variance
                                          : std::numeric_limits<double>::quiet_NaN();
  }
};

struct Correlation {
  Estimate estimate;
  double pairs;
};

Correlation correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t each = a.size() / SobolPoints::replicates;
  // Sums about a value between them lose no digits.
  double middle = 0.0;
  std::size_t told = 0;
  for (const double value : a)
    if (value == value) middle += value, ++told;
  if (told > 0) middle /= static_cast<double>(told);
  PairSums whole;
  std::array<double, SobolPoints::replicates> parts{};
  std::array<std::size_t, SobolPoints::replicates> counts{};
  for (std::size_t r = 0; r < SobolPoints::replicates; ++r) {
    PairSums part;
    for (std::size_t i = r * each; i < (r + 1) * each; ++i)
      if (a[i] == a[i] && b[i] == b[i]) part.add(a[i] - middle, b[i] - middle);
    whole.count += part.count, whole.sum += part.sum, whole.squares += part.squares,
        whole.products += part.products;
    parts[r] = part.correlation();
    counts[r] = parts[r] == parts[r] ? part.count : 0;
  }
  const double value = whole.correlation();
  return {{value, value == value ? error_of(value, parts, counts) : value},
          static_cast<double>(whole.count) / static_cast<double>(a.size())};
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
