// SPDX-License-Identifier: GPL-3.0-or-later
/// What residuals say of a fit: errors of its parameters, and whether the model explains the film.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "design/explained.hpp"
#include "design/least_squares.hpp"
#include "leapmap/fit.hpp"

namespace leapmap {

/// Huber's loss: residuals up to so many standard errors count by their squares, larger ones by their size.
inline constexpr double huber_limit = 1.345;

/// The standard deviation of residuals most of which are normal.
double robust_deviation(std::span<const double> residuals);

/// By Huber's loss: what the square of each residual counts, 1 at most.
std::vector<double> huber_weights(std::span<const double> residuals);
/// The problem with the square of each residual multiplied by a weight.
LeastSquares weighed(const LeastSquares& problem, std::span<const double> weights);

/// How much of the residuals counts, and what that makes of the errors of parameters.
struct Spreading {
  double sum = 0.0;          ///< of squares that count
  double variance = 1.0;     ///< of a residual over its error
  double uncertainty = 1.0;  ///< what errors of parameters follow from
};

/// With Huber's loss the variance is that of its influence function: of residuals cut at the limit, over the
/// square of the fraction that is not cut.
Spreading spreading_of(std::span<const double> residuals, std::size_t degrees, bool errors_known, Loss loss);

/// What a film's residuals say of the fit: how many of its lines are independent, and whether the residuals
/// are larger than its noise.
void judge_film(const Explained& explained, std::span<const double> residuals, Loss loss,
                Spreading& spreading, ModelFit& told);

/// Standard errors, correlations, and which parameters the data do not determine.
void tell_uncertainty(const LeastSquares& problem, const LeastSquaresFit& best, double variance,
                      const FitOptions& options, ModelFit& told);

}  // namespace leapmap
