// SPDX-License-Identifier: GPL-3.0-or-later
/// How long a hoop takes to roll, enclosed: the time is the integral of sqrt(J / E) over the angle.
#pragma once

#include "proof/forms.hpp"
#include "proof/motion.hpp"

namespace leapmap {

/// From one angle past the release to another [sqrt(R/g)], of one design, by Arb's integration of analytic
/// functions. E has to be above zero between. Not finite where it does not succeed.
Ball travel_time(const Roll<Ball>& roll, const Ball& from, const Ball& to);

}  // namespace leapmap
