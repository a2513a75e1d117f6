// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/dual_time.hpp"

#include <cmath>

#include "noslip/halved_time.hpp"

namespace leapmap {

template <class D>
D DualTime<D>::past(const Roll<D>& roll, const D& length) const {
  constexpr double tolerance = 1e-12;  // two halves of a panel agree so far, and are better by as much again
  return length > D(0.0) ? HalvedTime<D>(roll, tolerance, rule_).until(length) : D(0.0);
}

template <class D>
D DualTime<D>::time(const Hoop<D>& hoop, const D& angle, const D& spin, std::span<const double> turns,
                    const D& to) const {
  D total(0.0), from = angle, from_spin = spin;
  for (const double turn : turns) {
    const D way(turn < from.value || (turn == from.value && from_spin < D(0.0)) ? -1.0 : 1.0);
    const Roll<D> roll = begin_roll(seen(hoop, way), way * from, way * from_spin);
    const D half = length_to_rest(roll, way.value * (turn - from.value)) * 0.5;
    const D end = from + way * (half * 2.0);
    total += past(roll, half) + past(begin_roll(seen(hoop, -way), -(way * end), D(0.0)), half);
    from = end, from_spin = D(0.0);
  }
  const D way(to < from ? -1.0 : 1.0);
  total += past(begin_roll(seen(hoop, way), way * from, way * from_spin), way * (to - from));
  // From rest E does not depend on the spin to first order, and yet the time does: a hoop with a small spin
  // is one that was released at rest spin / phi'' ago.
  if (spin == D(0.0)) {
    const Trig<D> phi = trig(angle);
    const double acceleration = torque(hoop, phi).value / contact_inertia(hoop, phi).value;
    for (std::size_t k = 0; k < spin.by.size(); ++k) total.by[k] -= spin.by[k] / acceleration;
  }
  return total;
}

template class DualTime<RollingDual>;
template class DualTime<DesignDual>;

}  // namespace leapmap
