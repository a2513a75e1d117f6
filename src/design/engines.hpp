// SPDX-License-Identifier: GPL-3.0-or-later
/// The engines of others: pagmo's CMA-ES and NSGA-II, NLopt's SLSQP. A build without them does without.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "design/improve.hpp"

namespace leapmap {

/// Whether this build has pagmo and NLopt.
bool has_engines();

/// CMA-ES about a place; the place becomes the best one met. Judges one design at a time, on this thread.
void evolve(Judge& judge, Place& place, std::uint64_t seed);

/// SLSQP from a feasible place, with exact derivatives of objective and goals, inside the place's branch; the
/// place becomes the best feasible one met. Does nothing where derivatives are not known.
void descend(Judge& judge, Place& place);

/// NSGA-II from these places, by blocks of designs on all threads; all places that it came to are added.
void evolve_front(Judge& judge, std::vector<Place>& places, std::uint64_t seed);

}  // namespace leapmap
