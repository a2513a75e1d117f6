// SPDX-License-Identifier: GPL-3.0-or-later
/// Stages of the exact solver: polish a lift-off and fly up to the apex; fly jumps down to the landing.
#pragma once

#include <span>
#include <vector>

#include "hoop/contact_state.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "noslip/block.hpp"

namespace leapmap {

/// What is told of a design's way: angle and spin of every lift-off, and where it turned round, in order;
/// without times.
struct FoundLiftOffs {
  std::vector<LiftOff<double>> lift_offs;
  std::vector<std::size_t> legs;  ///< of each lift-off, from 0
  std::vector<double> turns;
  bool bounces = false;  ///< the first lift-off is where it landed
};

template <class T>
struct TakeOff {
  std::vector<SureFall<ScalarOf<T>>> falls;  ///< with one lift-off each, at most one a design
  FoundLiftOffs* told = nullptr;             ///< told every lift-off, if there
  bool keeps_flights = true;                 ///< for land to go on with

  /// Adds designs whose search goes on, because that was not the jump, to `going_on`.
  void run(Block<T>& block, const Scene& scene, std::span<Outcome> outcomes, DesignList& going_on);

  /// The same of designs that leave the plane where they landed. What stays low rolls on.
  void bounce(Block<T>& block, const Scene& scene, std::span<Outcome> outcomes, DesignList& going_on);

 private:
  /// The flights of some designs, one in each of `count` lanes; low(design) is told of each that goes on.
  template <class Low>
  void fly(Block<T>& block, const DesignLanes<WideOf<T>>& index, std::size_t count,
           const Roll<WideOf<T>>& roll, const WideOf<T>& angle, const Trig<WideOf<T>>& phi,
           const WideOf<T>& spin, const Scene& scene, std::span<Outcome> outcomes, const Low& low);
};

/// Flight time and dip of the jumps, and if asked for their measures. states: of all designs where they set
/// out, moved to just after the landing of their jump, which holds at once; empty: not asked for.
template <class T>
void land(const Block<T>& block, const DesignList& jumped, const Scene& scene, std::span<Outcome> outcomes,
          std::span<ContactState<ScalarOf<T>>> states, bool measures);

}  // namespace leapmap
