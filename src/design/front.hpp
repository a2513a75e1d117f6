// SPDX-License-Identifier: GPL-3.0-or-later
/// Pareto fronts of two objectives: designs than which no other is better in both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "design/improve.hpp"

namespace leapmap {

using Cost = std::array<double, 2>;

class Front {
 public:
  /// Whether a design is feasible and nothing here dominates it, or is as good.
  bool takes(const Verdict& verdict) const;
  /// Keeps those that nothing here or among them dominates. Infeasible ones are left out.
  void add(std::vector<Place> places);
  /// Leaves out what adds least to the volume until there are no more than that; the ends stay.
  void thin(std::size_t most);

  /// In order of the first cost, least first; the second falls along them.
  const std::vector<Place>& places() const { return places_; }
  /// The share of the rectangle between the front's ends that it dominates; NaN of fewer than two places.
  double hypervolume() const;

 private:
  std::vector<Place> places_;
};

/// Fronts of designs by their discrete outcome, each for itself: beyond a cliff there may be a thin band
/// whose first samples are dominated, and whose best designs are not.
class Fronts {
 public:
  /// places: a row of coordinates for each verdict.
  void add(std::span<const double> places, std::span<const Verdict> verdicts);
  void thin(std::size_t most);
  /// Leaves those that are part of the front of all, and those that come nearest to it, so many.
  void leave_nearest(std::size_t most);
  Front of_all() const;
  /// The costs of the front of all, in order of the first.
  std::vector<Cost> costs_of_all() const;
  const std::map<std::uint64_t, Front>& by_outcome() const { return fronts_; }

 private:
  std::map<std::uint64_t, Front> fronts_;
};

/// Rounds of small steps from the fronts' places, along them and off them, so many a round, until they bring
/// nothing more to the few outcomes that are left.
void refine(Judge& judge, Fronts& fronts, std::size_t most, std::size_t a_round, std::uint64_t seed);

}  // namespace leapmap
