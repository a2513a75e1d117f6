// SPDX-License-Identifier: GPL-3.0-or-later
/// What acts on a hoop without slip.
#pragma once

#include <array>

#include "leapmap/design.hpp"

namespace leapmap {

inline constexpr std::array<double Design::*, 8> acting{
    &Design::slope,         &Design::mass_ratio,   &Design::offset_ratio, &Design::inertia_factor,
    &Design::release_angle, &Design::release_spin, &Design::drive_torque, &Design::resisting_torque};

}  // namespace leapmap
