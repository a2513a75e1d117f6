// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops as drawings have them, as arrays: a row a hoop, with diameter, mass and inertia of its ring, then
/// mass, place, angle and inertia of each weight. Lengths in m, masses in kg, angles in rad.
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

namespace leapmap::python {

using Rows = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// What each hoop comes to: arrays total_mass, eccentricity, inertia, mass_ratio, offset_ratio,
/// inertia_factor. weights: their names. Throws InputError for a hoop that cannot be.
pybind11::dict reduce_hoops(const Rows& hoops, const std::vector<std::string>& weights);

/// The derivatives of one quantity by each number of the hoops, by key, from those by their ratios.
/// by: a row a hoop, with the derivatives by mass_ratio, offset_ratio and inertia_factor, and by the
/// logarithms of the hoop's mass and size.
pybind11::dict differentiate_by_hoop(const Rows& hoops, const std::vector<std::string>& weights,
                                     const Rows& by);

/// The powers of mass and size to which a hoop's own value of a parameter is proportional, if `text` gives it
/// with a unit of the SI; None: it has no unit, or does not depend on them.
pybind11::object powers_in_si(const std::string& parameter, const std::string& text);

}  // namespace leapmap::python
