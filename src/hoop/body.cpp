// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "hoop/body.hpp"
#include "leapmap/errors.hpp"

namespace leapmap {
namespace {

[[noreturn]] void refuse(const std::string& key, double value, const std::string& allowed) {
  throw InputError(fmt::format("hoop.{} = {} is out of range; allowed: {}", key, value, allowed));
}

void check(const Body& body) {
  constexpr double largest = 1e6, two_pi = 2.0 * std::numbers::pi;
  if (!(body.diameter >= 2e-9 && body.diameter <= largest))
    refuse("diameter", body.diameter, "a number in [2e-09, 1e+06], in m or as \"... mm\"");
  if (!(body.mass >= 1e-9 && body.mass <= largest))
    refuse("mass", body.mass, "a number in [1e-09, 1e+06], in kg or as \"... g\"");
  if (!std::isnan(body.inertia) && !(body.inertia >= 0.0 && body.inertia <= largest))
    refuse("inertia", body.inertia, "a number in [0, 1e+06], in kg m2 or as \"... g mm2\"");
  const double radius = 0.5 * body.diameter;
  for (const Weight& weight : body.weights) {
    const auto key = [&](const char* part) { return fmt::format("{}.{}", weight.name, part); };
    if (!(weight.mass >= 0.0 && weight.mass <= largest))
      refuse(key("mass"), weight.mass, "a number in [0, 1e+06], in kg or as \"... g\"");
    if (!(weight.at >= 0.0 && weight.at <= radius))
      refuse(key("at"), weight.at,
             fmt::format("a number in [0, {}], up to the radius, in m or as \"... mm\"", radius));
    if (!(std::abs(weight.angle) <= two_pi))
      refuse(key("angle"), weight.angle, "a number in [-2 pi, 2 pi], in rad or as \"... deg\"");
    if (!(weight.inertia >= 0.0 && weight.inertia <= largest))
      refuse(key("inertia"), weight.inertia, "a number in [0, 1e+06], in kg m2 or as \"... g mm2\"");
    if (std::ranges::count(body.weights, weight.name, &Weight::name) > 1)
      throw InputError(fmt::format("hoop.weight: the name '{}' appears twice; allowed: once", weight.name));
  }
}

}  // namespace

ReducedBody reduce_body(const Body& body) {
  check(body);
  const ReducedBody reduced = reduce_checked(body);
  constexpr double most_ratio = 1e12;  // as of a design
  if (!(reduced.mass_ratio <= most_ratio && reduced.inertia_factor <= most_ratio))
    refuse("mass", body.mass, "a mass that is no trillionth of the weights', and of the inertia over R^2");
  return reduced;
}

void apply_body(const ReducedBody& reduced, const Body& body, Design& design, Scene& scene) {
  apply_ratios(reduced, design);
  scene.radius = 0.5 * body.diameter;
  scene.mass = reduced.total_mass;
}

}  // namespace leapmap
