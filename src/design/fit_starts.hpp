// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a fit begins, and what the starts come to.
#pragma once

#include <cstddef>
#include <vector>

#include "design/explained.hpp"
#include "design/least_squares.hpp"
#include "leapmap/fit.hpp"

namespace leapmap {

/// The best places of a coarse map of the bounds, and of finer ones about its best, that are not beside one
/// another; best first.
std::vector<std::vector<double>> coarse_starts(const Explained& explained, const FitOptions& options);

/// The best of fits from several starts. Of a film they are followed over a few of its numbers; all of them
/// decide between the best two.
LeastSquaresFit best_fit(const Explained& explained, const LeastSquares& problem,
                         std::vector<std::vector<double>> starts, const FitOptions& options,
                         std::size_t& evaluations);

/// A fit with Huber's loss, from one of least squares: by weights until they stay as they are.
LeastSquaresFit robust_fit(const LeastSquares& problem, LeastSquaresFit best, std::size_t& evaluations);

}  // namespace leapmap
