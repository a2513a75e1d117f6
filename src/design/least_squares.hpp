// SPDX-License-Identifier: GPL-3.0-or-later
/// Nonlinear least squares within bounds, by GSL's trust region.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "spec/spacing.hpp"

namespace leapmap {

struct LeastSquares {
  std::vector<Side> bounds;   ///< of each parameter
  std::size_t residuals = 0;  ///< their number
  /// Fills in the residuals at a place, and their derivatives, a row of each residual; an empty span: they
  /// are not asked for. False: there are none there.
  std::function<bool(std::span<const double> at, std::span<double> residuals, std::span<double> jacobian)>
      evaluate;
};

double sum_of_squares(std::span<const double> residuals);

struct LeastSquaresFit {
  std::vector<double> at;
  std::vector<double> residuals, jacobian;  ///< there; empty: there are none
  double sum = HUGE_VAL;                    ///< of squares
  std::size_t evaluations = 0;
};

/// Goes down from a start. Parameters stay within their bounds: each is followed as the arc sine of its place
/// between them.
/// most_iterations: after so many it stays where it is.
LeastSquaresFit minimize(const LeastSquares& problem, std::span<const double> start,
                         int most_iterations = 200);

}  // namespace leapmap
