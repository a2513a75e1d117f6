// SPDX-License-Identifier: GPL-3.0-or-later
/// One sliding phase by quadratures in the angle.
///
/// In the angle u = w^2 obeys du/dphi = a u + b with a = 2 rho c turn, b = 2 cos(theta) turn
/// (physics/sliding.hpp), so that u = e^A (u0 + integral of b e^-A), A the integral of a; time, slip and
/// travel are integrals over u's root. All are taken on panels of Gauss-Legendre nodes, short enough that the
/// nodes resolve them to the tolerance. Where the spin goes through zero, and while it is negative, panels
/// are in time: angle and spin at their nodes by Picard's iteration.
#pragma once

#include "numerics/spectral.hpp"
#include "physics/sliding.hpp"
#include "trajectory/contact_phases.hpp"

namespace leapmap {

template <class S>
class SlidingLeg {
 public:
  /// The nodes of a panel resolve what they hold to half the tolerance, relative, or to some roundings.
  explicit SlidingLeg(double tolerance);

  /// Slides on from a state with n0 > 0 (or zero but for rounding), towards `direction` (1 or -1), to the
  /// phase's end.
  PhaseEnd run(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& runway,
               int direction) const;

  /// Slides on for a time, with no look at what would end the phase. False: it could not be solved.
  bool advance(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& duration,
               int direction) const;

 private:
  static constexpr std::size_t nodes = 24;
  using Values = typename SpectralPanel<S, nodes>::Values;

  /// What the nodes of a panel hold, in order of time, and its end.
  struct Panel {
    Values slip, travel, free_force;
    ContactState<S> end;
    S end_force;
    S excess;  ///< the nodes resolve it if at most 1; infinity: it could not be solved
    bool indeterminate, spin_vanishes;
  };
  /// A panel by angle: phi = from + shift + q^2, q from begin to begin + span.
  struct Stretch {
    S shift, begin, span;
  };
  static Stretch stretch_of(const S& spin, const S& rise, const S& length);
  void solve_by_angle(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from,
                      const Stretch& stretch, Panel& panel) const;
  void solve_by_time(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from, const S& duration,
                     Panel& panel) const;
  /// The first place in (0, 1] of the panel where a guard has fallen, and which; above 1: none has.
  S first_event(const S& free_force, const ContactState<S>& at, const S& runway, int direction,
                const Panel& panel, PhaseEnd& end) const;

  S tolerance_;
  SpectralPanel<S, nodes> panel_;
};

}  // namespace leapmap
