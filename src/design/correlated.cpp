// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/correlated.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "design/least_squares.hpp"

namespace leapmap {
namespace {

constexpr std::size_t most_lags = 2000, most_coefficients = 500;

/// Of neighbours so many lines apart, relative to those of none.
double autocorrelation(std::span<const double> residuals, std::size_t columns, std::size_t lag, double sum) {
  double product = 0.0;
  for (std::size_t i = 0; i + lag * columns < residuals.size(); ++i)
    product += residuals[i] * residuals[i + lag * columns];
  return product / sum;
}

/// The squares of the first orthonormal cosine coefficients (DCT-II) of each column.
std::vector<double> slow_squares(std::span<const double> residuals, std::size_t columns,
                                 std::size_t coefficients) {
  const std::size_t lines = residuals.size() / columns;
  std::vector<double> squares;
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t j = 0; j < coefficients; ++j) {
      double coefficient = 0.0;
      for (std::size_t i = 0; i < lines; ++i)
        coefficient += residuals[i * columns + c] *
                       std::cos(std::numbers::pi * static_cast<double>(j) * (static_cast<double>(i) + 0.5) /
                                static_cast<double>(lines));
      squares.push_back(coefficient * coefficient * (j == 0 ? 1.0 : 2.0) / static_cast<double>(lines));
    }
  return squares;
}

}  // namespace

Correlation correlation_of(std::span<const double> residuals, std::size_t columns, std::size_t parameters) {
  const auto numbers = static_cast<double>(residuals.size()), free = static_cast<double>(parameters);
  const std::size_t lines = residuals.size() / columns;
  const double sum = sum_of_squares(residuals);
  Correlation found{.lines = 1.0,
                    .variance = sum / std::max(numbers - free, 1.0),
                    .carrying = numbers / static_cast<double>(columns)};
  if (!(sum > 0.0)) return found;
  const double noise = 2.0 / std::sqrt(numbers) - free / numbers;
  double correlated = 0.0;
  std::size_t lags = 0;
  for (; lags < std::min(lines / 4, most_lags); ++lags) {
    const double at = autocorrelation(residuals, columns, lags + 1, sum);
    if (!(at > noise)) break;
    correlated += at;
  }
  if (lags == 0) return found;
  const double lost = 2.0 * free * (static_cast<double>(lags) - correlated) / numbers;
  found.lines = (1.0 + 2.0 * correlated) / std::max(0.2, 1.0 - lost);
  const auto least = static_cast<std::size_t>(std::ceil((free + 4.0) / static_cast<double>(columns)));
  const auto slow = static_cast<std::size_t>(std::round(static_cast<double>(lines) / (3.0 * found.lines)));
  const std::size_t kept = std::min({std::max(slow, least), lines, most_coefficients});
  const double degrees = static_cast<double>(kept * columns) - free;
  const std::vector<double> squares = slow_squares(residuals, columns, std::min(lines, most_coefficients));
  double slow_sum = 0.0, power = 0.0, power_squared = 0.0;
  for (std::size_t k = 0; k < squares.size(); ++k) {
    if (k % std::min(lines, most_coefficients) < kept) slow_sum += squares[k];
    power += squares[k], power_squared += squares[k] * squares[k];
  }
  if (degrees >= 1.0) found.variance = std::max(found.variance, slow_sum / degrees);
  found.carrying = 3.0 * power * power / (power_squared * static_cast<double>(columns));
  return found;
}

}  // namespace leapmap
