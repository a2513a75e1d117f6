// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/engines.hpp"

namespace leapmap {

bool has_engines() { return false; }
void evolve(Judge&, Place&, std::uint64_t) {}
void descend(Judge&, Place&) {}
void evolve_front(Judge&, std::vector<Place>&, std::uint64_t) {}

}  // namespace leapmap
