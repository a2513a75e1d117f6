// SPDX-License-Identifier: GPL-3.0-or-later
/// Each dataset of a map, declared once: name, type, unit, meaning, and where its value comes from.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <string_view>
#include <variant>

#include "leapmap/outcome.hpp"

namespace leapmap {

inline constexpr std::string_view map_filetype = "leapmap map";
inline constexpr std::string_view trace_filetype = "leapmap trace";
inline constexpr int format_major = 1;  ///< readers refuse a newer one
/// 1: f4; 2: compression, status_counts, the NeXus group; 3: Coulomb friction's fields; 4: a checksum of each
/// chunk and of the file, the audit's state; 5: the referee.
inline constexpr int format_minor = 5;

/// What an error of a quantity is: that of a height is absolute, of a time relative, of any other relative to
/// one more than its size. Times are stored in seconds: multiplied by time_unit(scene).
enum class Measure { height, time, other };

/// A measured quantity, stored as f8, NaN where it does not apply.
struct Quantity {
  double Outcome::*member;
  Measure measure = Measure::other;

  /// What its values are multiplied by to be stored.
  double unit(double time_unit) const { return measure == Measure::time ? time_unit : 1.0; }
};

/// Designs by how they ended.
using StatusCounts = std::array<std::int64_t, status_count>;
inline std::size_t designs_in(const StatusCounts& counts) {
  return static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
}

/// A small code, stored as u1.
struct Code {
  std::uint8_t (*value)(const Outcome&);
  void (*put)(Outcome&, std::uint8_t);      ///< the inverse
  std::uint8_t fill;                        ///< what a design not computed shows
  std::span<const std::string_view> names;  ///< flag_meanings of 0, 1, 2, ...; empty: a count
};

/// A word of bits, stored as u8 of HDF5's (64 bits).
struct Word {
  std::uint64_t Outcome::*member;
};

struct Field {
  std::string_view name;
  std::variant<Quantity, Code, Word> source;
  std::string_view unit;  ///< as UDUNITS reads it; "1": a pure number
  std::string_view long_name;
  bool of_coulomb = false;  ///< says nothing where the contact never slips
};

/// Every field of a map, in the order of the file.
std::span<const Field> map_fields();

/// The field of that name, or nullptr.
const Field* find_field(std::string_view name);

}  // namespace leapmap
