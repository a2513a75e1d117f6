// SPDX-License-Identifier: GPL-3.0-or-later
/// All that is computed in balls, behind one function: what links Arb, and what need not.
#pragma once

#include <span>

#include "leapmap/prove.hpp"

namespace leapmap {

/// What is proved of a box in which those parameters vary, none to three of them, or up to seven. The box and
/// its scene have been checked. Throws Stopped. The program replaces this function by one of its own
/// (cli/late.cpp): its source file must hold nothing else that the library uses.
Proof walked(const DesignBox& box, std::span<double Design::*const> varying, const Scene& scene, bool times);

}  // namespace leapmap
