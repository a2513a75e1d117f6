// SPDX-License-Identifier: GPL-3.0-or-later
/// A plausible scatter, and what a map tells of hoops as made.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "leapmap/units.hpp"
#include "request/solver.hpp"

namespace leapmap::testing {

inline Scatter plausible() {
  using enum Spread::Law;
  return {{{"slope", normal, degrees(1.5)},
           {"mass_ratio", normal, 4.0, true},
           {"release_angle", uniform, degrees(4.0)}}};
}

inline Spec scattered(Friction friction = Friction::sticking) {
  Spec spec;
  spec.scene.friction = friction;
  spec.scatter = plausible();
  if (friction == Friction::coulomb)
    spec.scatter.spreads.push_back({"mu_static", Spread::Law::normal, 10.0, true});
  spec.goals = {{.field = "jump_height", .at_least = 0.3}, {.field = "jump_time", .at_most = 0.9}};
  spec.numerics.audit = 0.0;
  return spec;
}

/// The map's columns of some designs, by name.
inline std::map<std::string, std::vector<double>> columns_of(Spec spec, const std::vector<Design>& designs) {
  for (const char* error :
       {"jump_height_mean_error", "jump_height_q05_error", "jump_height_q50_error", "jump_height_q95_error"})
    spec.output.fields.emplace_back(error);
  spec.output.fields.emplace_back("jump_height");
  const Request request = request_of(spec);
  MadeColumns columns(statistics_of(request));
  scatter_solver_of(request, points_of(spec.scatter)).solve(designs, columns);
  std::map<std::string, std::vector<double>> found;
  for (const Field* field : columns.fields()) {
    const auto values = columns.column(*field);
    found[std::string(field->name)] = {values.begin(), values.end()};
  }
  return found;
}

}  // namespace leapmap::testing
