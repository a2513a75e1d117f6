// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/QR>
#include <cmath>
#include <random>

#include "design/cloud.hpp"
#include "design/improve.hpp"

namespace leapmap {
namespace {

/// Random numbers of one call.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}
  Vector direction(std::size_t dimensions) {
    Vector direction(static_cast<Eigen::Index>(dimensions));
    for (double& part : direction) part = normal_(random_);
    return direction.normalized();
  }
  double share() { return uniform_(random_); }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

/// The way the objective gets better fastest, of length one, from feasible places within that radius; zero if
/// they do not tell.
Vector way_up(Judge& judge, const Place& place, double radius, Chance& chance) {
  const std::size_t dimensions = judge.dimensions();
  Cloud cloud(judge, 16 * dimensions);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.put(i, place.at, radius * chance.direction(dimensions));
  cloud.judge();
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.verdict(i).feasible() && cloud.verdict(i).outcome == place.verdict.outcome) inside.push_back(i);
  const Vector none = Vector::Zero(static_cast<Eigen::Index>(dimensions));
  if (inside.size() < 2 * dimensions) return none;
  Matrix steps(static_cast<Eigen::Index>(inside.size()), static_cast<Eigen::Index>(dimensions));
  Vector gains(steps.rows());
  for (std::size_t row = 0; row < inside.size(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    steps.row(at) = between(place, cloud.place(inside[row])).transpose();
    gains[at] = place.verdict.cost[0] - cloud.verdict(inside[row]).cost[0];
  }
  const Vector slope = steps.completeOrthogonalDecomposition().solve(gains);
  const double steepness = slope.norm();
  return steepness > 0.0 && std::isfinite(steepness) ? Vector(slope / steepness) : none;
}

/// Steps aside and for each the last place of the branch along the way up, all at once; the best of them.
Place best_aside(Judge& judge, const Place& place, const Vector& up, double length, std::size_t count,
                 Chance& chance) {
  constexpr double reach = 10.0;  // along the way up, in lengths of the step aside
  constexpr int halvings = 44;
  std::vector<Vector> aside;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector any = chance.direction(judge.dimensions());
    aside.push_back(length * std::pow(1e-2, chance.share()) * (any - any.dot(up) * up));
  }
  std::vector<double> low(count, -reach * length), high(count, reach * length);
  Cloud ends(judge, 2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    ends.put(2 * i, place.at, aside[i] + low[i] * up);
    ends.put(2 * i + 1, place.at, aside[i] + high[i] * up);
  }
  ends.judge();
  // Beyond a cliff there may be designs as good as those a little below it.
  const auto inside = [&](const Verdict& verdict) {
    return verdict.feasible() && verdict.outcome == place.verdict.outcome;
  };
  Place best = place;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::size_t end : {2 * i, 2 * i + 1})
      if (better(ends.verdict(end), best.verdict)) best = ends.place(end);
    if (inside(ends.verdict(2 * i)) && !inside(ends.verdict(2 * i + 1))) open.push_back(i);
  }
  for (int halving = 0; halving < halvings && !open.empty(); ++halving) {
    Cloud middle(judge, open.size());
    for (std::size_t k = 0; k < open.size(); ++k)
      middle.put(k, place.at, aside[open[k]] + 0.5 * (low[open[k]] + high[open[k]]) * up);
    middle.judge();
    for (std::size_t k = 0; k < open.size(); ++k) {
      const std::size_t i = open[k];
      (inside(middle.verdict(k)) ? low[i] : high[i]) = 0.5 * (low[i] + high[i]);
      if (better(middle.verdict(k), best.verdict)) best = middle.place(k);
    }
  }
  return best;
}

}  // namespace

void follow_boundary(Judge& judge, Place& place, std::uint64_t seed) {
  if (!place.verdict.feasible() || judge.makes_hoops()) return;  // a yield has steps, and no way up
  Chance chance(seed);
  constexpr double longest = 1e-2, shortest = 1e-10;
  constexpr std::size_t a_round = 48, most_rounds = 120;
  double length = longest;
  Vector up;
  for (std::size_t round = 0; round < most_rounds && length > shortest; ++round) {
    if (round % 8 == 0) {
      up = way_up(judge, place, std::clamp(0.1 * length, 1e-9, 1e-6), chance);
      if (up.squaredNorm() == 0.0) return;
    }
    const Place next = best_aside(judge, place, up, length, a_round, chance);
    const double gain = place.verdict.cost[0] - next.verdict.cost[0];
    const double step = distance(place, next);
    if (gain > 0.0) place = next;
    length = gain > 1e-15 * std::abs(place.verdict.cost[0])
                 ? std::min(longest, std::max(2.0 * step, 0.5 * length))
                 : 0.3 * length;
  }
}

}  // namespace leapmap
