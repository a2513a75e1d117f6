// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the hoop is, and how it moves, in contact with the plane or leaving it.
#pragma once

namespace leapmap {

template <class S>
struct ContactState {
  S time = S(0);    ///< since release [sqrt(R/g)]
  S travel = S(0);  ///< x, of the hoop's centre since release [R]
  S angle = S(0), spin = S(0);
  S slip = S(0);    ///< v = x' - w
  S normal = S(0);  ///< v_n with which a flight begins: of a rebound above zero
};

template <class S>
ContactState<double> in_double(const ContactState<S>& at) {
  return {static_cast<double>(at.time), static_cast<double>(at.travel), static_cast<double>(at.angle),
          static_cast<double>(at.spin), static_cast<double>(at.slip),   static_cast<double>(at.normal)};
}

}  // namespace leapmap
