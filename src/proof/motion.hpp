// SPDX-License-Identifier: GPL-3.0-or-later
/// What a proof looks for zeros of: energy and normal force of a hoop that rolls, by the angle since its
/// release, and the height of one that flies, by the time. The equations are those of hoop/.
#pragma once

#include "hoop/flight.hpp"
#include "hoop/rolling_by_angle.hpp"

namespace leapmap {

/// E, twice the kinetic energy, an angle x past the release.
struct VisViva {
  template <class T>
  Sample<T> operator()(const Roll<T>& roll, const T& x) const {
    return {vis_viva_past_release(roll, x), T(2) * torque(roll.hoop, trig(roll.release + x))};
  }
};

/// Half its slope.
struct Push {
  template <class T>
  Sample<T> operator()(const Roll<T>& roll, const T& x) const {
    const Trig<T> phi = trig(roll.release + x);
    return {torque(roll.hoop, phi), -roll.hoop.rho * cos_from_vertical(roll.hoop, phi)};
  }
};

/// G, which has the sign of the normal force (11).
struct Lift {
  template <class T>
  Sample<T> operator()(const Roll<T>& roll, const T& x) const {
    const Trig<T> phi = trig(roll.release + x);
    return lift(roll.hoop, lift_terms(roll.hoop, phi), vis_viva_past_release(roll, x),
                T(2) * torque(roll.hoop, phi));
  }
};

/// The spin there.
template <class T>
T spin_past_release(const Roll<T>& roll, const T& x) {
  return sqrt(vis_viva_past_release(roll, x) / contact_inertia(roll.hoop, trig(roll.release + x)));
}

/// A hoop as it lifts off.
template <class T>
struct TakingOff {
  Hoop<T> hoop;
  Trig<T> phi;
  T spin;
};

/// y, the height of its lowest point, and y', by the time since.
struct Height {
  template <class T>
  Sample<T> operator()(const TakingOff<T>& off, const T& t) const {
    const HeightAbovePlane<T> y = height_above_plane(off.hoop, off.phi, off.spin, t);
    return {y.value, y.rate};
  }
};

struct Climb {
  template <class T>
  Sample<T> operator()(const TakingOff<T>& off, const T& t) const {
    const HeightAbovePlane<T> y = height_above_plane(off.hoop, off.phi, off.spin, t);
    return {y.rate, y.acceleration};
  }
};

/// y'' and y''', with the motor or without it.
struct Bend {
  template <class T>
  Sample<T> operator()(const TakingOff<T>& off, const T& t) const {
    const Hoop<T>& hoop = off.hoop;
    const Turned<T> turned = turned_in_flight(hoop, off.spin, t);
    const T sine = off.phi.sin * turned.trig.cos + off.phi.cos * turned.trig.sin,
            cosine = off.phi.cos * turned.trig.cos - off.phi.sin * turned.trig.sin;
    const T &w = turned.rate, square = w * w;
    return {-hoop.rho * (square * cosine + hoop.aloft * sine) - hoop.cos_slope,
            hoop.rho * w * (square * sine - T(3) * hoop.aloft * cosine)};
  }
};

}  // namespace leapmap
