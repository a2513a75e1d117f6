// SPDX-License-Identifier: GPL-3.0-or-later
/// The first stage of the exact solver.
#pragma once

#include <span>

#include "hoop/contact_state.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "noslip/block.hpp"

namespace leapmap {

/// Derives every design's roll and begins its search. Designs that do not set out are settled here. landed:
/// where the designs have just landed and go on from; empty: from their releases.
template <class T>
void prepare(std::span<const Design> designs, std::span<const ContactState<ScalarOf<T>>> landed,
             const Scene& scene, Block<T>& block, std::span<Outcome> outcomes);

}  // namespace leapmap
