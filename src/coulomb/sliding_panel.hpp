// SPDX-License-Identifier: GPL-3.0-or-later
/// A stretch of one sliding phase, solved at the nodes of a panel.
///
/// In the angle u = w^2 obeys du/dphi = a u + b with a = 2 rho c turn, b = 2 n1 turn + 2 tau / Ic,
/// n1 = cos(theta) + rho s tau / Ic (physics/sliding.hpp), so that u = e^A (u0 + integral of b e^-A), A the
/// integral of a; time, slip and travel are integrals over u's root. Near Painleve's edge n0 takes the place
/// of u: it obeys an equation of the same kind, with -tan(phi) + 2 rho c turn and
/// tan(phi) n1 + 3 rho c tau / Ic, and keeps its digits where it vanishes with the pivot. Where the spin goes
/// through zero panels are in time: angle and spin at their nodes by Picard's iteration.
#pragma once

#include <optional>

#include "coulomb/contact_phases.hpp"
#include "numerics/spectral.hpp"
#include "physics/painleve.hpp"

namespace leapmap {

/// S: a number, or a dual, whose derivatives panels of given lengths carry along.
template <class S>
class SlidingPanels {
 public:
  using Number = ScalarOf<S>;
  static constexpr std::size_t nodes = 24;
  using Grid = SpectralPanel<S, nodes>;
  using Values = typename Grid::Values;

  /// A function at the panel's start, nodes and end, and its derivative by the panel's coordinate.
  struct Course {
    Sample<S> start;
    Values value, rate;
    Sample<S> end;
  };
  /// What the nodes of a panel hold, in order of time, and its end.
  struct Panel {
    Course slip, travel, free_force;
    // Of a panel by angle: y = e^growth (start_y + driven) is w^2 or, where it says so, n0.
    Values growth, driven, time_rate;
    S start_y;
    bool by_force;
    ContactState<S> end;
    S turned;       ///< from start to end
    Number excess;  ///< the nodes resolve it if at most 1; infinity: it could not be solved
    bool indeterminate, spin_vanishes;
  };
  /// A panel by angle: |phi - from| = shift + q^2, q from begin to begin + span.
  struct Stretch {
    S shift, begin, span;
    S angle(const S& place) const { return shift + (begin + span * place) * (begin + span * place); }
    S length() const { return angle(S(1)); }
  };
  /// A panel as a slide took it: a stretch by angle, or else a duration.
  struct Taken {
    std::optional<Stretch> stretch;
    S duration;
  };
  /// What a slide is about.
  struct Slide {
    Hoop<S> hoop;
    S friction;                           ///< mu_kinetic sign(v)
    std::optional<PainleveEdge<S>> edge;  ///< the nearest, if it is near
    S left;                               ///< angle from a panel's start to it
    S free_force;                         ///< n0 at a panel's start

    /// What sliding says at an angle, `turned` past the panel's start.
    template <class T>
    SlidingCoefficients<T> coefficients(const Hoop<T>& hoops, const Trig<T>& phi, const T& turned) const {
      const T m(friction);
      if (!edge) return sliding_coefficients(hoops, phi, m);
      return sliding_coefficients(hoops, phi, m, edge->pivot(hoops, m, T(left) - T(edge->way) * turned));
    }
    /// Relative rounding of the accelerations where the pivot is so large: it comes of terms that may cancel.
    Number rounding(Number pivot) const {
      const Number Ic = value_of(hoop.Ic), rho = value_of(hoop.rho);
      return Number(16) * std::numeric_limits<Number>::epsilon() *
             (Ic + rho * (rho + Number(2) * std::abs(value_of(friction)))) / pivot;
    }
    /// The same at a panel's end: near the edge the pivot comes without cancellation.
    Number rounding_at_end(const S& pivot) const { return rounding(edge ? Number(1) : value_of(pivot)); }
  };

  explicit SlidingPanels(Number tolerance) : tolerance_(tolerance) {}

  /// The stretch of that length, its nodes closer where the spin is small and grows. rise: of w^2 / 2, an
  /// angle.
  static Stretch stretch_of(const S& spin, const S& rise, const S& length);
  void solve_by_angle(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                      Panel& panel) const;
  /// The state at a place in (0, 1] of a panel by angle that is solved, or nothing where that has lost
  /// digits: beside the panel's start, or where the spin is small against those at its ends.
  std::optional<ContactState<S>> state_at(const Slide& slide, const ContactState<S>& from,
                                          const Stretch& stretch, const Panel& panel, const S& place) const;
  void solve_by_time(const Slide& slide, const ContactState<S>& from, const S& duration, Panel& panel) const;

  const Grid& grid() const { return grid_; }

 private:
  Number tolerance_;
  Grid grid_;
};

}  // namespace leapmap
