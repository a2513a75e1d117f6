// SPDX-License-Identifier: GPL-3.0-or-later
/// Normal force and spin within a panel of a slide.
#pragma once

#include <type_traits>

#include "friction/sliding_panel.hpp"
#include "trajectory/way.hpp"

namespace leapmap {

/// S: double, or a dual.
template <class S>
class PanelForces {
 public:
  using Panels = SlidingPanels<S>;

  /// panel: solved. All must outlive it.
  PanelForces(const Panels& panels, const typename Panels::Slide& slide, const ContactState<S>& from,
              const typename Panels::Taken& taken, const typename Panels::Panel& panel)
      : panels_(panels), slide_(slide), from_(from), taken_(taken), panel_(panel) {}

  /// At a place from 0 to 1.
  ForceAndSpin<S> at(double place) const {
    const ContactState<S> at = state_at(place);
    return forces_of(slide_.hoop, slide_.friction, at.angle, at.spin);
  }
  /// The same in plain numbers, with rates by time.
  ForceAndSpin<Rated> rated_at(double place) const requires std::is_same_v<S, double> {
    const ContactState<double> at = state_at(place);
    const double turns =
        sliding_motion(slide_.hoop, trig(at.angle), at.spin * at.spin, slide_.friction).angular;
    const auto rated = [](double number, double rate) {
      return Rated::parameter(0.0, 0).through(number, rate);
    };
    return forces_of(mapped<Rated>(slide_.hoop, [](double number) { return Rated(number); }),
                     Rated(slide_.friction), rated(at.angle, at.spin), rated(at.spin, turns));
  }

 private:
  template <class N>
  static ForceAndSpin<N> forces_of(const Hoop<N>& hoop, const N& friction, const N& angle, const N& spin) {
    return {sliding_motion(hoop, trig(angle), N(spin * spin), friction).normal_force, spin};
  }

  ContactState<S> state_at(double place) const {
    return panels_.state_within(slide_, from_, taken_, panel_, S(place));
  }

  const Panels& panels_;
  const typename Panels::Slide& slide_;
  const ContactState<S>& from_;
  const typename Panels::Taken& taken_;
  const typename Panels::Panel& panel_;
};

}  // namespace leapmap
