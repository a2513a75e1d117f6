// SPDX-License-Identifier: GPL-3.0-or-later
/// An axis's values by their bounds: { from, to, count, scale } of a spec.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace leapmap {

struct Spacing {
  double from, to;
  std::size_t count;
  bool log = false;  ///< equal ratios in place of equal steps
};

/// The values, both bounds among them to the last bit; the others of a log axis hang on the machine's exp and
/// log.
std::vector<double> values_of(const Spacing& spacing);

/// A value that is there twice; nothing: each is there once.
std::optional<double> repeated(std::vector<double> values);

/// A side of a box of designs, in coordinates from 0 to 1 along it.
struct Side {
  double low, high;
  bool log = false;  ///< of logarithms

  bool is_flat() const { return !(high > low); }
  double coordinate(double value) const;
  /// Inside the bounds, and the bounds themselves to the last bit.
  double value(double coordinate) const;
};

/// The spacing that on this machine gives these very values, to the last bit; nothing for three values or
/// fewer, which are as soon written out.
std::optional<Spacing> spacing_of(std::span<const double> values);

}  // namespace leapmap
