// SPDX-License-Identifier: GPL-3.0-or-later
/// One sliding phase, panel by panel (friction/sliding_panel.hpp), to whatever ends it.
#pragma once

#include <vector>

#include "friction/sliding_panel.hpp"

namespace leapmap {

/// How long the panels of a slide may be.
namespace panel_lengths {

inline constexpr double longest_angle = 2.5, first_angle = 1.2;  ///< of a panel by angle [rad]
inline constexpr double shortest_angle = 1e-12;                  ///< of 1 + |angle|
/// Where the spin vanishes within less than this, panels are by time.
inline constexpr double vanishing_angle = 0.05;
inline constexpr double longest_time = 1.0, first_time = 0.25, shortest_time = 1e-12;  ///< [sqrt(R/g)]
inline constexpr double least_place = 0.02;                                            ///< see comes_too_soon

/// An event's place in a panel has the panel's digits. It comes too soon for its time to have as many in a
/// panel that lasts long, as at almost no spin, and in one that lasts long beside all that came before it.
template <class T>
auto comes_too_soon(const T& place, const T& time_before, const T& duration) {
  using S = ScalarOf<T>;
  return (place < T(S(least_place))) &
         ((duration > T(S(longest_time))) | (time_before < duration * T(S(least_place))));
}

/// The share of a panel's length for the next, or for the same once more: the tails go about with the
/// length's power `nodes`, so that this one just meets the tolerance, with some slack. excess: of the panel.
template <class T>
T change(const T& excess, std::size_t nodes, ScalarOf<T> most) {
  using S = ScalarOf<T>;
  using std::exp, std::log;
  const T share = T(S(0.85)) * exp(log(excess) * T(S(-1) / static_cast<S>(nodes)));
  return larger(T(S(0.3)), smaller(share, T(most)));
}

}  // namespace panel_lengths

template <class S>
class SlidingLeg {
 public:
  /// Spin, slip and time on a panel are good to half the tolerance, relative, or to some roundings.
  explicit SlidingLeg(double tolerance);

  /// Slides on from a state with n0 > 0 (or zero but for rounding), towards `direction` (1 or -1), to the
  /// phase's end. taken, if there, is told the panels, the last of which ends where the phase does.
  PhaseEnd run(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& runway, int direction,
               std::vector<typename SlidingPanels<S>::Taken>* taken = nullptr) const;

  /// Slides on for a time, with no look at what would end the phase. False: it could not be solved.
  bool advance(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& duration,
               int direction) const;

 private:
  using Panels = SlidingPanels<S>;
  using Panel = typename Panels::Panel;
  using Slide = typename Panels::Slide;

  /// The first event of a panel: where, what, and whether shorter panels would tell better.
  struct Event {
    S place;  ///< in (0, 1]; 2: none
    PhaseEnd end;
    bool unsure;
  };
  Event first_event(const ContactState<S>& from, const S& runway, int direction, const Panel& panel) const;

  /// Panel after panel: the one in hand, and how long the next one may be.
  struct Step {
    // An angle, or a time, whichever a panel goes by.
    S length{panel_lengths::first_angle}, duration{panel_lengths::first_time};
    bool by_angle = false;
    typename Panels::Stretch stretch{};  ///< of the panel in hand, if by angle
    Panel panel;                         // 2 KiB that solving it fills

    S& extent() { return by_angle ? length : duration; }
    /// The panel in hand as far as a share of it.
    typename Panels::Taken part(const S& share) const;
  };
  /// Bounds of a panel's length.
  struct Bounds {
    S longest, shortest, briefest;  ///< angle, angle, time
  };
  /// Solves a panel that resolves what it holds: by angle while the hoop turns and its spin does not vanish
  /// soon, else by time. Nothing: solved; else how the phase ends.
  std::optional<PhaseEnd> take_panel(const Slide& slide, const ContactState<S>& at, const S& way,
                                     const S& acceleration, const Bounds& bounds, Step& step) const;
  /// Ends the slide within the panel in hand. False: it could not be solved.
  bool end_within(const S& place, Slide& slide, ContactState<S>& at, Step& step) const;
  /// How a slide ends that has come to Painleve's edge; nothing: it has not, or something may happen yet.
  static std::optional<PhaseEnd> end_at_edge(const Slide& slide, const ContactState<S>& at,
                                             const SlidingMotion<S>& motion);

  Panels panels_;
};

}  // namespace leapmap
