// SPDX-License-Identifier: GPL-3.0-or-later
/// Residuals whose neighbours are alike, as smoothing and interpolation make them:
/// so many lines are not as many measurements.
#pragma once

#include <cstddef>
#include <span>

namespace leapmap {

struct Correlation {
  double lines =
      1.0;  ///< that count as one: 1 + 2 sum of the autocorrelation up to where it is lost in noise
  double variance = 0.0;  ///< of a residual as an independent one would have it, if errors are not known
  double carrying =
      0.0;  ///< cosine coefficients that bring the residuals, all of white noise: few of another motion
};

/// Residuals line by line, `columns` of each, after a fit of so many parameters. The autocorrelation is
/// summed over the lags before the first one that is not above the noise of so many lines, 2 / sqrt(N); of
/// white noise that is none of them but for one case in fifty. What the fit takes out of slow residuals is
/// given back. Smoothing leaves the slow third of what passes it as it was: the variance is the larger one of
/// all residuals' and of their slow cosine coefficients'.
Correlation correlation_of(std::span<const double> residuals, std::size_t columns, std::size_t parameters);

}  // namespace leapmap
