// SPDX-License-Identifier: GPL-3.0-or-later
/// The time that rolling takes, t = integral of sqrt(J / E) dphi, by Gauss-Legendre quadrature.
///
/// Half-turns between multiples of pi are panels whose nodes all designs share; before the first and after the last
/// there is a stretch of a design's own. A rule of n nodes on a panel converges like r^(-2 n), where r is the sum of
/// the half-axes of the largest ellipse about the panel in which the integrand is smooth: so n is chosen from
/// where sqrt(J / E) is not,
///   J = 0 at 2 pi k +- i d, cosh d = 1 + J_min / (2 rho), and
///   Re E > 0 within y of the real axis where cosh y = 1 + E_min / (2 rho): E(phi + i y) has the real part
///   E(phi) + 2 rho cos(theta + phi) (cosh y - 1).
/// Near the release E = released + 2 push x + bend x^2 + ...; x = x1 + q^2 takes out the nearer of its zeros, x1.
/// What would need too many nodes (a needle of the spin at phi = 0, a release a hair past the unstable equilibrium, a
/// near stall) is left to adaptive halving, a design at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "numerics/quadrature.hpp"
#include "physics/rolling_by_angle.hpp"

namespace leapmap {

/// How far a design's time has been integrated: to an angle that is a multiple of pi, `panel` pi.
template <class T>
struct Clock {
  T panel, time;
};

template <class T>
class RollingTime {
 public:
  using S = ScalarOf<T>;

  /// Times will be good to about the tolerance, relative, or a few roundings.
  explicit RollingTime(double tolerance);

  /// The time from release to `angle`. `quiet`: E is at least this from first_panel(roll) pi on. Lanes that would need
  /// too many nodes are put into `hard`, and their time means nothing. `clock` returns a mark to go on from, where the
  /// angle lies beyond the first panel's edge.
  T from_release(const Roll<T>& roll, const T& quiet, const T& angle, Clock<T>& clock, MaskOf<T>& hard) const;

  /// The time from release to an angle beyond the clock's mark, which moves on with it.
  T onward(const Roll<T>& roll, const T& quiet, const T& angle, Clock<T>& clock, MaskOf<T>& hard) const;

  /// The first multiple of pi that is far enough from the release to be a panel's edge.
  static T first_panel(const Roll<T>& roll) {
    using std::floor;
    return floor((roll.release + T(0.8)) / T(std::numbers::pi_v<S>)) + T(1);
  }

  /// The time between two angles, from >= release, by halving intervals until they agree: for any design.
  S halving(const Roll<S>& roll, const S& from, const S& to) const;

 private:
  struct Panels {  // two half-turns, 0 to pi and pi to 2 pi
    GaussRule<S> rule;
    std::vector<S> angle, weight;
    std::vector<Trig<S>> trig;
  };
  static constexpr int most_nodes = sizeof(S) > 8 ? 96 : 56;

  int nodes_for(const T& growth, MaskOf<T>& hard) const;
  T stretch(const Roll<T>& roll, const T& strip, const T& end, MaskOf<T>& hard) const;

  S tolerance_, digits_;  // digits: log(1 / tolerance)
  std::vector<Panels> panels_;  // by number of nodes
};

}  // namespace leapmap
