// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "boundaries/cliff.hpp"
#include "leapmap/boundaries.hpp"
#include "leapmap/errors.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "spec/spacing.hpp"

namespace leapmap {
namespace {

using Vector = std::vector<double>;

Vector unit(Vector direction) {
  double square = 0.0;
  for (const double part : direction) square += part * part;
  if (square > 0.0)
    for (double& part : direction) part /= std::sqrt(square);
  return direction;
}

/// The box of a spec's axes, in coordinates from 0 to 1 along each, of logarithms where values are spaced so.
class Box {
 public:
  Box(const Spec& spec, const Vector& place) : designs_(spec, spec.axes), place_(place) {
    for (std::size_t k = 0; k < place.size(); ++k) {
      const Axis& axis = spec.axes[k];
      const auto [low, high] = std::ranges::minmax(axis.values);
      const auto spacing = spacing_of(axis.values);
      const bool log = spacing && spacing->log && low > 0.0;
      sides_.push_back({low, high, log});
      if (!(place[k] >= low && place[k] <= high))
        throw InputError(
            fmt::format("{} = {} is outside the map; allowed: from {} to {}", axis.key, place[k], low, high));
      centre_.push_back(high > low ? sides_.back().coordinate(place[k]) : 0.0);
    }
  }

  std::size_t dimensions() const { return sides_.size(); }
  bool is_flat(std::size_t k) const { return sides_[k].is_flat(); }

  /// The place so far from the centre in a direction, and its design.
  Vector place(const Vector& direction, double distance) const {
    Vector place = place_;
    for (std::size_t k = 0; k < sides_.size(); ++k)
      if (direction[k] != 0.0) place[k] = sides_[k].value(centre_[k] + distance * direction[k]);
    return place;
  }
  Design at(const Vector& direction, double distance) const {
    return designs_.at(place(direction, distance));
  }
  /// How far the box reaches in a direction.
  double reach(const Vector& direction) const {
    double most = HUGE_VAL;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      if (direction[k] == 0.0) continue;
      const double wall = direction[k] > 0.0 ? 1.0 : 0.0;
      most = std::min(most, std::max((wall - centre_[k]) / direction[k], 0.0));
    }
    return most;
  }
  /// From the centre to a place, of length one.
  Vector direction_to(const Vector& place) const {
    Vector direction;
    for (std::size_t k = 0; k < sides_.size(); ++k)
      direction.push_back(is_flat(k) ? 0.0 : sides_[k].coordinate(place[k]) - centre_[k]);
    return unit(direction);
  }

 private:
  VariedDesigns designs_;
  Vector place_;
  std::vector<Side> sides_;
  Vector centre_;
};

/// The first cliff along each of some directions, within `most`; none where there is none.
class Looking {
 public:
  Looking(const Spec& spec, const Box& box, const Design& design)
      : scene_(spec.scene), box_(box), solve_(make_solver(request_of(spec, {find_field("status")}))) {
    solve_({&design, 1}, {&here_, 1});
  }

  std::vector<NearCliff> along(const std::vector<Vector>& directions, double most, int steps) const {
    std::vector<Design> designs;
    std::vector<double> reaches;
    for (const Vector& direction : directions) {
      reaches.push_back(std::min(box_.reach(direction), most));
      for (int k = 1; k <= steps; ++k)
        designs.push_back(box_.at(direction, station(reaches.back(), k, steps)));
    }
    std::vector<Outcome> outcomes(designs.size());
    solve_(designs, outcomes);
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      Probe before{0.0, here_};
      for (int k = 1; k <= steps; ++k) {
        const Probe there{station(reaches[i], k, steps),
                          outcomes[i * static_cast<std::size_t>(steps) + static_cast<std::size_t>(k) - 1]};
        if (!(discrete(there.outcome, false) == discrete(here_, false))) {
          stretches.push_back({i, before, there, 0.0});
          break;
        }
        before = there;
      }
    }
    std::vector<NearCliff> found(directions.size(), NearCliff{{}, HUGE_VAL, CliffKind::unresolved, {}});
    const auto design_at = [&](std::size_t line, double at) { return box_.at(directions[line], at); };
    bisect(
        solve_, false, stretches, design_at,
        [&](const Stretch& cliff) {
          NearCliff& nearest = found[cliff.line];
          if (!(cliff.below.at < nearest.distance)) return;
          const Design below = design_at(cliff.line, cliff.below.at),
                       above = design_at(cliff.line, cliff.above.at);
          nearest = {box_.place(directions[cliff.line], cliff.below.at), cliff.below.at,
                     kind_of(scene_, below, cliff.below, above, cliff.above),
                     discrete(cliff.above.outcome, false)};
        },
        [] {});
    std::erase_if(found, [](const NearCliff& cliff) { return cliff.at.empty(); });
    std::ranges::stable_sort(found, {}, &NearCliff::distance);
    return found;
  }

 private:
  static double station(double reach, int k, int steps) { return reach * k / steps; }

  const Scene& scene_;
  const Box& box_;
  Solver solve_;
  Outcome here_;
};

/// Directions at random, by a seed that is always the same: all around, or about one of them.
std::vector<Vector> directions_about(const Vector& axis, double spread, std::size_t count, const Box& box,
                                     std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Vector> directions;
  while (directions.size() < count) {
    Vector direction = axis;
    for (std::size_t k = 0; k < direction.size(); ++k)
      direction[k] = box.is_flat(k) ? 0.0 : direction[k] + spread * normal(random);
    directions.push_back(unit(direction));
  }
  return directions;
}

}  // namespace

NearCliffs near_cliffs(const Spec& original, const Design& design) {
  Spec spec = original;
  if (spec.hoop)
    throw InputError(origin_of(spec) +
                     ": has [hoop], which a design does not hold; allowed: values along the axes");
  spec.design = design;
  std::vector<double> place;
  for (const Axis& axis : spec.axes)
    if (const auto variable = find_variable(axis.key, nullptr)) place.push_back(variable->of(design, {}));
  return near_cliffs(spec, place);
}

NearCliffs near_cliffs(const Spec& original, const std::vector<double>& place) {
  Spec spec = original;
  spec.output = {};  // whatever a map of them stores, even fields that this version refuses
  check_spec(spec);
  if (spec.axes.empty())
    throw InputError(origin_of(spec) + ": has no axes; allowed: axes, whose ranges are searched");
  if (place.size() != spec.axes.size())
    throw InputError(fmt::format("{}: {} values for {} axes; allowed: one for each", origin_of(spec),
                                 place.size(), spec.axes.size()));
  const Box box(spec, place);
  const Looking looking(spec, box, VariedDesigns(spec, spec.axes).at(place));
  NearCliffs cliffs;
  const Vector nowhere(box.dimensions(), 0.0);
  bool flat = true;
  for (std::size_t k = 0; k < box.dimensions(); ++k) {
    std::vector<Vector> both;
    for (const double way : {-1.0, 1.0}) {
      both.push_back(nowhere);
      both.back()[k] = way;
    }
    flat = flat && box.is_flat(k);
    constexpr int steps = 1000;
    cliffs.along.push_back(box.is_flat(k) ? std::vector<NearCliff>{} : looking.along(both, HUGE_VAL, steps));
    for (const NearCliff& cliff : cliffs.along.back())
      if (cliffs.nearest.empty() || cliff.distance < cliffs.nearest[0].distance) cliffs.nearest = {cliff};
  }
  if (flat || box.dimensions() < 2) return cliffs;
  // All around first, then ever closer about the nearest so far.
  std::mt19937_64 random(1);
  Vector best = cliffs.nearest.empty() ? nowhere : box.direction_to(cliffs.nearest[0].at);
  for (double spread = 1.0; spread > 1e-9; spread *= 0.4) {
    const double most = cliffs.nearest.empty() ? HUGE_VAL : cliffs.nearest[0].distance;
    if (most == 0.0) break;  // it lies on it
    const auto directions = directions_about(spread == 1.0 ? nowhere : best, spread, 128, box, random);
    const auto found = looking.along(directions, most, spread == 1.0 ? 64 : 16);
    if (found.empty() || !(found[0].distance < most)) continue;
    cliffs.nearest = {found[0]};
    best = box.direction_to(found[0].at);
  }
  return cliffs;
}

}  // namespace leapmap
