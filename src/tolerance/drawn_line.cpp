// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/drawn_line.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <optional>

namespace leapmap {
namespace {

/// A design is nothing but its numbers.
using Numbers = std::array<double, sizeof(Design) / sizeof(double)>;
static_assert(sizeof(Numbers) == sizeof(Design));
Numbers numbers_of(const Design& design) {
  Numbers numbers;
  std::memcpy(&numbers, &design, sizeof numbers);
  return numbers;
}

/// The place of the only number in which two drawings differ; unset: none, or several.
std::optional<std::size_t> difference(const Numbers& a, const Numbers& b) {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) continue;
    if (only) return {};
    only = i;
  }
  return only;
}

}  // namespace

DrawnLine line_of(std::span<const Design> drawings) {
  DrawnLine line;
  double way = 0.0;
  Numbers last = numbers_of(drawings[0]);
  for (; line.count < drawings.size(); ++line.count) {
    const Numbers next = numbers_of(drawings[line.count]);
    const auto differs = difference(last, next);
    if (!differs || (!line.along.empty() && *differs != line.place)) break;
    const double step = next[*differs] - last[*differs];
    if (!(step * way >= 0.0) || !std::isfinite(step)) break;
    if (line.along.empty()) line.along.push_back(last[*differs]);
    line.along.push_back(next[*differs]);
    line.place = *differs, way = step, last = next;
  }
  return line;
}

}  // namespace leapmap
