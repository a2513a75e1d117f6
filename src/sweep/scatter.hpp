// SPDX-License-Identifier: GPL-3.0-or-later
/// What a spec asks of hoops as made.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "sweep/scatter_solver.hpp"

namespace leapmap {

/// The fields of hoops as made that the spec's map has: yield and its error, what is cut off, and of each
/// quantity asked for its mean, standard deviation and quantiles. None without [scatter].
std::vector<const Field*> scatter_fields_of(const Spec& spec);

/// The quantities of which these are.
std::vector<const Field*> quantities_of_made(const Spec& spec);

/// Throws InputError if the spec's [scatter] or [goal] is not one that read_spec would let pass, or its
/// scatter lies for the larger part where no hoop can be.
void check_scatter(const Spec& spec);

/// The points after which hoops are made; dimensions: as many, of each spread.
std::shared_ptr<const SobolPoints> points_of(const Scatter& scatter, std::size_t a_spread = 1);

/// A spec whose solver computes what is looked at in hoops as made: goals, and these quantities.
Spec spec_of_made(const Spec& spec, const std::vector<const Field*>& quantities);

/// A solver for the columns that scatter_fields_of names.
ScatterSolver scatter_solver_of(const Spec& spec, std::shared_ptr<const SobolPoints> points);

}  // namespace leapmap
