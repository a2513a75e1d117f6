// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/way.hpp"

#include <memory>

#include "noslip/exact.hpp"
#include "noslip/model.hpp"

namespace leapmap::noslip {

JumpSolver<double> ways(const Scene& scene, double tolerance) {
  const Wanted untimed{.first_jump_time = false, .jump_time = false};
  return [scene, solver = std::make_shared<ExactSolver<double>>(tolerance, untimed)](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const ContactState<double> from = states[i];
      FoundLiftOffs found;
      solver->solve(start, {&designs[i], 1}, {&states[i], 1}, scene, {&outcomes[i], 1}, &found);
      if (outcomes[i].status != Status::jumped) continue;
      const Roll<double> roll = begin_roll(reduce<double>(designs[i], scene), from.angle, from.spin);
      put_way(way_to(roll, from.spin, found, found.lift_offs.back().angle),
              [&](double Outcome::*kept, double number) { outcomes[i].*kept = number; });
    }
  };
}

}  // namespace leapmap::noslip
