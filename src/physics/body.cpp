// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "leapmap/errors.hpp"

namespace leapmap {
namespace {

[[noreturn]] void refuse(const std::string& key, double value, const std::string& allowed) {
  throw InputError(fmt::format("hoop.{} = {} is out of range; allowed: {}", key, value, allowed));
}

void check(const Body& body) {
  constexpr double largest = 1e6, turn = 2.0 * std::numbers::pi;
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
    if (!(std::abs(weight.angle) <= turn))
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
  const double radius = 0.5 * body.diameter;
  double weights = 0.0, x = 0.0, y = 0.0;
  for (const Weight& weight : body.weights) {
    weights += weight.mass;
    x += weight.mass * weight.at * std::cos(weight.angle),
        y += weight.mass * weight.at * std::sin(weight.angle);
  }
  if (weights > 0.0) x /= weights, y /= weights;
  // About the weights' common centre no two terms cancel.
  double spread = std::isnan(body.inertia) ? body.mass * radius * radius : body.inertia;
  for (const Weight& weight : body.weights) {
    const double dx = weight.at * std::cos(weight.angle) - x, dy = weight.at * std::sin(weight.angle) - y;
    spread += weight.inertia + weight.mass * (dx * dx + dy * dy);
  }
  const double total = body.mass + weights, offset = std::min(std::hypot(x, y) / radius, 1.0);
  const double share = weights / total, own = spread / (body.mass * radius * radius);
  constexpr double most_ratio = 1e12;  // as of a design
  if (!(weights / body.mass <= most_ratio && own <= most_ratio))
    refuse("mass", body.mass, "a mass that is no trillionth of the weights', and of the inertia over R^2");
  return {.total_mass = total,
          .eccentricity = share * offset,
          .inertia = spread / (total * radius * radius) + share * offset * offset,
          .mass_ratio = weights / body.mass,
          .offset_ratio = offset,
          .inertia_factor = own};
}

void apply_body(const ReducedBody& reduced, const Body& body, Design& design, Scene& scene) {
  design.mass_ratio = reduced.mass_ratio;
  design.offset_ratio = reduced.offset_ratio;
  design.inertia_factor = reduced.inertia_factor;
  scene.radius = 0.5 * body.diameter;
  scene.mass = reduced.total_mass;
}

}  // namespace leapmap
