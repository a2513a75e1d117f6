// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "friction/contact_phases.hpp"

namespace leapmap {

/// The end of a phase, and where that is, of the design at a place among those on their way.
template <class S>
struct EndedPhase {
  std::uint32_t place;
  PhaseEnd end;
  ContactState<S> at;
};

}  // namespace leapmap
