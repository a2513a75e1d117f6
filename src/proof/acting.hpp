// SPDX-License-Identifier: GPL-3.0-or-later
/// What acts on a hoop without slip.
#pragma once

#include <array>
#include <string>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

inline constexpr std::array<double Design::*, 8> acting{
    &Design::slope,         &Design::mass_ratio,   &Design::offset_ratio, &Design::inertia_factor,
    &Design::release_angle, &Design::release_spin, &Design::drive_torque, &Design::resisting_torque};

/// Throws InputError for scenes of which nothing can be proved. origin: in front of the message.
inline void refuse_unprovable(const Scene& scene, const std::string& origin = {}) {
  const std::string place = origin.empty() ? "" : origin + ": ";
  if (scene.model != Mechanism::hoop)
    throw InputError(place + "model = pendulum: nothing can be proved of a pendulum; allowed: model = hoop");
  if (scene.friction != Friction::sticking)
    throw InputError(place +
                     "friction = coulomb: nothing can be proved with friction; allowed: friction = sticking");
}

}  // namespace leapmap
