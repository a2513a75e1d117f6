// SPDX-License-Identifier: GPL-3.0-or-later
/// Angle and spin of a roll at times. The time is an integral over panels of the angle, phi = phi0 + x,
/// x = q (2 q0 + q), which takes out the nearer zero of E before the release; the spin follows from E.
#pragma once

#include <vector>

#include "hoop/rolling_by_angle.hpp"
#include "numerics/spectral.hpp"

namespace leapmap {

/// S: double, or a dual.
template <class S>
class RollPanels {
 public:
  /// accuracy: of times, in sqrt(R/g) or relative, whichever is coarser.
  RollPanels(const Roll<S>& roll, double accuracy);

  /// Adds panels up to a time, or to an angle past the release if that comes first. Every call must give the
  /// same angle. False: panels would have to be too many or too short; the motion after them is unknown.
  bool reach(double time, const S& past);
  /// The time from the release to where the panels end.
  const S& time() const { return end_; }

  struct At {
    S past, spin;         ///< angle since the release; both as seen on the roll
    double acceleration;  ///< phi''
  };
  /// At a time since the release, up to which there are panels: by interpolation, and by one step of Newton's
  /// method that gives duals their derivatives.
  At at(const S& time) const;

 private:
  static constexpr std::size_t nodes = 24;
  using Grid = SpectralPanel<S, nodes>;
  using PlainGrid = SpectralPanel<double, nodes>;
  struct Panel {
    double begin;                            ///< q
    S span;                                  ///< of q
    S begun;                                 ///< the time
    double duration;                         ///< without derivatives, as all below
    typename Grid::Values since;             ///< time since then at the nodes
    typename PlainGrid::Values times, rate;  ///< it without derivatives; its derivative by the place
  };

  double rounding(double past, double E) const;
  S angle_at(const S& q) const { return q * (q0_ + q0_ + q); }
  /// How far from resolved a panel is, at most 1 if it is.
  struct Excess {
    double plain, all;  ///< without derivatives, and with them
  };
  /// Solves a panel whose begin and span are known.
  Excess solve(Panel& panel, S& duration) const;

  Roll<S> roll_;
  double accuracy_;
  S q0_;
  double reached_ = 0.0;  // q
  S end_{0.0};
  bool ends_ = false;    // at that angle
  double length_ = 1.0;  // of the next panel's angle [rad]
  std::vector<Panel> panels_{};
};

}  // namespace leapmap
