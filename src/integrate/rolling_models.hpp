// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip as a first-order system, by one coordinate or by three: what an integrator, its
/// events and its Jacobian need.
///
/// A model has a dimension, a hoop, whether it knows its Jacobian and whether steps are projected; the state
/// at an angle and a spin and back; the state's derivative; and what its guards watch. A new hoop is set.
#pragma once

#include <algorithm>
#include <type_traits>

#include "hoop/rolling.hpp"
#include "hoop/three_coordinates.hpp"
#include "numerics/events.hpp"

namespace leapmap {

/// The guards' values and rates in time.
struct Watched {
  Sample<double> normal_force, spin;
};

/// (10) for the angle alone: state (phi, w).
struct OneCoordinate {
  static constexpr std::size_t dimension = 2;
  static constexpr bool has_jacobian = true, projects = false;
  using Y = State<dimension>;
  Hoop<double> hoop;

  void set(const Hoop<double>& to) { hoop = to; }
  static Y rolling(double angle, double spin) { return {angle, spin}; }
  static double angle(const Y& y) { return y[0]; }
  static double spin(const Y& y) { return y[1]; }
  void derivative(const double y[], double f[]) const {
    f[0] = y[1];
    f[1] = angular_acceleration(hoop, trig(y[0]), y[1]);
  }
  void jacobian(const double y[], double dfdy[]) const {
    const Trig<double> phi = trig(y[0]);
    const auto gradient = acceleration_gradient(hoop, phi, y[1], angular_acceleration(hoop, phi, y[1]));
    dfdy[0] = 0.0, dfdy[1] = 1.0;
    dfdy[2] = gradient.by_angle, dfdy[3] = gradient.by_spin;
  }
  Watched watched(const Y& y) const {
    const Trig<double> phi = trig(y[0]);
    const double acceleration = angular_acceleration(hoop, phi, y[1]);
    return {{normal_force(hoop, phi, y[1], acceleration), normal_force_rate(hoop, phi, y[1], acceleration)},
            {y[1], acceleration}};
  }
};

/// (7) to (9) with multipliers: state (x, y, phi, x', y', w) of the hoop's centre or of the centre of mass.
/// For studies, with explicit steppers only.
template <bool at_centre_of_mass, bool projected>
struct Multipliers : ThreeCoordinates {
  static constexpr std::size_t dimension = 6;
  static constexpr bool has_jacobian = false, projects = projected;
  using Y = State<dimension>;
  static_assert(std::is_same_v<Y, ThreeState>);

  void set(const Hoop<double>& to) { hoop = to, reference = at_centre_of_mass ? to.rho : 0.0; }
  static double angle(const Y& y) { return y[2]; }
  static double spin(const Y& y) { return y[5]; }
  void derivative(const double y[], double f[]) const {
    Y state;
    std::copy_n(y, dimension, state.begin());
    const auto acceleration = this->acceleration(state);
    for (std::size_t i = 0; i < 3; ++i) f[i] = y[3 + i], f[3 + i] = acceleration[i];
  }
  Watched watched(const Y& y) const {
    const ConstrainedMotion now = motion(y);
    return {{now.normal_force, now.normal_force_rate}, {y[5], angular_acceleration(hoop, trig(y[2]), y[5])}};
  }
};

}  // namespace leapmap
