// SPDX-License-Identifier: GPL-3.0-or-later
/// Where OpenMP's threads may run: OMP_PLACES and OMP_PROC_BIND, which the runtime honours.
#pragma once

#include <string>

namespace leapmap {

/// Lets the calling thread run wherever the program may. One that is not OpenMP's own inherits the place of
/// the thread that makes it, and would take turns with a thread that solves.
void leave_place() noexcept;

/// Of those variables, what a plan says; empty: threads are not bound.
std::string told_places();

}  // namespace leapmap
