// SPDX-License-Identifier: GPL-3.0-or-later
/// A stretch of one sliding phase, solved at the nodes of a panel.
///
/// In the angle u = w^2 obeys du/dphi = a u + b with a = 2 rho c turn, b = 2 n1 turn + 2 tau / Ic,
/// n1 = cos(theta) + rho s tau / Ic (hoop/sliding.hpp), so that u = e^A (u0 + integral of b e^-A), A the
/// integral of a; time and slip are integrals over u's root, and travel follows. Near Painleve's edge n0
/// takes the place of u: it obeys an equation of the same kind, with -tan(phi) + 2 rho c turn and tan(phi) n1
/// + 3 rho c tau / Ic, and keeps its digits where it vanishes with the pivot. Where the spin goes through
/// zero panels are in time, angle and spin at their nodes by Picard's iteration; or, as u is smooth there,
/// one by angle ends where u is zero.
#pragma once

#include <optional>

#include "friction/contact_phases.hpp"
#include "hoop/painleve.hpp"
#include "numerics/panel_fall.hpp"
#include "trajectory/recorded_way.hpp"

namespace leapmap {

/// S: a number; a dual, whose derivatives panels of given lengths carry along; or a batch, the panels of as
/// many slides at once, by angle and far from any edge.
template <class S>
class SlidingPanels {
 public:
  using Number = ScalarOf<S>;
  using Value = ValueOf<S>;
  using Mask = MaskOf<S>;
  static constexpr std::size_t nodes = 24;
  /// What is taken for the error of an integral up to a place on a panel, over its integrand's tail. It is
  /// about a hundredth (numerics/spectral.hpp); the rest is room for errors that grow after it.
  static constexpr Number error_over_tail = Number(0.25);
  static constexpr bool has_edges = Lanes<S>::count == 1;  ///< panels in lanes are far from any
  using Grid = SpectralPanel<S, nodes>;
  using Values = typename Grid::Values;

  /// A function at the panel's start, nodes and end, and its derivative by the panel's coordinate.
  struct Course {
    Sample<S> start;
    Values value, rate;
    Sample<S> end;
  };
  /// What the nodes of a panel hold, in order of time, and its end. By angle the nodes of duals hold no
  /// slip and no rates of n0.
  struct Panel {
    Course slip, free_force;
    Values turning, time_rate;  ///< derivatives of angle and time by the panel's coordinate
    Sample<S> travel_start, travel_end;
    // Of a panel by angle: y = e^growth (start_y + driven) is w^2 or, where it says so, n0.
    Values growth, driven, driven_rate;
    Sample<S> driven_start, driven_end;
    S start_y;
    bool by_force;
    Value least_pivot;
    Value spin_excess;  ///< the nodes resolve y if at most 1, also where the spin vanishes
    ContactState<S> end;
    S turned;            ///< from start to end
    S sweep;             ///< and no less than the angle from the start to any place
    Value excess;        ///< at most 1: spin, slip and time are good; infinity: it could not be solved
    Value end_excess;    ///< of a panel by angle, the same of its end alone
    Mask indeterminate;  ///< the pivot is not above zero somewhere: the equations have no answer there
    Mask spin_vanishes;  ///< w^2 is not above zero somewhere
  };
  using Stretch = SlideStretch<S>;
  using Taken = SlidePanel<S>;
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
      if (!has_edges || !edge) return sliding_coefficients(hoops, phi, m);
      return sliding_coefficients(hoops, phi, m, edge->pivot(hoops, m, T(left) - T(edge->way) * turned));
    }
    /// Relative rounding of the accelerations where the pivot is so large: it comes of terms that may cancel.
    Value rounding(const Value& pivot) const {
      using std::abs;
      const Value Ic = value_of(hoop.Ic), rho = value_of(hoop.rho);
      return Value(Number(16) * std::numeric_limits<Number>::epsilon()) *
             (Ic + rho * (rho + Value(Number(2)) * Value(abs(value_of(friction))))) / pivot;
    }
    /// The same at a panel's end: near the edge the pivot comes without cancellation.
    Value rounding_at_end(const S& pivot) const {
      return rounding(has_edges && edge ? Value(Number(1)) : value_of(pivot));
    }
  };

  explicit SlidingPanels(Number tolerance) : tolerance_(tolerance) {}

  /// The stretch of that length, its nodes closer where the spin is small and grows. rise: of w^2 / 2, an
  /// angle.
  static Stretch stretch_of(const S& spin, const S& rise, const S& length);
  /// The stretch of that length to where the spin vanishes.
  static Stretch stretch_to_rest(const S& length) {
    using std::sqrt;
    const S root = sqrt(length);
    return {length, -root, root, S(-1)};
  }
  /// Solves a panel by angle. Where it is indeterminate, only `excess` and `end_excess` hold besides; where
  /// the spin vanishes, they, spin_excess, start_y and the driven ones do: the rest is the panel's that was
  /// there before.
  void solve_by_angle(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                      Panel& panel) const;
  /// A state inside a panel, and whether it has kept its digits.
  struct Inside {
    ContactState<S> state;
    Mask is_sharp;
  };
  /// The state at a place in (0, 1] of a panel by angle that is solved. It loses digits beside the start of a
  /// panel that lasts far longer than all before it, and where the spin is small against those at its ends.
  Inside state_at(const Slide& slide, const ContactState<S>& from, const Stretch& stretch, const Panel& panel,
                  const S& place) const;
  /// The same of any panel of one slide that is solved, from its start on, with all its digits: where they
  /// are lost, by a panel of its own.
  ContactState<S> state_within(const Slide& slide, const ContactState<S>& from, const Taken& taken,
                               const Panel& panel, const S& place) const;
  /// Solves a panel of that duration. It has no growth and nothing driven; where it is indeterminate only
  /// `excess` holds.
  void solve_by_time(const Slide& slide, const ContactState<S>& from, const S& duration, Panel& panel) const;
  /// Solves a panel as a slide took it.
  void solve(const Slide& slide, const ContactState<S>& from, const Taken& taken, Panel& panel) const {
    if (taken.stretch)
      solve_by_angle(slide, from, *taken.stretch, panel);
    else
      solve_by_time(slide, from, taken.duration, panel);
  }

  /// The travel on a panel that is solved, and whether bounds say that it stays within a runway there. slip:
  /// its extent.
  Course travel_on(const Panel& panel) const requires(!has_derivatives<S>);
  Mask keeps_within(const S& runway, const ContactState<S>& from, const Panel& panel,
                    const PanelExtent<S>& slip) const requires(!has_derivatives<S>);

  const Grid& grid() const { return grid_; }
  Number tolerance() const { return tolerance_; }

 private:
  ContactState<S> state_in_time(const Slide& slide, const ContactState<S>& from, const Panel& panel,
                                const S& place) const;
  using T = typename Grid::T;  ///< the nodes in lanes, or each lane a panel

  /// What a panel by angle meets at its nodes.
  struct AtNodes {
    std::array<Trig<T>, nodes / Grid::width> phi;
    std::array<SlidingCoefficients<T>, nodes / Grid::width> sliding;
    Values grows, drives;  ///< a and b of y' = a y + b, by the panel's coordinate
    T least_pivot;         ///< of those in each lane
  };
  AtNodes at_nodes(const Slide& slide, const ContactState<S>& from, const Stretch& stretch, const S& way,
                   bool by_force, Values& turning) const;
  /// And at one of its ends: w^2, n0, and how fast angle and time go by the panel's coordinate.
  struct AtEnd {
    Trig<S> phi;
    SlidingCoefficients<S> sliding;
    S u, force, turning, time_rate;
  };
  /// The error of an integral over a panel whose nodes resolve a function to its tail. Where its Legendre
  /// coefficients fall like a geometric series, the first that Gauss's rule gets wrong are about the tail's
  /// square over the function's size. Returns some eighty times what they make of the integral.
  static Value integral_error(const Value& tail, const Value& integral) {
    const Value ten(Number(10)), least(std::numeric_limits<Number>::min());
    return ten * tail * tail / (larger(integral, Value(ten * tail)) + least);
  }
  /// Slip, travel and n0 at the ends of a panel whose spin and time are known, and of numbers also the slip
  /// at its end.
  void fill_ends(const Slide& slide, const ContactState<S>& from, const AtEnd& start, const AtEnd& end,
                 const S& duration, Panel& panel) const;
  struct Errors {
    Value between, at_end;  ///< at and between the nodes, and at the panel's end
  };
  /// The rates of n0 and the slip at the nodes, where w^2 is `squared`, and the slip at the end. It is
  /// integrated: where a slide begins at v = 0 and hardly leaves it, momenta differ by no more than their
  /// roundings. Returns the slip's errors, of one more than its size. Of duals only these.
  Errors slip_at_nodes(const Slide& slide, const ContactState<S>& from, const AtNodes& at,
                       const Values& squared, const S& duration, const Value& time_tail, Panel& panel) const;

  Number tolerance_;
  Grid grid_;
};

}  // namespace leapmap
