// SPDX-License-Identifier: GPL-3.0-or-later
/// Places about one, judged together.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "design/improve.hpp"

namespace leapmap {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

inline Vector between(const Place& from, const Place& to) {
  Vector step(static_cast<Eigen::Index>(from.at.size()));
  for (std::size_t k = 0; k < from.at.size(); ++k) step[static_cast<Eigen::Index>(k)] = to.at[k] - from.at[k];
  return step;
}

class Cloud {
 public:
  Cloud(Judge& judge, std::size_t count)
      : judge_(judge), dimensions_(judge.dimensions()), places_(count * dimensions_), verdicts_(count) {}

  std::size_t size() const { return verdicts_.size(); }
  /// Inside the box.
  void put(std::size_t i, const std::vector<double>& centre, const Vector& step) {
    for (std::size_t k = 0; k < dimensions_; ++k)
      places_[i * dimensions_ + k] = std::clamp(centre[k] + step[static_cast<Eigen::Index>(k)], 0.0, 1.0);
  }
  void judge() { judge_.judge(places_, verdicts_); }
  const Verdict& verdict(std::size_t i) const { return verdicts_[i]; }
  Place place(std::size_t i) const { return place_of(places_, verdicts_, i); }
  /// Best first, the earlier one of equals.
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> order(size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(
        order, [&](std::size_t a, std::size_t b) { return better(verdicts_[a], verdicts_[b]); });
    return order;
  }

 private:
  Judge& judge_;
  std::size_t dimensions_;
  std::vector<double> places_;
  std::vector<Verdict> verdicts_;
};

}  // namespace leapmap
