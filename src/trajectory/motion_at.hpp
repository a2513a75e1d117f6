// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion at given times, with its derivatives by the parameters: what a film is compared with.
#pragma once

#include <array>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include "trajectory/gradient.hpp"

namespace leapmap {

/// S: double, or Dual<double, N> for derivatives by up to N parameters.
template <class S>
struct MotionAt {
  S phi;                             ///< [rad]
  S x, y;                            ///< travel of the centre, height of the lowest point above the plane [R]
  S spin;                            ///< [sqrt(g/R)]
  double x_rate, y_rate, spin_rate;  ///< of these over time, in sqrt(R/g)
};

/// Derivatives by up to so many parameters take a third of the time that those by all of them take.
using FewDual = Dual<double, 4>;
/// A number that is the parameter of that place, with its derivative if it is among those.
template <class S>
S seeded(double value, std::size_t place, std::span<const std::size_t> by) {
  if constexpr (has_derivatives<S>)
    for (std::size_t k = 0; k < by.size(); ++k)
      if (by[k] == place) return S::parameter(value, k);
  return S(value);
}
/// The places of all parameters.
inline constexpr auto by_every_parameter = [] {
  std::array<std::size_t, differentiable.size()> places{};
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}();

/// The motion at times since release [s], in ascending order; empty if the design cannot be solved. After the
/// landing of the last jump, or the search's end, the last phase continues: a flight through the plane; a
/// slide, where it cannot be solved any further, to first order.
///
/// by: the places among `differentiable` of the parameters that derivatives are by, in their order in S.
template <class S>
using MotionAtTimes = std::vector<MotionAt<S>> (*)(const Design& design, const Scene& scene,
                                                   std::span<const double> times, double accuracy,
                                                   std::span<const std::size_t> by);
/// The same without derivatives, with some, and with all.
struct MotionsAtTimes {
  MotionAtTimes<double> plain;
  MotionAtTimes<FewDual> by_few;
  MotionAtTimes<DesignDual> by_all;

  explicit operator bool() const { return plain != nullptr; }
  template <class S>
  MotionAtTimes<S> in() const {
    if constexpr (std::is_same_v<S, double>)
      return plain;
    else if constexpr (std::is_same_v<S, FewDual>)
      return by_few;
    else
      return by_all;
  }
};

}  // namespace leapmap
