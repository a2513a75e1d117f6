// SPDX-License-Identifier: GPL-3.0-or-later
/// Descent by NLopt's SLSQP. Libraries built without NLopt have a function that does nothing.
#pragma once

#include "design/improve.hpp"

namespace leapmap {

/// SLSQP from a feasible place, with exact derivatives of objective and goals, inside the place's branch; the
/// place becomes the best feasible one met. Does nothing where derivatives are not known.
void descend(Judge& judge, Place& place);

}  // namespace leapmap
