// SPDX-License-Identifier: GPL-3.0-or-later
/// The time that rolling takes, t = integral of sqrt(J / E) dphi, by Gauss-Legendre quadrature.
///
/// From the release to the first multiple of pi is a stretch in q, phi = phi0 + x1 + q^2, which takes out the
/// nearer zero x1 of E = released + 2 push x + bend x^2 + ...; with no stretching where E falls from the
/// release on, as after many landings. From there half-turns are panels whose nodes
/// all designs share; what is left is the rest, a design's own.
///
/// A rule of n nodes converges like r^(-2 n), r the sum of the half-axes of the largest ellipse about its
/// panel in which the integrand is smooth. So n is chosen from where sqrt(J / E) is not:
///   J = 0 at 2 pi k +- i d, cosh d = 1 + J_min / (2 rho), and
///   Re E > 0 within y of the real axis where cosh y = 1 + E_min / (2 rho): E(phi + i y) has the real part
///   E(phi) + 2 rho cos(theta + phi) (cosh y - 1).
/// What would need too many nodes (a needle of the spin at phi = 0, a release a hair past the unstable
/// equilibrium, a near stall) is left to adaptive halving, a design at a time.
#pragma once

#include <numbers>
#include <vector>

#include "hoop/rolling_by_angle.hpp"
#include "numerics/quadrature.hpp"

namespace leapmap {

/// E's first minimum after the release, or where it rises least if it has none; `vis_viva` is at most E there
/// and from the first panel on. Not above zero: the way is to be timed by halving.
template <class T>
struct Quiet {
  T vis_viva;
  T distance;  ///< from the release [rad]
};

/// How many nodes a design's panels need, and the distances d and y that tell. A rest needs no more.
template <class T>
struct NodesNeeded {
  T panel, needle, strip;
};

template <class T>
class RollingTime {
 public:
  using S = ScalarOf<T>;
  static constexpr int most_nodes = sizeof(S) > 8 ? 96 : 56;

  /// Times will be good to the tolerance, relative, or to some roundings.
  explicit RollingTime(double tolerance);

  /// The first multiple of pi that is far enough from the release to be a panel's edge.
  static T first_panel(const Roll<T>& roll) {
    using std::floor;
    return floor((roll.release + T(0.8)) / T(std::numbers::pi_v<S>)) + T(1);
  }

  /// The nodes needed from the first panel on. Lanes that would need too many are put into
  /// `hard`; their time, here and in stretch, means nothing.
  NodesNeeded<T> needed(const Roll<T>& roll, const Quiet<T>& quiet, MaskOf<T>& hard) const;

  /// The time from release over an angle `span`, at most to first_panel's edge.
  T stretch(const Roll<T>& roll, const Quiet<T>& quiet, const NodesNeeded<T>& needed, const T& span,
            MaskOf<T>& hard);

  /// The time that half-turn `panel` takes, from panel pi on, by so many nodes.
  T panel(const Roll<T>& roll, long panel, int nodes);

  /// The time from `panel` pi for less than a half-turn.
  T rest(const Roll<T>& roll, const NodesNeeded<T>& needed, const T& panel, const T& length) const;

  /// The time from release to an angle by halving intervals until they agree (halved_time.hpp): for any
  /// design. NaN where it cannot be told: so near a stall that E is lost in its roundings.
  S halving(const Roll<S>& roll, const S& to) const { return halving_past(roll, to - roll.release); }
  /// The same over an angle past the release.
  S halving_past(const Roll<S>& roll, const S& past) const;
  /// The same to where the hoop comes to rest, both halves from their ends.
  S halving_to_rest(const Roll<S>& roll, const S& past) const {
    const Roll<S> back = begin_roll(seen(roll.hoop, S(-1)), S(-(roll.release + past)), S(0));
    return halving_past(roll, past * S(0.5)) + halving_past(back, past * S(0.5));
  }

 private:
  /// Nodes that designs share.
  struct SharedNode {
    S weight, x, x_less_sin;
    Trig<S> trig;  // of x
  };
  struct Start {  // from rest, for designs that have as far to go
    S span;
    std::vector<SharedNode> nodes;
  };

  T stretched(const Roll<T>& roll, const Quiet<T>& quiet, const NodesNeeded<T>& needed, const T& span,
              MaskOf<T>& hard);
  T between(const Roll<T>& roll, const NodesNeeded<T>& needed, const T& even, const T& from, const T& length,
            MaskOf<T>& hard) const;
  T nodes_for_length(const NodesNeeded<T>& needed, const T& length, MaskOf<T>& hard) const;
  T nodes_for(const T& square_growth, MaskOf<T>& hard) const;
  const std::vector<SharedNode>& start_from_rest(const S& span, int nodes);

  S tolerance_, digits_;                         // digits: log(1 / tolerance)
  std::vector<std::vector<Start>> starts_;       // by number of nodes, the spans met so far
  std::vector<std::vector<SharedNode>> panels_;  // by number of nodes and evenness; filled when first used
};

}  // namespace leapmap
