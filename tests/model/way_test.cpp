// SPDX-License-Identifier: GPL-3.0-or-later
/// What the way to a jump asks of hoop and motor, against fine traces and against the referee.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "leapmap/gradient.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/trace.hpp"
#include "model/model.hpp"
#include "referee/referee.hpp"
#include "request/solver.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"
#include "support/differences.hpp"

namespace leapmap {
namespace {

using testing::uniform;

class Ways : public ::testing::TestWithParam<Friction> {};
INSTANTIATE_TEST_SUITE_P(BothModels, Ways, ::testing::Values(Friction::sticking, Friction::coulomb),
                         [](const auto& model) { return std::string(model_of(model.param).name); });

Design driven_design(std::mt19937_64& random, Friction friction) {
  Design design = testing::either_way(random, friction);
  if (random() % 2 == 0) design.drive_torque = uniform(random, -0.8, 0.8);
  if (random() % 3 == 0) design.release_spin = 0.0;
  return design;
}

/// Never below a fine trace, and no more above it than what lies between two of its samples.
TEST_P(Ways, HaveTheMaximaThatAFineTraceComesNearTo) {
  std::mt19937_64 random(60);
  const Scene scene = testing::unit_scene(GetParam());
  int jumps = 0;
  for (int i = 0; i < 14; ++i) {
    const Design design = driven_design(random, GetParam());
    const Outcome o = solve(design, scene);
    if (o.status != Status::jumped || o.jump_time > 60.0) continue;
    ++jumps;
    constexpr double interval = 1e-3;
    double force = 0.0, spin = 0.0, power = -HUGE_VAL;
    double steepest = 0.0, before = 0.0;  // how much the force changes from sample to sample
    for (const MotionPoint& at : trace(design, scene, {.interval = interval}).points) {
      if (at.t > o.jump_time) break;
      spin = std::max(spin, std::abs(at.spin)), power = std::max(power, design.drive_torque * at.spin);
      if (at.phase == Phase::flight) continue;
      force = std::max(force, at.normal_force);
      steepest = std::max(steepest, std::abs(at.normal_force - before)), before = at.normal_force;
    }
    ASSERT_GE(o.max_normal_force, force * (1.0 - 1e-13)) << i;
    ASSERT_GE(o.motor_max_spin, spin * (1.0 - 1e-13)) << i;
    ASSERT_LE(o.max_normal_force, force + steepest) << i;
    ASSERT_LE(o.motor_max_spin, spin * (1.0 + 20.0 * interval) + 20.0 * interval) << i;
    if (design.drive_torque == 0.0) {
      ASSERT_EQ(o.motor_energy, 0.0);
      ASSERT_EQ(o.motor_max_power, 0.0);
    } else {
      ASSERT_GE(o.motor_max_power, power - 1e-13 * std::abs(power)) << i;
      ASSERT_LE(o.motor_max_power, power + 40.0 * interval) << i;
    }
  }
  EXPECT_GT(jumps, 3);
}

/// The largest force is 6.5 ms after the release, where the spin has no rate by the angle.
TEST(WaysFromRest, HaveTheMaximumJustAfterTheRelease) {
  Scene scene;
  scene.hop_height = 0.0, scene.runway = 8.0;
  const Design design{.slope = 0.5929345339421771,
                      .mass_ratio = 16.66888738301438,
                      .offset_ratio = 0.9795358578478384,
                      .inertia_factor = 0.5364811938311462,
                      .release_angle = 0.31380181583088884,
                      .drive_torque = 0.3987155562627727};
  double force = 0.0;
  for (const MotionPoint& at : trace(design, scene, {.interval = 1e-5}).points)
    if (at.t < 0.02) force = std::max(force, at.normal_force);
  const Outcome o = solve(design, scene);
  EXPECT_GE(o.max_normal_force, force * (1.0 - 1e-14));
  EXPECT_NEAR(o.max_normal_force, force, 1e-8);  // quadratic in what lies between two samples
  const double h = 1e-5;
  Design above = design, below = design;
  above.release_angle += h, below.release_angle -= h;
  const double difference =
      (solve(above, scene).max_normal_force - solve(below, scene).max_normal_force) / (2.0 * h);
  EXPECT_NEAR(gradient(design, &Outcome::max_normal_force, scene).release_angle, difference, 1e-6);
}

/// Of later jumps: never below a fine trace from the landing before, and hardly above it; and walls that they
/// clear, as a jump of that flight alone does.
TEST_P(Ways, OfLaterJumpsBeginAtTheLandingBefore) {
  std::mt19937_64 random(63);
  Spec spec;
  spec.scene = testing::unit_scene(GetParam());
  spec.scene.jumps = 4, spec.scene.clear_height = 0.02;
  for (const Field* field : fields_of(spec.scene)) spec.output.fields.emplace_back(field->name);
  const Solver solver = make_solver(request_of(spec));
  int later = 0;
  for (int i = 0; i < 200 && later < 20; ++i) {
    const Design design = driven_design(random, GetParam());
    Outcome o;
    solver({&design, 1}, {&o, 1});
    if (o.later_jumps.empty() || o.later_jumps.back().time > 80.0) continue;
    constexpr double interval = 1e-3;
    const Motion motion = trace(design, spec.scene, {.interval = interval});
    double landed = o.jump_time + o.flight_time;
    for (const Jump& jump : o.later_jumps) {
      const double begins = std::exchange(landed, jump.time + jump.flight_time);
      if (jump.time - begins < 20.0 * interval) continue;  // too short for the trace to show
      double force = 0.0, spin = 0.0, steepest = 0.0, before = 0.0;
      for (const MotionPoint& at : motion.points) {
        if (at.t < begins + 1e-9 || at.t > jump.time) continue;
        spin = std::max(spin, std::abs(at.spin));
        if (at.phase == Phase::flight) continue;
        force = std::max(force, at.normal_force);
        if (before > 0.0) steepest = std::max(steepest, std::abs(at.normal_force - before));
        before = at.normal_force;
      }
      ASSERT_GE(jump.max_normal_force, force * (1.0 - 1e-12)) << i;
      ASSERT_GE(jump.motor_max_spin, spin * (1.0 - 1e-12)) << i;
      // A way may begin with its largest force, between two samples.
      ASSERT_LE(jump.max_normal_force, force + 3.0 * steepest + 1e-9) << i;
      ASSERT_LE(jump.motor_max_spin, spin * (1.0 + 20.0 * interval) + 20.0 * interval) << i;
      ASSERT_EQ(std::isnan(jump.clears_from), !(jump.clears_from <= jump.clears_to));
      ASSERT_LE(jump.landing_normal_speed, 4.0 * std::sqrt(1.0 + jump.height) + jump.motor_max_spin);
      if (jump.height < spec.scene.clear_height) {
        ASSERT_TRUE(std::isnan(jump.clears_from));
      }
      ++later;
    }
  }
  EXPECT_GE(later, 20);
}

/// By integration in three coordinates, which shares no formula with them.
TEST_P(Ways, AreTheRefereesToo) {
  std::mt19937_64 random(61);
  const Scene scene = testing::unit_scene(GetParam());
  referee::Referee referee(scene, 1e-14);
  referee.meets_forces = true;
  const std::size_t count = testing::how_many(16);
  std::size_t jumps = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Design design = driven_design(random, GetParam());
    const Outcome o = solve(design, scene), judged = referee.solve(design);
    if (o.status != Status::jumped || !same_flags(o, judged)) continue;
    ++jumps;
    // What an integration's error of 1e-14 grows to on the way: to 8e-12 in 10,000 designs.
    const double grown = 1e-10 * (1.0 + o.motor_max_spin);
    EXPECT_NEAR(o.max_normal_force, judged.max_normal_force, grown * (1.0 + o.max_normal_force)) << i;
    EXPECT_NEAR(o.motor_max_spin, judged.motor_max_spin, grown) << i;
    if (design.drive_torque == 0.0) continue;
    EXPECT_NEAR(o.motor_max_power, judged.motor_max_power, grown) << i;
    if (GetParam() == Friction::coulomb) {
      EXPECT_NEAR(o.motor_energy, judged.motor_energy, grown * (1.0 + std::abs(o.motor_energy))) << i;
    } else {
      EXPECT_NEAR(o.motor_energy, design.drive_torque * (o.jump_angle - design.release_angle),
                  1e-12 * (1.0 + std::abs(o.motor_energy)))
          << i;
    }
  }
  EXPECT_GT(jumps, count / 4);
}

/// Derivatives of ways and of clearances against central differences of the numbers themselves.
TEST_P(Ways, HaveTheDerivativesThatDifferencesShow) {
  std::mt19937_64 random(62);
  Scene scene = testing::unit_scene(GetParam());
  scene.clear_height = 0.03;
  const std::size_t count = testing::how_many(60);
  std::vector<Design> designs;
  for (std::size_t i = 0; i < count; ++i) designs.push_back(driven_design(random, GetParam()));
  std::vector<const Field*> fields;
  std::vector<std::vector<Design>> found;
  for (const Field& field : map_fields())
    if ((field.of_way || field.of_wall) && has(scene, field)) {
      fields.push_back(&field);
      found.push_back(gradient(designs, *number_of(field), scene));
    }
  ASSERT_EQ(fields.size(), 6u);
  std::vector<std::size_t> compared(fields.size()), missing(fields.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Outcome own = solve(designs[i], scene);
    if (own.status != Status::jumped) continue;
    for (double Design::*by : differentiable) {
      if (std::isnan(designs[i].*by) || (by == &Design::mu_kinetic && kinetic_follows(designs[i]))) continue;
      const double h = 1e-5 * std::max(1.0, std::abs(designs[i].*by));
      std::array<Outcome, 4> beside;
      bool alike = !(by == &Design::drive_torque && designs[i].drive_torque == 0.0);  // there ways have kinks
      for (int k = 0; k < 4 && alike; ++k) {
        Design moved = designs[i];
        if (kinetic_follows(moved)) moved.mu_kinetic = std::numeric_limits<double>::quiet_NaN();
        moved.*by += (k % 2 == 0 ? h : -h) * (k < 2 ? 1.0 : 2.0);
        const bool kink = !std::isnan(moved.mu_kinetic) && moved.mu_static < moved.mu_kinetic;
        alike = is_allowed(moved, scene) && !kink;
        if (alike) beside[static_cast<std::size_t>(k)] = solve(moved, scene);
        alike = alike && same_flags(beside[static_cast<std::size_t>(k)], own);
      }
      if (!alike) continue;
      for (std::size_t f = 0; f < fields.size(); ++f) {
        const testing::Difference at = testing::difference_of(*number_of(*fields[f]), beside, h);
        if (std::isnan(at.truth) || !(at.doubt < 1e-4 * (1.0 + std::abs(at.truth)))) continue;
        const double ours = found[f][i].*by;
        ++compared[f], missing[f] += std::isnan(ours);
        if (std::isnan(ours)) continue;
        // Roundings of values over the step, 1e-13 / 1e-5, and a hundred times that on long ways.
        EXPECT_NEAR(ours, at.truth, std::max(2.0 * at.doubt, 1e-6 * (1.0 + std::abs(at.truth))))
            << fields[f]->name << " of " << i << " by parameter "
            << std::ranges::find(differentiable, by) - differentiable.begin();
      }
    }
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    EXPECT_GT(compared[f], count / 2) << fields[f]->name;
    EXPECT_LE(missing[f], compared[f] / 100) << fields[f]->name;
  }
}

}  // namespace
}  // namespace leapmap
