// SPDX-License-Identifier: GPL-3.0-or-later
/// The numbers that a film holds, one by one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "leapmap/fit.hpp"

namespace leapmap {

enum class Measured { angle, spin, x, y };

struct Observation {
  Measured kind;
  std::size_t track = 0;  ///< of x and y
  double t = 0.0;         ///< [s]
  double value = 0.0;     ///< in the film's unit
};

/// All numbers of a film in the order of their times; at one time as the film has them.
std::vector<Observation> observations_of(const Film& film);

/// "phi", "spin", or "x_weight" of the track "weight".
std::string name_of(const Observation& observation, const Film& film);

inline bool is_position(Measured kind) { return kind == Measured::x || kind == Measured::y; }
/// Whether two numbers have the same unit, and so the same error.
inline bool are_alike(Measured a, Measured b) { return a == b || (is_position(a) && is_position(b)); }

/// The noise of numbers alike, from one to the next, by third differences, which a smooth motion hardly has:
/// their median, so that single slips hardly count. NaN of four numbers or fewer.
double scatter_of(std::span<const Observation> observations, Measured kind);

}  // namespace leapmap
