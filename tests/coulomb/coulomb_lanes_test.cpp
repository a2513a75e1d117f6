// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/coulomb_lanes.hpp"

#include <gtest/gtest.h>

#include "coulomb/coulomb.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

const Scene coulomb = testing::unit_scene(Friction::coulomb);

/// Down ordinary slopes, down slight ones, where hoops rock to rest, and released and driven either way.
std::vector<Design> designs_of_three_kinds(std::size_t count) {
  std::mt19937_64 random(7);
  const auto uniform = [&](double from, double to) { return testing::uniform(random, from, to); };
  std::vector<Design> designs(count);
  for (std::size_t i = 0; i < count; ++i) {
    Design& design = designs[i];
    design.slope = i % 3 == 1 ? uniform(0.02, 0.15) : uniform(0.1, 0.8);
    design.mass_ratio = uniform(0.5, 10.0), design.offset_ratio = uniform(0.3, 1.0);
    design.mu_static = uniform(0.1, 1.0);
    if (i % 3 != 2) continue;
    design.release_angle = uniform(0.0, 6.28), design.release_spin = uniform(-2.0, 2.0);
    design.drive_torque = uniform(-0.3, 0.3), design.restitution = uniform(0.0, 0.9);
    design.mu_kinetic = design.mu_static * uniform(0.6, 1.0);
    design.inertia_factor = uniform(0.5, 1.0);
  }
  return designs;
}

TEST(CoulombLanes, FindWhatOneDesignAtATimeFinds) {
  const std::vector<Design> designs = designs_of_three_kinds(6'000);
  std::vector<Outcome> together(designs.size());
  const double tolerance = 1e-9;
  CoulombLanes<Batch>(tolerance).solve(designs, coulomb, together);
  CoulombSolver<double> solver(tolerance);
  int jumped = 0, other_phases = 0;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Outcome alone = solver.solve(designs[i], coulomb);
    if (alone.phase_sequence != together[i].phase_sequence) {  // a phase as short as roundings
      ++other_phases;
      continue;
    }
    ASSERT_EQ(alone.status, together[i].status) << i;
    ASSERT_EQ(alone.candidates, together[i].candidates) << i;
    ASSERT_EQ(alone.spurious_first_jump, together[i].spurious_first_jump) << i;
    if (alone.status != Status::jumped) continue;
    ++jumped;
    // Ten times the tolerance, as errors of many phases add up.
    EXPECT_NEAR(alone.jump_height, together[i].jump_height, 10 * tolerance) << i;
    EXPECT_NEAR(alone.jump_time / together[i].jump_time, 1.0, 10 * tolerance) << i;
    EXPECT_NEAR(alone.slip_distance, together[i].slip_distance, 10 * tolerance * (1.0 + alone.slip_distance))
        << i;
    EXPECT_NEAR(alone.energy_lost, together[i].energy_lost, 10 * tolerance * (1.0 + alone.energy_lost)) << i;
  }
  EXPECT_GT(jumped, 2'000);
  EXPECT_LE(other_phases, 3);
}

TEST(CoulombLanes, AnOutcomeDependsOnTheDesignAlone) {
  const std::vector<Design> designs = designs_of_three_kinds(300);
  std::vector<Outcome> together(designs.size());
  CoulombLanes<Batch> lanes(1e-9);
  lanes.solve(designs, coulomb, together);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    Outcome alone;
    lanes.solve({&designs[i], 1}, coulomb, {&alone, 1});
    EXPECT_EQ(alone.phase_sequence, together[i].phase_sequence) << i;
    EXPECT_EQ(alone.status, together[i].status) << i;
    for (const double Outcome::*field :
         {&Outcome::jump_height, &Outcome::jump_time, &Outcome::jump_angle, &Outcome::jump_spin,
          &Outcome::flight_time, &Outcome::slip_distance, &Outcome::energy_lost})
      EXPECT_TRUE(alone.*field == together[i].*field ||
                  (std::isnan(alone.*field) && std::isnan(together[i].*field)))
          << i;
  }
}

}  // namespace
}  // namespace leapmap
