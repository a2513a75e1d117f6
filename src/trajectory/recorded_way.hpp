// SPDX-License-Identifier: GPL-3.0-or-later
/// The phases of one design as an exact solver goes through them, for what goes the same way again.
#pragma once

#include <optional>
#include <vector>

#include "hoop/contact_state.hpp"
#include "leapmap/outcome.hpp"

namespace leapmap {

/// A panel of a slide by angle: |phi - from| = shift + curve q^2, q from begin to begin + span.
template <class S>
struct SlideStretch {
  S shift, begin, span;
  S curve = S(1);  ///< or -1: the spin vanishes where q is zero, at the panel's end or beyond
  S angle(const S& place) const { return shift + curve * (begin + span * place) * (begin + span * place); }
  S length() const { return angle(S(1)); }
};
/// A panel as a slide took it: a stretch by angle, or else a duration.
template <class S>
struct SlidePanel {
  std::optional<SlideStretch<S>> stretch;
  S duration;
};
/// The panels of one slide, of which the last ends where the slide does.
template <class S>
using RecordedSlide = std::vector<SlidePanel<S>>;

struct RecordedWay {
  struct Begun {
    Phase phase;
    ContactState<double> at;
    int direction;              ///< of sliding: 1, -1; else 0
    std::vector<double> turns;  ///< angles where it turns round, rolling
  };
  std::vector<Begun> phases;
  std::vector<Flight<double>> flights;        ///< in order
  std::vector<RecordedSlide<double>> slides;  ///< in order; of a hoop that rocks to rest not the last one
  ContactState<double> end;
  bool holds = false;  ///< landings hold at once, as without slip
};

}  // namespace leapmap
