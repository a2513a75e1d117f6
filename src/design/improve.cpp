// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/improve.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "design/cloud.hpp"

namespace leapmap {
namespace {

/// Steps by chance: a shape that is learnt, and a length that is good.
class RandomSteps {
 public:
  RandomSteps(std::size_t dimensions, const ImproveOptions& options)
      : dimensions_(static_cast<Eigen::Index>(dimensions)),
        random_(options.seed),
        widest_(options.widest),
        length_(options.widest),
        shape_(Matrix::Identity(dimensions_, dimensions_)),
        root_(shape_) {}

  Vector next(std::size_t number) {
    Vector direction(dimensions_);
    for (double& part : direction) part = normal_(random_);
    if (number % 4 != 0) direction = root_ * direction;  // the others go anywhere
    const double size = direction.norm();
    if (!(size > 0.0)) return Vector::Zero(dimensions_);
    // About the good length; one in four of any length at all.
    const double most = number % 4 == 1 ? widest_ : std::min(100.0 * length_, widest_),
                 least = number % 4 == 1 ? shortest : std::max(1e-3 * length_, shortest);
    return direction / size * most * std::pow(least / most, uniform_(random_));
  }
  /// Good steps, the best first.
  void learn(const std::vector<Vector>& good) {
    constexpr double rate = 0.25;
    Matrix sum = Matrix::Zero(dimensions_, dimensions_);
    for (const Vector& step : good) sum += step * step.transpose() / step.squaredNorm();
    shape_ = (1.0 - rate) * shape_ +
             rate * static_cast<double>(dimensions_) / static_cast<double>(good.size()) * sum;
    shape_ *= static_cast<double>(dimensions_) / shape_.trace();
    root_ = (shape_ + 1e-16 * Matrix::Identity(dimensions_, dimensions_)).llt().matrixL();
    length_ = good.front().norm();
  }
  void shorten() { length_ = std::max(0.3 * length_, shortest); }

 private:
  static constexpr double shortest = 1e-15;
  Eigen::Index dimensions_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  double widest_, length_;
  Matrix shape_, root_;
};

/// What a round must gain so as not to count as one that brought nothing.
bool is_gain(const Verdict& before, const Verdict& after) {
  if (!before.feasible()) return after.feasible() || after.violation < before.violation * (1.0 - 1e-12);
  return after.cost[0] < before.cost[0] - 1e-14 * std::abs(before.cost[0]);
}

}  // namespace

void improve(Judge& judge, Place& place, const ImproveOptions& options) {
  RandomSteps steps(judge.dimensions(), options);
  Cloud cloud(judge, options.a_round);
  // A yield is a count: what a few rounds do not better is as good as it can be told.
  const int patience = judge.makes_hoops() ? 4 : 12;
  constexpr std::size_t most_learnt = 8, leaps = 8;
  Vector last = Vector::Zero(static_cast<Eigen::Index>(judge.dimensions()));
  int idle = 0;
  for (std::size_t round = 0; round < options.most_rounds && idle < patience; ++round) {
    for (std::size_t i = 0; i < cloud.size(); ++i)  // the first go on where the last step led
      cloud.put(
          i, place.at,
          i < leaps && round > 0 ? Vector(std::ldexp(1.0, static_cast<int>(i) - 2) * last) : steps.next(i));
    cloud.judge();
    std::vector<Vector> good;
    const std::vector<std::size_t> order = cloud.order();
    for (const std::size_t i : order) {
      if (!better(cloud.verdict(i), place.verdict) || good.size() == most_learnt) break;
      good.push_back(between(place, cloud.place(i)));
      if (good.back().squaredNorm() == 0.0) good.pop_back();
    }
    if (good.empty()) {
      ++idle, steps.shorten();
      continue;
    }
    idle = is_gain(place.verdict, cloud.verdict(order[0])) ? 0 : idle + 1;
    steps.learn(good);
    last = good.front();
    place = cloud.place(order[0]);
  }
}

namespace {

/// Whether a place's neighbours along each axis are feasible and, but for a hair, as good.
std::vector<bool> are_settled(Judge& judge, const std::vector<Place>& places) {
  constexpr double hair = 1e-12;
  const std::size_t dimensions = judge.dimensions(), a_place = 2 * dimensions;
  Cloud cloud(judge, places.size() * a_place);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < a_place; ++k) {
      Vector step = Vector::Zero(static_cast<Eigen::Index>(dimensions));
      step[static_cast<Eigen::Index>(k / 2)] = k % 2 == 0 ? hair : -hair;
      cloud.put(i * a_place + k, places[i].at, step);
    }
  cloud.judge();
  std::vector<bool> settled(places.size(), true);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double cost = places[i / a_place].verdict.cost[0];
    const bool falls =
        !judge.makes_hoops() && cloud.verdict(i).cost[0] > cost + 1e-9 * (1.0 + std::abs(cost));
    if (!cloud.verdict(i).feasible() || falls) settled[i / a_place] = false;
  }
  return settled;
}

}  // namespace

void move_off_boundary(Judge& judge, Place& place, std::uint64_t seed) {
  if (!place.verdict.feasible() || are_settled(judge, {place})[0]) return;
  const std::size_t count = judge.makes_hoops() ? 64 : 2048, tried = count / 16;
  Cloud cloud(judge, count);
  for (double widest = 1e-10; widest < 1e-6; widest *= 10.0) {
    RandomSteps steps(judge.dimensions(), {.seed = seed, .widest = widest});
    for (std::size_t i = 0; i < count; ++i) cloud.put(i, place.at, steps.next(i));
    cloud.judge();
    std::vector<Place> best;
    for (const std::size_t i : cloud.order()) {
      if (!cloud.verdict(i).feasible() || best.size() == tried) break;
      best.push_back(cloud.place(i));
    }
    if (best.empty()) continue;
    const std::vector<bool> settled = are_settled(judge, best);
    const auto first = std::ranges::find(settled, true);
    if (first == settled.end()) continue;
    place = best[static_cast<std::size_t>(first - settled.begin())];
    return;
  }
}

Place place_of(std::span<const double> places, std::span<const Verdict> verdicts, std::size_t i) {
  const std::size_t dimensions = places.size() / verdicts.size();
  const std::span<const double> row = places.subspan(i * dimensions, dimensions);
  return {{row.begin(), row.end()}, verdicts[i]};
}

double distance(const Place& a, const Place& b) { return between(a, b).lpNorm<Eigen::Infinity>(); }

bool are_connected(Judge& judge, const Place& a, const Place& b) {
  constexpr double same = 1e-6, alike = 0.02;
  if (distance(a, b) < (a.verdict.outcome == b.verdict.outcome ? alike : same)) return true;
  Cloud way(judge, judge.makes_hoops() ? 15 : 63);
  for (std::size_t i = 0; i < way.size(); ++i)
    way.put(i, a.at, between(a, b) * static_cast<double>(i + 1) / static_cast<double>(way.size() + 1));
  way.judge();
  const Verdict& worse = better(a.verdict, b.verdict) ? b.verdict : a.verdict;
  for (std::size_t i = 0; i < way.size(); ++i)
    if (better(worse, way.verdict(i))) return false;
  return true;
}

}  // namespace leapmap
