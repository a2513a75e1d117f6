// SPDX-License-Identifier: GPL-3.0-or-later
/// What solves designs, whatever the model and the method, and what it may be asked.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// Solves designs[i] into outcomes[i]. Owns its workspace: one a thread.
using Solver = std::function<void(std::span<const Design> designs, std::span<Outcome> outcomes)>;

/// A solver that takes one design after another, by anything that solves one.
template <class One>
Solver one_by_one(std::shared_ptr<One> one, const Scene& scene) {
  return [one, scene](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) outcomes[i] = one->solve(designs[i], scene);
  };
}

/// Which of an outcome's fields are wanted; the others may be left NaN.
struct Wanted {
  bool first_jump_time = true;
  bool jump_time = true;
  bool descent = true;  ///< flight_time, dip and landing_spin
  bool landing = true;  ///< what is in jump_measures.hpp
};

/// How an integration steps (integration_options.hpp).
struct IntegrationOptions;

/// What studies compare (contestant.hpp).
struct Contestant;
struct Solving;

}  // namespace leapmap
