// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/coulomb_lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "friction/coulomb.hpp"
#include "hoop/sliding.hpp"
#include "support/aimed.hpp"
#include "support/exact.hpp"

namespace leapmap {
namespace {

using testing::coulomb;

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

/// A hoop released so fast that the plane carries but a share `left` of its weight while it slides.
std::optional<Design> about_to_lift_off(std::mt19937_64& random, double left) {
  Design design = testing::either_way(random);
  design.mu_static = testing::uniform(random, 0.05, 0.9);
  const Hoop<double> hoop = reduce<double>(design);
  const Trig<double> phi = trig(design.release_angle);
  const double at_rest = free_normal_force(hoop, phi, 0.0),
               by_spin = free_normal_force(hoop, phi, 1.0) - at_rest;
  const double spin_squared = (left - at_rest) / by_spin;
  if (!(spin_squared > 0.0 && spin_squared < 100.0)) return {};
  design.release_spin = std::copysign(std::sqrt(spin_squared), design.release_spin);
  return design;
}

/// The first panel of a slide is as long as any: where an event came right after the release, its time had
/// the digits of the whole panel, and few of its own.
TEST(CoulombLanes, JumpsOfDesignsOnTheirOwnAreThoseInRoundsToTheLastBit) {
  const std::vector<Design> designs = designs_of_three_kinds(200);
  constexpr int most_jumps = 12;
  struct Followed {
    std::vector<Outcome> ends;
    std::vector<ContactState<double>> states;
    std::vector<int> jumps;
  };
  const auto follow = [&](const LongJumpSolver<double>& solver) {
    Followed told{std::vector<Outcome>(designs.size()), {}, std::vector<int>(designs.size())};
    for (const Design& design : designs) told.states.push_back(released<double>(design));
    solver(Start::release, designs, told.states, told.ends, [&](std::size_t i) {
      told.states[i] = reduced(told.states[i]);
      return ++told.jumps[i] < most_jumps;
    });
    return told;
  };
  const auto lanes = std::make_shared<CoulombLanes<Batch>>(1e-9);
  const Followed alone = follow([&](Start start, auto of, auto states, auto outcomes, const GoesOn& goes_on) {
    lanes->solve(start, of, states, coulomb, outcomes, goes_on);
  });
  const Followed together = follow(in_rounds([&](Start start, auto of, auto states, auto outcomes) {
    lanes->solve(start, of, states, coulomb, outcomes);
  }));
  EXPECT_EQ(alone.jumps, together.jumps);
  EXPECT_GT(std::ranges::count(alone.jumps, most_jumps), 20);
  EXPECT_LT(std::ranges::count(alone.jumps, most_jumps), 180);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    EXPECT_EQ(alone.ends[i].status, together.ends[i].status) << i;
    if (alone.ends[i].status != Status::jumped) continue;
    EXPECT_EQ(alone.states[i].angle, together.states[i].angle) << i;
    EXPECT_EQ(alone.states[i].spin, together.states[i].spin) << i;
    EXPECT_EQ(alone.states[i].slip, together.states[i].slip) << i;
    EXPECT_EQ(alone.ends[i].jump_height, together.ends[i].jump_height) << i;
  }
}

TEST(CoulombLanes, WithoutTimesFindTheSameJumps) {
  const std::vector<Design> designs = designs_of_three_kinds(300);
  constexpr double tolerance = 1e-10;
  std::vector<Outcome> timed(designs.size()), untimed(designs.size());
  CoulombLanes<Batch>(tolerance).solve(designs, coulomb, timed);
  CoulombLanes<Batch>(tolerance, {.first_jump_time = false, .jump_time = false})
      .solve(designs, coulomb, untimed);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    ASSERT_TRUE(same_flags(timed[i], untimed[i])) << i;
    EXPECT_TRUE(std::isnan(untimed[i].jump_time) && std::isnan(untimed[i].first_jump_time)) << i;
    if (timed[i].status != Status::jumped) continue;
    EXPECT_GT(timed[i].jump_time, 0.0) << i;
    // The time before a slide decides on which of its panels its end is located.
    EXPECT_NEAR(untimed[i].jump_height, timed[i].jump_height, 10.0 * tolerance) << i;
    EXPECT_NEAR(untimed[i].jump_distance, timed[i].jump_distance,
                10.0 * tolerance * std::abs(timed[i].jump_distance))
        << i;
    EXPECT_NEAR(untimed[i].flight_time, timed[i].flight_time, 10.0 * tolerance * timed[i].flight_time) << i;
    EXPECT_NEAR(untimed[i].landing_impulse, timed[i].landing_impulse, 100.0 * tolerance) << i;
    EXPECT_NEAR(untimed[i].slip_distance, timed[i].slip_distance,
                100.0 * tolerance * (1.0 + timed[i].slip_distance))
        << i;
  }
}

TEST(CoulombLanes, FindTheSameJumpsWhateverOfTheLandingIsWanted) {
  std::vector<Design> designs = designs_of_three_kinds(600);
  for (std::size_t i = 0; i < designs.size(); i += 3) designs[i].drive_torque = 0.01;
  for (std::size_t i = 0; i < designs.size(); i += 5) designs[i].restitution = 0.4;
  for (const double hop_height : {1e-3, 0.1}) {  // hoops land from lift-offs below it
    const Scene scene{.friction = Friction::coulomb, .hop_height = hop_height};
    std::vector<Outcome> whole(designs.size()), shorter(designs.size()), measured(designs.size());
    CoulombLanes<Batch>(1e-9).solve(designs, scene, whole);
    CoulombLanes<Batch>(1e-9, {.descent = false, .landing = false}).solve(designs, scene, shorter);
    CoulombLanes<Batch>(1e-9, {.descent = false}).solve(designs, scene, measured);
    int jumped = 0, after_others = 0;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      ASSERT_TRUE(same_flags(whole[i], shorter[i]) && same_flags(whole[i], measured[i])) << i;
      EXPECT_TRUE(std::isnan(shorter[i].flight_time) && std::isnan(shorter[i].dip)) << i;
      EXPECT_TRUE(std::isnan(shorter[i].landing_impulse) && std::isnan(shorter[i].landing_spin)) << i;
      EXPECT_TRUE(std::isnan(measured[i].dip)) << i;
      if (whole[i].status != Status::jumped) continue;
      ++jumped, after_others += whole[i].candidates > 1;
      for (double Outcome::*const number :
           {&Outcome::jump_height, &Outcome::jump_time, &Outcome::jump_angle, &Outcome::jump_spin,
            &Outcome::jump_distance, &Outcome::apex_time, &Outcome::energy_lost, &Outcome::slip_distance})
        EXPECT_EQ(shorter[i].*number, whole[i].*number) << i;
      for (double Outcome::*const number :
           {&Outcome::jump_height, &Outcome::flight_time, &Outcome::landing_impulse, &Outcome::landing_spin})
        EXPECT_EQ(measured[i].*number, whole[i].*number) << i;
    }
    EXPECT_GT(jumped, 100) << hop_height;
    EXPECT_GT(after_others, 10) << hop_height;
  }
}

TEST(CoulombLanes, AnExceptionLeavesNothingToTheNextCall) {
  const std::vector<Design> designs = designs_of_three_kinds(300);
  std::vector<Outcome> right(designs.size()), told(designs.size());
  CoulombLanes<Batch>(1e-9).solve(designs, coulomb, right);
  CoulombLanes<Batch> lanes(1e-9);
  std::vector<ContactState<double>> states;
  for (const Design& design : designs) states.push_back(released<double>(design));
  int jumps = 0;
  const GoesOn throws = [&](std::size_t) { return ++jumps < 40 ? true : throw std::runtime_error("enough"); };
  EXPECT_THROW(lanes.solve(Start::release, designs, states, coulomb, told, throws), std::runtime_error);
  lanes.solve(designs, coulomb, told);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    EXPECT_TRUE(same_flags(told[i], right[i])) << i;
    if (right[i].status != Status::jumped) continue;
    EXPECT_EQ(told[i].jump_height, right[i].jump_height) << i;
  }
}

TEST(CoulombLanes, ShortContactsHaveTheDigitsThatAreAskedFor) {
  constexpr double tolerance = 1e-10;
  CoulombLanes<Batch> lanes(tolerance);
  CoulombSolver<double> one_by_one(tolerance);
  CoulombSolver<long double> reference(1e-15);
  std::mt19937_64 random(43287);
  std::size_t compared = 0;
  for (const std::size_t most = testing::how_many(1'200); compared < most;) {
    const double left = std::pow(10.0, testing::uniform(random, -8.0, -1.0));
    const auto design = about_to_lift_off(random, left);
    if (!design) continue;
    const double time = static_cast<double>(reference.solve(*design, coulomb).first_jump_time);
    if (!(time > 0.0 && time < 0.1)) continue;
    Outcome together;
    lanes.solve({&*design, 1}, coulomb, {&together, 1});
    const Outcome alone = one_by_one.solve(*design, coulomb);
    ++compared;
    // What is left of the force is known to some roundings of the weight and of what the spin takes of it.
    const double spin_squared = design->release_spin * design->release_spin;
    const double allowed = tolerance + 2e-15 * (1.0 + spin_squared) / left;
    EXPECT_NEAR(together.first_jump_time / time, 1.0, allowed) << testing::told(*design);
    EXPECT_NEAR(alone.first_jump_time / time, 1.0, allowed) << testing::told(*design);
  }
}

}  // namespace
}  // namespace leapmap
