// SPDX-License-Identifier: GPL-3.0-or-later
/// The slides of many designs, a panel of as many at once as there are lanes.
///
/// A lane takes plain panels: by angle, far from Painleve's edge, with falls through zero that the panel's
/// cubics tell (numerics/panel_fall.hpp). A slide that meets anything else goes on by itself from there
/// (friction/sliding_leg.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "friction/edge_looks.hpp"
#include "friction/ended_phase.hpp"
#include "friction/pivot_zeros.hpp"
#include "friction/sliding_leg.hpp"
#include "numerics/rows.hpp"

namespace leapmap {

template <class T>
class SlidingLanes {
 public:
  using S = ScalarOf<T>;

  /// tolerance: as of SlidingLeg. most: designs on their way at once.
  SlidingLanes(double tolerance, std::size_t most);

  /// What is known of a design's pivot before it slides.
  struct Pivot {
    PivotZeros<S> zeros;  ///< sliding downhill
    S least;              ///< as of EdgeLooks
  };
  /// Begins a slide, which the passes to come take on.
  void begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_kinetic, const Pivot& pivot,
             const ContactState<S>& at, const S& runway, int direction);
  std::size_t waiting() const { return waiting_.size(); }
  void clear() { waiting_.clear(); }
  /// Takes some slides a panel further, and adds those that end to `ended`.
  void pass(std::vector<EndedPhase<S>>& ended);

 private:
  using Panels = SlidingPanels<T>;
  using Panel = typename Panels::Panel;
  static constexpr std::size_t width = Lanes<T>::count;

  /// What is not a number in the lanes.
  struct Slide {
    S runway, mu_kinetic;
    S least_pivot;  ///< a panel comes no nearer to Painleve's edge
    int direction;
    bool is_given;  ///< the next panel's stretch is: it ends where the spin vanishes, or the slide does
    bool ends;      ///< there, by `end`
    PhaseEnd end;
    int panels;
  };
  /// Some slides at the start of a panel. Lanes to spare repeat the first.
  struct InLanes {
    std::size_t count;
    std::array<std::uint32_t, width> index;
    typename Panels::Slide slide;
    ContactState<T> from;
    T longest, runway, direction, least_pivot;
    MaskOf<T> is_given, is_last;  ///< as of Slide: is_given, ends
    typename Panels::Stretch given;
  };
  InLanes take();
  /// The panels that they take, by angle while the hoop turns.
  struct Ahead {
    MaskOf<T> turns;
    T rise;           ///< of w^2 / 2, an angle
    T shift, length;  ///< where the stretch is not given
    typename Panels::Stretch stretch;
  };
  Ahead look_ahead(const InLanes& slides) const;
  /// The first event of each panel.
  struct Events {
    T place;  ///< in (0, 1]; 2: none
    std::array<PhaseEnd, width> end;
    MaskOf<T> plain;  ///< else the slide has to look for it by itself
  };
  Events first_events(const InLanes& slides, const MaskOf<T>& asked) const;
  /// Where the spin vanishes on panels on which it does.
  struct Rest {
    MaskOf<T> is_known;
    T length;
  };
  Rest rest(const typename Panels::Stretch& stretch, const Panel& panel, const MaskOf<T>& asked) const;
  /// What the panels say, once they are solved.
  struct Seen {
    MaskOf<T> is_steep;  ///< it comes too near to Painleve's edge
    /// To the tolerance; where it is the last one, as well as it goes. Where nothing comes only its end has
    /// to be accurate.
    MaskOf<T> solved;
    MaskOf<T> done;         ///< the slide has ended, at the panel's end
    MaskOf<T> goes_on;      ///< nothing ends the slide on this panel
    MaskOf<T> ends_inside;  ///< the first of `events` ends it, at `inside`
    MaskOf<T> ends_again;   ///< that ends it, but `inside` has lost digits: the panel is solved once more, up
                            ///< to there
    Events events;
    typename Panels::Inside inside;
    Rest rest;  ///< where the spin vanishes; the next panel leads there
    MaskOf<T>
        hardly_set_out;  ///< the spin vanishes soon after a start near rest; the next panel goes half the way
    MaskOf<T> unresolved;  ///< the spin vanishes, but the nodes do not resolve w^2
  };
  Seen look_at_panel(const InLanes& slides, const Ahead& ahead) const;
  /// How long the next panel may be; is_shorter: no event and no end, but the slide goes on by a shorter one.
  struct Next {
    MaskOf<T> is_shorter;
    T length;
  };
  Next next_length(const InLanes& slides, const Ahead& ahead, const Seen& seen) const;
  /// Stores where the slides are now, and the stretches that are given.
  void put(const InLanes& slides, const Ahead& ahead, const Seen& seen, const T& length);
  ContactState<S> state_of(std::uint32_t place) const;
  void alone(std::uint32_t place, std::vector<EndedPhase<S>>& ended);

  Panels panels_;
  S clear_of_zeros_;  ///< how far panels keep from the pivot's zeros (resolved_length's stretch)
  SlidingLeg<S> leg_;
  std::vector<Slide> slides_;
  PackedRows<S, 9> hoops_;
  PackedRows<S, 8> states_;  // states: time, travel, angle, spin, slip; n0, friction, longest panel
  PackedRows<S, 8> zeros_;
  PackedRows<S, 4> stretches_;  // where given
  std::vector<std::uint32_t> waiting_;
  Panel panel_;
};

}  // namespace leapmap
