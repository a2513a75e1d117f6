// SPDX-License-Identifier: GPL-3.0-or-later
/// The exact solver against tables, against itself in wider arithmetic, and against integration.
#include "noslip/exact.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <bit>
#include <memory>
#include <mutex>

#include "engine/parallel.hpp"
#include "support/designs.hpp"
#include "support/exact.hpp"
#include "support/reference_table.hpp"

namespace leapmap {
namespace {

using testing::reference, testing::relative, testing::solve_all, testing::told, testing::wild_designs;

#ifdef NDEBUG
constexpr int many = 100'000;
#else
constexpr int many = 4'000;  // under sanitizers
#endif

template <class T>
class Exact : public ::testing::Test {};
using Scalars = ::testing::Types<double, Batch>;
TYPED_TEST_SUITE(Exact, Scalars);

TYPED_TEST(Exact, EqualsThe40DigitTablesAtItsDefaultTolerance) {
  for (const std::string table :
       {"noslip_top_release.csv", "noslip_general.csv", "noslip_turning.csv", "noslip_drive.csv"}) {
    const auto rows = testing::read_reference(table);
    std::vector<Design> designs;
    for (const auto& row : rows) designs.push_back(row.design());
    const auto outcomes = solve_all<TypeParam>(designs, testing::idle_scene(), 1e-10);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& row = rows[i];
      const Outcome& o = outcomes[i];
      const std::string where = table + " row " + std::to_string(i + 1);
      EXPECT_EQ(name_of(o.status), row.cells.at("status")) << where;
      EXPECT_EQ(o.spurious_first_jump, row.has("spurious") ? row.number("spurious") : 255) << where;
      if (row.has("candidates")) {
        EXPECT_EQ(o.candidates, row.number("candidates")) << where;
      }
      // Measured 1e-15 for heights and flights, 8e-14 for times at this tolerance.
      const auto check = [&](const std::string& name, double value, bool is_relative) {
        if (!row.has(name)) {
          EXPECT_TRUE(std::isnan(value)) << where << " " << name;
          return;
        }
        const double truth = row.number(name);
        EXPECT_NEAR(value, truth, 1e-12 * (is_relative ? std::abs(truth) : 1.0)) << where << " " << name;
      };
      check("jump_height", o.jump_height, false);
      check("first_jump_height", o.first_jump_height, false);
      check("dip", o.dip, false);
      check("jump_time", o.jump_time, true);
      check("first_jump_time", o.first_jump_time, true);
      check("apex_time", o.apex_time, true);
      check("flight_time", o.flight_time, true);
      check("jump_angle", o.jump_angle, true);
      check("jump_spin", o.jump_spin, true);
    }
  }
}

TYPED_TEST(Exact, IsAsGoodAsItsInputsOnStressedDesigns) {
  const auto rows = testing::read_reference("noslip_stress.csv");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Design design = rows[i].design();
    std::vector<Design> nudged{design};
    for (const auto member : {&Design::slope, &Design::mass_ratio, &Design::offset_ratio,
                              &Design::inertia_factor, &Design::release_angle, &Design::release_spin})
      for (const double towards : {-10.0, 1e30}) {
        Design d = design;
        d.*member = std::nextafter(d.*member, towards);
        if (d.offset_ratio <= 1.0 && d.release_spin >= 0.0) nudged.push_back(d);
      }
    const auto truths = reference(nudged, testing::unit_scene());
    const Outcome ours = solve_all<TypeParam>({design}, testing::unit_scene(), 1e-12)[0];
    EXPECT_EQ(name_of(ours.status), rows[i].cells.at("status")) << i;
    EXPECT_EQ(ours.candidates, rows[i].has("candidates") ? rows[i].number("candidates") : ours.candidates)
        << i;
    EXPECT_EQ(ours.spurious_first_jump, rows[i].has("spurious") ? rows[i].number("spurious") : 255) << i;
    // What one unit in the last place of an input changes, times 10; the lift-off's
    // angle, about 10, is itself a double whose last place is 1e-15.
    const auto check = [&](const std::string& name, double Outcome::*member) {
      if (!rows[i].has(name)) return;
      double ulp = 0.0;
      for (const Outcome& truth : truths) ulp = std::max(ulp, relative(truth.*member, truths[0].*member));
      EXPECT_LE(relative(ours.*member, rows[i].number(name)), 10.0 * std::max(ulp, 1e-15))
          << name << " row " << i + 1;
    };
    check("jump_height", &Outcome::jump_height);
    check("jump_time", &Outcome::jump_time);
    check("first_jump_time", &Outcome::first_jump_time);
    check("apex_time", &Outcome::apex_time);
    check("flight_time", &Outcome::flight_time);
  }
}

TYPED_TEST(Exact, KeepsItsToleranceOnWildDesigns) {
  const auto designs = wild_designs(2000, 21);
  Scene scene;
  scene.runway = 4.0;
  const auto truths = reference(designs, scene);
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const auto outcomes = solve_all<TypeParam>(designs, scene, tolerance);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      ASSERT_TRUE(same_flags(outcomes[i], truths[i])) << told(designs[i]);
      // Times also feel what a rounding of the input does where the hoop sets out a hair from an equilibrium.
      const double roll_allowed = std::max(tolerance, 1e-11);
      EXPECT_LE(relative(outcomes[i].jump_time, truths[i].jump_time), roll_allowed)
          << tolerance << told(designs[i]);
      EXPECT_LE(relative(outcomes[i].first_jump_time, truths[i].first_jump_time), roll_allowed)
          << tolerance << " " << told(designs[i]);
      if (outcomes[i].status != Status::jumped) continue;
      EXPECT_NEAR(outcomes[i].jump_height, truths[i].jump_height, 1e-12 * (1.0 + truths[i].jump_height));
      EXPECT_LE(relative(outcomes[i].apex_time, truths[i].apex_time), 1e-12) << told(designs[i]);
      EXPECT_LE(relative(outcomes[i].flight_time, truths[i].flight_time), 1e-12) << told(designs[i]);
      EXPECT_NEAR(outcomes[i].dip, truths[i].dip, 1e-13);
    }
  }
}

TEST(ExactSolver, AgainstIntegrationEveryMismatchIsDecidedForItByTheWiderType) {
  std::mt19937_64 random(31);
  std::vector<Design> designs;
  for (int i = 0; i < many; ++i) designs.push_back(testing::random_design(random));
  const Scene scene;
  const auto exact = solve_all<Batch>(designs, scene, 1e-12);
  std::vector<std::size_t> mismatches;
  double height = 0.0, time = 0.0;
  std::mutex noting;
  parallel_for_each(designs.size(), 0, {}, [&] {
    return [&, rolling = std::make_unique<RollingIntegration>(testing::adaptive("gsl-rk8pd", 1e-12))](
               std::size_t i) {
      const Outcome integrated = rolling->solve(designs[i], scene);
      const std::lock_guard lock(noting);
      if (!same_flags(exact[i], integrated)) {
        mismatches.push_back(i);
      } else if (exact[i].status == Status::jumped) {
        height = std::max(height, std::abs(exact[i].jump_height - integrated.jump_height));
        time = std::max(time, relative(exact[i].jump_time, integrated.jump_time));
      }
      return true;
    };
  });
  for (const std::size_t i : mismatches) {
    EXPECT_TRUE(same_flags(exact[i], reference({designs[i]}, scene)[0])) << told(designs[i]);
  }
  RecordProperty("mismatches", static_cast<int>(mismatches.size()));
  EXPECT_LE(mismatches.size(), designs.size() / 10'000);  // integration at 1e-12 is seldom wrong
  EXPECT_LT(height, 1e-9);  // the integration's own error, where a design amplifies it
  EXPECT_LT(time, 1e-8);
}

TEST(ExactSolver, LanesAgreeWithTheWiderTypeOnManyDesigns) {
  const auto designs = wild_designs(many / 4, 41);
  const Scene scene;
  const auto lanes = solve_all<Batch>(designs, scene, 1e-10), truths = reference(designs, scene);
  for (std::size_t i = 0; i < designs.size(); ++i)
    EXPECT_TRUE(same_flags(lanes[i], truths[i])) << told(designs[i]);
}

TEST(ExactSolver, ADesignsNeighboursChangeNoMoreThanRoundings) {
  const auto designs = wild_designs(300, 51);
  const auto together = solve_all<Batch>(designs, Scene{}, 1e-12);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Outcome alone = solve_all<Batch>({designs[i]}, Scene{}, 1e-12)[0];
    EXPECT_TRUE(same_flags(alone, together[i]));
    EXPECT_EQ(std::isnan(alone.jump_height), std::isnan(together[i].jump_height));
    if (alone.status == Status::jumped) {
      EXPECT_EQ(alone.jump_height, together[i].jump_height) << "roots in lanes are independent";
    }
    EXPECT_LE(relative(alone.jump_time, together[i].jump_time), 1e-11);  // the number of nodes may be larger
  }
}

TEST(ExactSolver, TheSameDesignsGiveTheSameBitsAgain) {
  const auto designs = wild_designs(1500, 61);
  std::vector<Outcome> first(designs.size()), second(designs.size());
  ExactSolver<Batch> solver(1e-10);
  solver.solve(designs, Scene{}, first);
  solver.solve(std::span(designs).subspan(700, 11), Scene{},
               std::span(second).first(11));  // leaves other traces
  solver.solve(designs, Scene{}, second);
  for (std::size_t i = 0; i < designs.size(); ++i)
    for (const auto member :
         {&Outcome::jump_height, &Outcome::jump_time, &Outcome::first_jump_time, &Outcome::dip})
      EXPECT_EQ(std::bit_cast<std::uint64_t>(first[i].*member),
                std::bit_cast<std::uint64_t>(second[i].*member));
}

TEST(ExactSolver, WhatIsNotWantedIsNotComputedAndChangesNothingElse) {
  const auto designs = wild_designs(500, 71);
  const auto all = solve_all<Batch>(designs, Scene{}, 1e-10);
  std::vector<Outcome> some(designs.size());
  ExactSolver<Batch>(1e-10,
                     {.first_jump_time = false, .jump_time = false, .descent = false, .landing = false})
      .solve(designs, Scene{}, some);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    EXPECT_TRUE(same_flags(all[i], some[i]));
    EXPECT_EQ(relative(all[i].jump_height, some[i].jump_height), 0.0);
    EXPECT_TRUE(std::isnan(some[i].jump_time) && std::isnan(some[i].first_jump_time) &&
                std::isnan(some[i].dip) && std::isnan(some[i].jump_range));
  }
}

}  // namespace
}  // namespace leapmap
