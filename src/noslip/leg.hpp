// SPDX-License-Identifier: GPL-3.0-or-later
/// The legs of a design's way: how one begins, and how the next follows where the hoop turns round.
#pragma once

#include "leapmap/scene.hpp"
#include "noslip/block.hpp"

namespace leapmap {

/// A leg as it begins.
template <class T>
struct LegStart {
  T slope;          ///< theta, as seen on this leg
  T end;            ///< of the leg, unless it turns round before
  MaskOf<T> above;  ///< G > 0 at its start
  MaskOf<T> last;   ///< it does not turn again
};

/// Stores the first `count` lanes' rolls, finds where the legs end, and begins their searches. release: the
/// design's, seen as on this leg; the hoop turns round beyond it. T: the block's, or two of them.
template <class B, class T>
void begin_leg(Block<B>& block, const DesignLanes<T>& index, std::size_t count, const Roll<T>& roll,
               const Roll<T>& release, const LegStart<T>& leg);

/// The next leg of designs that turn round.
template <class T>
void turn_round(Block<T>& block, const DesignList& designs, const Scene& scene);

}  // namespace leapmap
