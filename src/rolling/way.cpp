// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/way.hpp"

#include "rolling/exact.hpp"
#include "rolling/model.hpp"

namespace leapmap::rolling {
namespace {

/// Every leg up to the last lift-off: the same functions of the angle whichever way the hoop rolls.
Way way_of(const Design& design, const Scene& scene, const FoundLiftOffs& told) {
  const Hoop<double> hoop = reduce<double>(design, scene);
  const Roll<double> roll = begin_roll(hoop, design.release_angle, design.release_spin);
  WayMeter meter(hoop);
  double from = design.release_angle;
  for (std::size_t k = 0; k < told.legs.back(); ++k)
    meter.roll(roll, std::exchange(from, told.turns[k]), told.turns[k]);
  meter.roll(roll, from, told.lift_offs.back().angle);
  return meter.way();
}

}  // namespace

Solver ways(const Scene& scene, double tolerance) {
  const Wanted flags{.first_jump_time = false, .jump_time = false, .descent = false, .landing = false};
  return [scene, solver = std::make_shared<ExactSolver<double>>(tolerance, flags)](
             std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      if (outcomes[i].status != Status::jumped) continue;
      FoundLiftOffs told;
      Outcome again;
      solver->solve({&designs[i], 1}, scene, {&again, 1}, &told);
      if (same_flags(again, outcomes[i])) keep(way_of(designs[i], scene, told), outcomes[i]);
    }
  };
}

}  // namespace leapmap::rolling
