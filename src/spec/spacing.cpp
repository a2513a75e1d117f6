// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spacing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace leapmap {

std::vector<double> values_of(const Spacing& spacing) {
  const auto& [from, to, count, log] = spacing;
  std::vector<double> values(count);
  const auto last = static_cast<double>(count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = count > 1 ? static_cast<double>(i) / last : 0.0;
    values[i] = log ? std::exp(std::log(from) * (1.0 - x) + std::log(to) * x) : from * (1.0 - x) + to * x;
  }
  values.front() = from;
  values.back() = to;
  return values;
}

double Side::coordinate(double value) const {
  return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

double Side::value(double coordinate) const {
  if (coordinate <= 0.0) return low;
  if (coordinate >= 1.0) return high;
  return std::clamp(log ? low * std::pow(high / low, coordinate) : low + coordinate * (high - low), low,
                    high);
}

std::optional<Spacing> spacing_of(std::span<const double> values) {
  if (values.size() <= 3) return {};
  for (const bool log : {false, true}) {
    const Spacing spacing{values.front(), values.back(), values.size(), log};
    if (log && !(spacing.from > 0.0 && spacing.to > 0.0)) continue;
    const auto same_bits = [](double a, double b) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    if (std::ranges::equal(values_of(spacing), values, same_bits)) return spacing;
  }
  return {};
}

std::optional<double> repeated(std::vector<double> values) {
  std::ranges::sort(values);
  const auto twice = std::ranges::adjacent_find(values);
  return twice == values.end() ? std::nullopt : std::optional(*twice);
}

}  // namespace leapmap
