// SPDX-License-Identifier: GPL-3.0-or-later
/// Points that fill a cube evenly: Sobol's sequence, moved by a random digital shift in each of 16
/// replicates, so that each replicate is fair for itself and their spread measures the error of their mean.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "leapmap/estimate.hpp"

namespace leapmap {

class SobolPoints {
 public:
  static constexpr std::size_t replicates = 16;

  /// So many samples or a few more: as many in each replicate.
  static constexpr std::size_t whole(std::size_t samples) {
    return (samples + replicates - 1) / replicates * replicates;
  }

  /// dimensions: up to most_sobol_dimensions; samples: a whole number of points for each replicate. The same
  /// seed, the same points.
  SobolPoints(std::size_t dimensions, std::size_t samples, std::uint64_t seed);

  std::size_t dimensions() const { return columns_.size(); }
  std::size_t samples() const { return samples_; }
  std::size_t a_replicate() const { return samples_ / replicates; }
  /// The coordinates along one dimension, inside (0, 1), replicate after replicate.
  std::span<const double> column(std::size_t dimension) const { return columns_[dimension]; }

 private:
  std::size_t samples_;
  std::vector<std::vector<double>> columns_;
};

/// The error of a statistic from its values in the replicates and how much each replicate counts (how many
/// of its samples it is of): the spread of ratios about the whole's value, widened by Student's factor, so
/// that 1.96 errors hold in 95 of 100 cases although there are few replicates. NaN with fewer than half of
/// them.
double error_of(double whole, std::span<const double> replicates, std::span<const std::size_t> counts);

/// The same of any statistic of sums over all samples, from its values without one replicate after the other
/// (the jackknife): for ratios, to which replicates contribute unequally. NaN if one of them is.
double jackknife_error(std::span<const double> without);

/// Whether replicates vary as a moment's error says: not if fewer of so many values than one a replicate
/// bring nearly all of it, as those few beyond a discontinuity may do. Most replicates have none of them
/// then, and their agreement means nothing. Few values in all are no such case.
bool carries_replicates(double carrying, double values);

}  // namespace leapmap
