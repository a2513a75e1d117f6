// SPDX-License-Identifier: GPL-3.0-or-later
/// A hoop from a drawing, reduced.
#include "hoop/body.hpp"

#include <array>
#include <string>
#include <vector>

#include "web/page.hpp"

namespace leapmap::web {
namespace {

/// What is reduced: diameter, mass and inertia of the ring, then mass, at, angle and inertia of each weight.
constexpr std::size_t of_ring = 3, of_weight = 4;
std::vector<double> numbers(of_ring);
/// What it comes to, in this order.
constexpr std::array reduced_names{"total_mass",   "eccentricity",   "inertia",  "mass_ratio",
                                   "offset_ratio", "inertia_factor", "direction"};
std::array<double, reduced_names.size()> reduced_numbers;

Body body_of_numbers() {
  Body body{numbers[0], numbers[1], numbers[2], {}};
  for (std::size_t at = of_ring; at < numbers.size(); at += of_weight)
    body.weights.push_back({std::to_string(body.weights.size()), numbers[at], numbers[at + 1],
                            numbers[at + 2], numbers[at + 3]});
  return body;
}

}  // namespace

/// Names by number, null after the last.
LEAPMAP_EXPORT const char* reduced_name(int i) {
  return i >= 0 && static_cast<std::size_t>(i) < reduced_names.size()
             ? reduced_names[static_cast<std::size_t>(i)]
             : nullptr;
}

/// Where the page puts the numbers of a hoop with so many weights.
LEAPMAP_EXPORT double* body_numbers(int weights) {
  numbers.resize(of_ring + of_weight * static_cast<std::size_t>(weights));
  return numbers.data();
}

/// Reduces it; the page has checked its numbers.
LEAPMAP_EXPORT const double* reduce_body() {
  const ReducedBody found = reduce_checked(body_of_numbers());
  reduced_numbers = {found.total_mass,   found.eccentricity,   found.inertia,  found.mass_ratio,
                     found.offset_ratio, found.inertia_factor, found.direction};
  return reduced_numbers.data();
}

/// From now on the page's hoop is drawn so, or by no drawing.
LEAPMAP_EXPORT void take_drawing(int given) {
  page.drawing.reset();
  page.held.clear();
  if (given) page.drawing = body_of_numbers();
}

/// Hoops that differ in the drawing's numbers have the same of this parameter in the SI.
LEAPMAP_EXPORT void hold(int parameter) {
  const auto* member = std::get_if<double Design::*>(&parameter_of(parameter).member);
  for (const SameInSi& one : same_in_si)
    if (member && one.parameter == *member) page.held.push_back(one);
}

}  // namespace leapmap::web
