// SPDX-License-Identifier: GPL-3.0-or-later
/// The sums over a body that matter to its motion, on any scalar.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "leapmap/body.hpp"
#include "numerics/dual.hpp"

namespace leapmap {

/// As ReducedBody.
template <class T>
struct Reduced {
  T total_mass, eccentricity, inertia, mass_ratio, offset_ratio, inertia_factor, direction;
};

namespace body {
inline void direction_of(double angle, double& c, double& s) { c = std::cos(angle), s = std::sin(angle); }
inline double length_of(double x, double y) { return std::hypot(x, y); }
inline double at_most_one(double offset) { return std::min(offset, 1.0); }  // more is a rounding
inline double angle_of(double y, double x) { return std::atan2(y, x); }

template <std::size_t N>
void direction_of(const Dual<double, N>& angle, Dual<double, N>& c, Dual<double, N>& s) {
  const double cosine = std::cos(angle.value), sine = std::sin(angle.value);
  c = angle.through(cosine, -sine), s = angle.through(sine, cosine);
}
template <std::size_t N>
Dual<double, N> length_of(const Dual<double, N>& x, const Dual<double, N>& y) {
  return sqrt(x * x + y * y);
}
template <std::size_t N>
Dual<double, N> at_most_one(Dual<double, N> offset) {
  offset.value = std::min(offset.value, 1.0);
  return offset;
}
template <std::size_t N>
Dual<double, N> angle_of(const Dual<double, N>& y, const Dual<double, N>& x) {
  return atan2(y, x);
}
}  // namespace body

/// The sums. number(part, member): the ring's or a weight's number as a T.
template <class T, class Number>
Reduced<T> reduce_by(const Body& ring, const Number& number) {
  const T radius = 0.5 * number(ring, &Body::diameter), mass = number(ring, &Body::mass);
  T weights(0.0), x(0.0), y(0.0);
  for (const Weight& weight : ring.weights) {
    const T m = number(weight, &Weight::mass), at = number(weight, &Weight::at);
    T c(0.0), s(0.0);
    body::direction_of(number(weight, &Weight::angle), c, s);
    weights += m;
    x += m * at * c, y += m * at * s;
  }
  if (weights > T(0.0)) x = x / weights, y = y / weights;
  // About the weights' common centre no two terms cancel.
  T spread = std::isnan(ring.inertia) ? mass * radius * radius : number(ring, &Body::inertia);
  for (const Weight& weight : ring.weights) {
    const T m = number(weight, &Weight::mass), at = number(weight, &Weight::at);
    T c(0.0), s(0.0);
    body::direction_of(number(weight, &Weight::angle), c, s);
    const T dx = at * c - x, dy = at * s - y;
    spread += number(weight, &Weight::inertia) + m * (dx * dx + dy * dy);
  }
  const T total = mass + weights, share = weights / total,
          offset = body::at_most_one(body::length_of(x, y) / radius);
  return {.total_mass = total,
          .eccentricity = share * offset,
          .inertia = spread / (total * radius * radius) + share * offset * offset,
          .mass_ratio = weights / mass,
          .offset_ratio = offset,
          .inertia_factor = spread / (mass * radius * radius),
          .direction = body::angle_of(y, x)};
}

/// The sums of a body that was checked: it is one that reduce_body takes.
inline ReducedBody reduce_checked(const Body& body) {
  const auto sums = reduce_by<double>(body, [](const auto& part, const auto member) { return part.*member; });
  return {.total_mass = sums.total_mass,
          .eccentricity = sums.eccentricity,
          .inertia = sums.inertia,
          .direction = sums.direction,
          .mass_ratio = sums.mass_ratio,
          .offset_ratio = sums.offset_ratio,
          .inertia_factor = sums.inertia_factor};
}

/// A parameter whose unit depends on the hoop's mass and size. For hoops that share its value in the SI, the
/// value in each hoop's own units is proportional to these powers of its mass and size.
struct SameInSi {
  double Design::*parameter;
  double with_mass, with_size;

  double of_hoop(double heavier, double larger) const {
    return std::pow(heavier, with_mass) * std::pow(larger, with_size);
  }
};
inline constexpr std::array same_in_si{SameInSi{&Design::drive_torque, -1.0, -1.0},
                                       SameInSi{&Design::resisting_torque, -1.0, -1.0},
                                       SameInSi{&Design::release_spin, 0.0, 0.5}};

/// Converts parameters of a design to the units of a hoop that is `heavier` and `larger` times the one in
/// whose units they are.
inline void hold_in_si(std::span<const SameInSi> held, double heavier, double larger, Design& design) {
  for (const SameInSi& one : held) design.*one.parameter *= one.of_hoop(heavier, larger);
}

/// The unit of a parameter, if it is held, in the design's own; else 1.
inline double held_unit(std::span<const SameInSi> held, double Design::*parameter, const Design& design) {
  for (const SameInSi& one : held)
    if (one.parameter == parameter) return one.of_hoop(design.mass, design.size);
  return 1.0;
}

/// Gives a design the three ratios.
inline void apply_ratios(const ReducedBody& reduced, Design& design) {
  design.mass_ratio = reduced.mass_ratio;
  design.offset_ratio = reduced.offset_ratio;
  design.inertia_factor = reduced.inertia_factor;
}

/// Gives a design all that follows from a body: the ratios, and its size and mass in those of the nominal
/// one.
inline void follow_body(const Body& body, double nominal_diameter, double nominal_mass, Design& design) {
  const ReducedBody reduced = reduce_checked(body);
  apply_ratios(reduced, design);
  design.size = body.diameter / nominal_diameter, design.mass = reduced.total_mass / nominal_mass;
}

}  // namespace leapmap
