// SPDX-License-Identifier: GPL-3.0-or-later
/// What the way to a jump asks of hoop and motor without slip.
#pragma once

#include <span>

#include "noslip/take_off.hpp"
#include "trajectory/way.hpp"

namespace leapmap {

/// To the last of the lift-offs found, at the angle `end`: every leg, as the same functions of the angle
/// whichever way the hoop rolls. spin: at the release.
template <class S>
Way<S> way_to(const Roll<S>& roll, const S& spin, const FoundLiftOffs& found, const S& end) {
  WayMeter<S> meter(roll.hoop, spin);
  meter.roll(roll, spin, std::span(found.turns).first(found.legs.back()), end);
  return meter.way();
}

}  // namespace leapmap
