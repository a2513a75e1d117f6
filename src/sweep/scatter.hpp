// SPDX-License-Identifier: GPL-3.0-or-later
/// What a spec and a request ask of manufactured hoops.
#pragma once

#include <cstddef>
#include <memory>

#include "request/request.hpp"
#include "sweep/scatter_solver.hpp"

namespace leapmap {

/// Throws InputError if the spec's [scatter] or [goal] is not one that read_spec would let pass, or its
/// scatter lies for the larger part where no hoop can be.
void check_scatter(const Spec& spec);

/// The points after which hoops are made; dimensions: as many, of each spread.
std::shared_ptr<const SobolPoints> points_of(const Scatter& scatter, std::size_t a_spread = 1);

/// A solver for the request's statistics.
ScatterSolver scatter_solver_of(const Request& request, std::shared_ptr<const SobolPoints> points);

}  // namespace leapmap
