// SPDX-License-Identifier: GPL-3.0-or-later
/// How much of an output's variance each input brings: Sobol' indices by pick and freeze.
///
/// Two independent samples A and B of all inputs, and for each input i one more, A with input i of B. First
/// order: how much what B and that one share, input i, makes them alike. Total: how much A and that one
/// differ, as they share all but input i. Both by the correlation of pairs about their common mean (Janon,
/// Klein, Lagnoux, Nodet and Prieur, "Asymptotic normality and efficiency of two Sobol index estimators",
/// ESAIM: Probability and Statistics 18 (2014) 342-364), which takes pairs of which both are there: of
/// outputs that not every input has, the indices are of the variance among those that have it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "numerics/sobol_points.hpp"

namespace leapmap {

/// Of one input. NaN: nothing varies, or too little is there.
struct SobolIndex {
  Estimate first, total;
  double pairs;  ///< the least share of pairs that could be compared
};

/// The samples of n inputs, by the dimensions of points (2 n of them) that each input takes: A, B, and A with
/// one input of B after the other.
std::vector<std::vector<std::size_t>> pick_and_freeze(std::size_t inputs);

/// outputs: of these samples in their order, each of all points; NaN where there is no output.
std::vector<SobolIndex> sobol_indices(std::span<const std::vector<double>> outputs);

}  // namespace leapmap
