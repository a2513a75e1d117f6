// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/way.hpp"

#include <memory>

#include "rolling/exact.hpp"
#include "rolling/model.hpp"

namespace leapmap::rolling {

Solver ways(const Scene& scene, double tolerance) {
  const Wanted flags{.first_jump_time = false, .jump_time = false, .descent = false, .landing = false};
  return [scene, solver = std::make_shared<ExactSolver<double>>(tolerance, flags)](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      if (outcomes[i].status != Status::jumped) continue;
      FoundLiftOffs told;
      Outcome again;
      solver->solve({&designs[i], 1}, scene, {&again, 1}, &told);
      if (!same_flags(again, outcomes[i])) continue;
      const Design& design = designs[i];
      const Roll<double> roll =
          begin_roll(reduce<double>(design, scene), design.release_angle, design.release_spin);
      put_way(way_to(roll, design.release_spin, told, told.lift_offs.back().angle),
              [&](double Outcome::*kept, double number) { outcomes[i].*kept = number; });
    }
  };
}

}  // namespace leapmap::rolling
