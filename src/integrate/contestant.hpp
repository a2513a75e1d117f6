// SPDX-License-Identifier: GPL-3.0-or-later
/// What the studies compare: methods at settings, on models, each able to solve designs.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "integrate/integration_options.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// What is solved, from the least to the most. Multipliers: the paper's x, y and phi by (7) to (9); at the
/// centre of mass: the same for the centre of mass's coordinates, where the constraints are curved;
/// projected: every step is moved back onto the constraints.
enum class RollingModel {
  energy_integral,
  one_coordinate,
  multipliers,
  multipliers_projected,
  centre_of_mass,
  centre_of_mass_projected
};

/// As written in tables, for example "one coordinate".
std::string_view name_of(RollingModel model);

/// One method at one setting.
struct Contestant {
  std::string method;       ///< "exact", "gsl-rk8pd", "semi-implicit-euler", ...
  bool fixed_step = false;  ///< setting is the step [sqrt(R/g)]; else the tolerance
  double setting = 0.0;
  int order = 0;  ///< theoretical, of the error at fixed steps; 0: it varies or does not apply
  RollingModel model = RollingModel::one_coordinate;  ///< energy_integral for exact, and only for exact

  /// True if only the setting differs.
  bool same_series(const Contestant& other) const {
    return method == other.method && fixed_step == other.fixed_step && model == other.model;
  }
};

/// A method's workspace for one scene: solves designs, and counts what it asks of the acceleration. One
/// thread.
struct Solving {
  std::function<void(std::span<const Design>, std::span<Outcome>)> solve;
  std::function<long()> evaluations;  ///< so far; unset: it integrates nothing
  /// How far the constraints are violated on the way to the outcome, at the worst step; unset: there are
  /// none.
  std::function<double(const Design&)> drift;
};

/// How a contestant that integrates in time does so. max_steps: a design that needs more is given up as
/// failed.
IntegrationOptions options_of(const Contestant& contestant, long max_steps);

}  // namespace leapmap
