// SPDX-License-Identifier: GPL-3.0-or-later
/// Records the phases of a design with friction.
#pragma once

#include <cmath>

#include "friction/coulomb.hpp"
#include "trajectory/recorded_way.hpp"

namespace leapmap {

/// On the way to a jump from `at`, which is moved to just after its landing. Adds its phases to those that
/// are recorded.
Outcome recorded_way(CoulombSolver<double>& solver, Start start, const Design& design,
                     ContactState<double>& at, const Scene& scene, RecordedWay& recorded);

/// Gives a dual state the values of a recorded one. Returns whether they were the same but for `agreement`,
/// absolute or relative, whichever is coarser.
template <class D>
bool take_values(ContactState<D>& at, const ContactState<double>& there, double agreement) {
  bool near = true;
  const auto take = [&](D& value, double number) {
    near = near && std::abs(value.value - number) <= agreement * (1.0 + std::abs(number));
    value.value = number;
  };
  take(at.time, there.time), take(at.travel, there.travel), take(at.angle, there.angle);
  take(at.spin, there.spin), take(at.slip, there.slip), take(at.normal, there.normal);
  return near;
}

}  // namespace leapmap
