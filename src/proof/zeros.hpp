// SPDX-License-Identifier: GPL-3.0-or-later
/// Zeros of a function of one variable for all designs of a box at once, by bisection and the signs of
/// enclosures: where no zero is found there is none.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "numerics/root.hpp"
#include "proof/ball.hpp"
#include "support/stop.hpp"

namespace leapmap {

/// A piece of the line that may hold zeros. Between two of them the function is not zero for any design.
struct Cluster {
  double from, to;
  int before, after;  ///< signs of the function there, the same for all designs; 0: not known
  int slope;          ///< 1, -1: it rises, or falls, all the way, for all designs; 0: not known

  bool is_root() const { return slope != 0 && before * after < 0; }  ///< one of each design
  bool falls() const { return is_root() && slope < 0; }
};

/// Looks for zeros from left to right, in pieces that are halved until the function, or its slope, has a
/// sign, or they are no longer than `smallest`. RangeOf: (from, to) to a Sample<Ball> of all values and
/// slopes between.
template <class RangeOf>
class ZeroSearch {
 public:
  ZeroSearch(RangeOf range, double from, double to, double step, double smallest)
      : range_(std::move(range)),
        begun_(from),
        end_(to),
        step_((to - from) / std::max(1.0, std::ceil((to - from) / step))),
        smallest_(smallest),
        sign_(range_(from, from).value.sign()) {}

  /// The next piece with zeros, or of which that is not known; none: there is no other.
  std::optional<Cluster> next() {
    std::optional<Cluster> open;
    while (!todo_.empty() || begun_ < end_) {
      throw_if_stopped();
      if (todo_.empty()) begin_piece();
      const auto [from, to] = todo_.back();
      todo_.pop_back();
      const Sample<Ball> all = range_(from, to);
      if (const int sign = all.value.sign(); sign != 0) {
        sign_ = sign;
        if (open && closed(*open)) return open;
        open.reset();
        continue;
      }
      const int slope = all.rate.sign();
      const double middle = from + 0.5 * (to - from);
      if (slope == 0 && to - from > smallest_ && from < middle && middle < to) {
        todo_.emplace_back(middle, to), todo_.emplace_back(from, middle);
        continue;
      }
      if (!open) open = Cluster{from, to, sign_, 0, slope};
      if (open->slope != slope) open->slope = 0;
      open->to = to;
      sign_ = range_(to, to).value.sign();
      if (sign_ != 0) {
        if (closed(*open)) return open;
        open.reset();
      }
    }
    return open;
  }

 private:
  void begin_piece() {
    const double to = end_ - begun_ < 1.5 * step_ ? end_ : begun_ + step_;
    todo_.emplace_back(begun_, to);
    begun_ = to;
  }
  /// Whether a piece that ends at a known sign may hold zeros.
  bool closed(Cluster& cluster) const {
    cluster.after = sign_;
    return cluster.slope == 0 || cluster.before != cluster.after;
  }

  RangeOf range_;
  double begun_, end_, step_, smallest_;
  std::vector<std::pair<double, double>> todo_;  ///< halves of the piece in hand, the next one last
  int sign_;
};

}  // namespace leapmap
