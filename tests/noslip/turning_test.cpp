// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops that turn round, and hoops driven by a motor: method against method, limits, symmetries. The tables
/// are in exact_test and reference_tables_test. LEAPMAP_RANDOM_DESIGNS: how many.
#include <gtest/gtest.h>

#include <cstdlib>

#include "friction/coulomb.hpp"
#include "friction/coulomb_integration.hpp"
#include "noslip/model.hpp"
#include "support/exact.hpp"

namespace leapmap {
namespace {

using testing::either_way, testing::unit_scene;

std::size_t designs_to_compare(std::size_t otherwise) {
  const char* asked = std::getenv("LEAPMAP_RANDOM_DESIGNS");
  return asked ? std::strtoull(asked, nullptr, 10) : otherwise;
}

#ifdef NDEBUG
constexpr std::size_t usual_designs = 4'000;
#else
constexpr std::size_t usual_designs = 400;
#endif

/// The largest difference of what a jump is, relative to one more than its size.
double jump_difference(const Outcome& a, const Outcome& b) {
  double most = 0.0;
  for (double Outcome::*field :
       {&Outcome::jump_height, &Outcome::jump_time, &Outcome::jump_angle, &Outcome::jump_spin,
        &Outcome::jump_distance, &Outcome::first_jump_time, &Outcome::flight_time})
    if (!std::isnan(a.*field))
      most = std::max(most, std::abs(a.*field - b.*field) / (1.0 + std::abs(a.*field)));
  return most;
}

TEST(Turning, ExactAndIntegrationAgreeOnRandomDesignsThatGoEitherWay) {
  const std::size_t count = designs_to_compare(usual_designs);
  std::mt19937_64 random(171);
  std::vector<Design> designs(count);
  for (Design& design : designs) design = either_way(random);
  const auto exact = testing::solve_all<Batch>(designs, unit_scene(), 1e-12);
  std::array<std::size_t, status_count> statuses{};
  std::size_t turned = 0, undecided = 0, against_us = 0, ill = 0;
  double worst = 0.0;
  std::string first;
#pragma omp parallel
  {
    RollingIntegration rolling(testing::adaptive("gsl-rk8pd", 1e-12));
#pragma omp for schedule(dynamic, 64)
    for (std::size_t i = 0; i < count; ++i) {
      const Outcome by_time = rolling.solve(designs[i], unit_scene());
      const bool same = same_flags(exact[i], by_time);
      const Outcome truth = same ? exact[i] : testing::reference({designs[i]}, unit_scene())[0];
      const bool ours = same_flags(exact[i], truth);
      const double off = same ? jump_difference(exact[i], by_time) : 0.0;
#pragma omp critical
      {
        ++statuses[static_cast<std::size_t>(exact[i].status)];
        turned += exact[i].status == Status::jumped && exact[i].jump_spin * designs[i].release_spin < 0.0;
        undecided += !same;
        if (!same && !ours) ++against_us, first = testing::told(designs[i]);
        // The integration's own error is about 1e-12, times what a slow passage makes of it: where it is
        // more, long double decides.
        if (off > 1e-9) {
          ++ill;
          worst =
              std::max(worst, jump_difference(exact[i], testing::reference({designs[i]}, unit_scene())[0]));
        }
      }
    }
  }
  EXPECT_EQ(against_us, 0u) << first;
  EXPECT_LE(undecided, count / 1000) << "beside a graze or a turn the integration is off by its own error";
  EXPECT_LE(ill, count / 100);
  EXPECT_LT(worst, 1e-8);
  EXPECT_EQ(statuses[static_cast<std::size_t>(Status::failed)], 0u);
  EXPECT_GT(turned, count / 50) << "they are to turn round";
  for (const Status status : {Status::jumped, Status::no_jump, Status::stalled, Status::airborne_at_release})
    EXPECT_GT(statuses[static_cast<std::size_t>(status)], count / 100) << name_of(status);
}

TEST(Turning, WithFrictionQuadraturesAndIntegrationAgreeOnRandomDesignsThatGoEitherWay) {
  const std::size_t count = designs_to_compare(usual_designs) / 10;
  const Scene scene = unit_scene(Friction::coulomb);
  std::mt19937_64 random(172);
  std::vector<Design> designs(count);
  for (Design& design : designs) {
    design = either_way(random);
    design.mu_static = testing::uniform(random, 0.1, 1.2);
    design.mu_kinetic = design.mu_static * testing::uniform(random, 0.7, 1.0);
    design.restitution = random() % 2 ? 0.0 : testing::uniform(random, 0.0, 0.7);
  }
  std::size_t jumps = 0, turned = 0, undecided = 0, against_us = 0, gave_up = 0, ill = 0;
  std::string first;
#pragma omp parallel
  {
    CoulombSolver<double> exact(1e-11);
    CoulombSolver<long double> reference(1e-15);
    CoulombIntegration integration(testing::adaptive("gsl-rk8pd", 1e-12));
#pragma omp for schedule(dynamic, 8)
    for (std::size_t i = 0; i < count; ++i) {
      const Outcome a = exact.solve(designs[i], scene), b = integration.solve(designs[i], scene);
      const bool failed = a.status == Status::failed || b.status == Status::failed;
      const bool same = failed || same_flags(a, b);
      const bool ours = same || same_flags(a, reference.solve(designs[i], scene));
#pragma omp critical
      {
        gave_up += failed, undecided += !same, jumps += a.status == Status::jumped;
        turned += a.status == Status::jumped && a.jump_spin * designs[i].release_spin < 0.0;
        if (!ours) ++against_us, first = testing::told(designs[i]);
        // Each phase may amplify the integration's error of 1e-12.
        if (!failed && same && a.status == Status::jumped && jump_difference(a, b) > 1e-7) ++ill;
      }
    }
  }
  EXPECT_EQ(against_us, 0u) << first;
  EXPECT_LE(undecided, 1 + count / 200);
  EXPECT_LE(gave_up, 1 + count / 50);
  EXPECT_LE(ill, 1 + count / 200);
  EXPECT_GT(jumps, count / 5);
  EXPECT_GT(turned, count / 100);
}

TEST(Turning, TimeIsASmoothFunctionOfTheReleaseSpinThroughZero) {
  for (const double release_angle : {std::numbers::pi, 2.9, 4.0, 0.5}) {
    Design design;
    design.release_angle = release_angle;
    if (release_angle < 1.0) design.drive_torque = 0.4;
    const auto at = [&](double spin) {
      Design beside = design;
      beside.release_spin = spin;
      return testing::solve_all<Batch>({beside}, unit_scene(), 1e-13)[0];
    };
    const Outcome rest = at(0.0);
    ASSERT_EQ(rest.status, Status::jumped) << release_angle;
    double slope = 0.0;
    for (const double spin : {1e-3, 1e-5, 1e-7, 1e-9, 1e-12, 1e-15, 1e-16, 1e-17, 1e-30, 1e-170}) {
      const Outcome down = at(spin), up = at(-spin);
      ASSERT_TRUE(same_flags(down, up) && same_flags(down, rest)) << spin;
      if (slope == 0.0) slope = (down.jump_time - up.jump_time) / (2.0 * spin);
      // The second derivative is below 100, and an ulp of the time below 1e-14.
      EXPECT_NEAR(down.jump_time, rest.jump_time + slope * spin, 100.0 * spin * std::max(spin, 1e-3) + 1e-13);
      EXPECT_NEAR(up.jump_time, rest.jump_time - slope * spin, 100.0 * spin * std::max(spin, 1e-3) + 1e-13);
      EXPECT_NEAR(up.jump_height, down.jump_height, 100.0 * spin * spin + 1e-13);
    }
    EXPECT_LT(slope, 0.0) << "a push downhill makes it jump sooner";
  }
}

TEST(Turning, WithFrictionASpinOfARoundingIsNoSpin) {
  std::mt19937_64 random(175);
  CoulombSolver<double> coulomb(1e-10);
  int jumps = 0;
  for (int i = 0; i < 200; ++i) {
    Design design = testing::random_design(random);
    design.mu_static = 0.5;
    design.release_spin = 0.0;
    const Scene scene = unit_scene(Friction::coulomb);
    const Outcome rest = coulomb.solve(design, scene);
    for (const double spin : {1e-16, -1e-16, 1e-15, -1e-15, -1e-30, -1e-40, -1e-150, -1e-200}) {
      design.release_spin = spin;
      const Outcome nearly = coulomb.solve(design, scene);
      ASSERT_TRUE(same_flags(rest, nearly)) << testing::told(design);
      if (rest.status != Status::jumped) continue;
      ++jumps;
      EXPECT_NEAR(nearly.jump_time, rest.jump_time, 1e-9 * rest.jump_time);
    }
  }
  EXPECT_GT(jumps, 480);
}

/// Times are shared by the designs of a call within the tolerance, whatever their neighbours are.
TEST(Turning, NeighboursInACallChangeNoTime) {
  Design design{.slope = -1.19421808072706,
                .mass_ratio = 27.549035076144214,
                .offset_ratio = .9774990507804846,
                .inertia_factor = .47056769241056723,
                .release_angle = -10.103009359182792,
                .release_spin = -2.219343250967541e-05,
                .drive_torque = .7750207782357941};
  const Design beside{.release_angle = 0.5, .release_spin = 2.5};
  const double alone = testing::solve_all<Batch>({design}, unit_scene(), 1e-12)[0].jump_time;
  EXPECT_NEAR(testing::solve_all<Batch>({design, beside}, unit_scene(), 1e-12)[0].jump_time, alone, 1e-11);
  std::mt19937_64 random(176);
  std::vector<Design> designs(2'000);
  for (Design& each : designs) each = either_way(random), each.release_angle *= 3.0;
  const auto together = testing::solve_all<Batch>(designs, unit_scene(), 1e-10);
  for (std::size_t i = 0; i < designs.size(); i += 7) {
    const Outcome one = testing::solve_all<double>({designs[i]}, unit_scene(), 1e-10)[0];
    ASSERT_TRUE(same_flags(one, together[i]));
    if (one.status == Status::jumped) {
      EXPECT_NEAR(together[i].jump_time, one.jump_time, 2e-10 * one.jump_time) << testing::told(designs[i]);
    }
  }
}

/// Its spins shrink from turn to turn, to what is not nothing: it slips down the slope for ever.
TEST(Turning, AHoopThatSlipsDownhillIsNotAtRest) {
  const Design design{.slope = 0.22847164168825207,
                      .mass_ratio = 7.068526843035652,
                      .offset_ratio = 0.7345813398774603,
                      .inertia_factor = 0.5498137616114981,
                      .release_angle = -1.5332713970716179,
                      .release_spin = 0.7785360535481858,
                      .mu_static = 0.3697173553114402,
                      .mu_kinetic = 0.23192827085043347};
  Scene scene = unit_scene(Friction::coulomb);
  scene.runway = 30.0;
  EXPECT_EQ(CoulombSolver<double>(1e-9).solve(design, scene).status, Status::no_jump);
}

TEST(Turning, AtTheRunwaysEndItTurns) {
  for (const double angle : {std::numbers::pi / 4.0, std::numbers::pi / 2.0}) {
    const Design design{.slope = 0.0, .mass_ratio = 3.0, .release_angle = angle};
    Scene scene = unit_scene();
    scene.runway = angle / std::numbers::pi;
    EXPECT_EQ(testing::solve_all<Batch>({design}, scene, 1e-10)[0].status, Status::stalled);
    Design slips = design;
    slips.mu_static = 2.0;
    scene.friction = Friction::coulomb;
    scene.runway = std::nextafter(scene.runway, 0.0);
    EXPECT_NE(CoulombSolver<double>(1e-10).solve(slips, scene).status, Status::failed);
  }
}

TEST(Turning, SeenFromBehindEverythingIsTheSame) {
  std::mt19937_64 random(173);
  const Scene slips = unit_scene(Friction::coulomb);
  CoulombSolver<double> coulomb(1e-10);
  int jumps = 0;
  for (int i = 0; i < 300; ++i) {
    const Design design = either_way(random);
    Design behind = design;
    for (double Design::*member :
         {&Design::slope, &Design::release_angle, &Design::release_spin, &Design::drive_torque})
      behind.*member = -(design.*member);
    for (const bool friction : {false, true}) {
      const Outcome a = friction ? coulomb.solve(design, slips)
                                 : testing::solve_all<Batch>({design}, {}, 1e-10)[0],
                    b = friction ? coulomb.solve(behind, slips)
                                 : testing::solve_all<Batch>({behind}, {}, 1e-10)[0];
      ASSERT_TRUE(same_flags(a, b)) << testing::told(design);
      if (a.status != Status::jumped) continue;
      ++jumps;
      // Bits differ where a node's angle is not exactly minus another's, and phases amplify that.
      EXPECT_NEAR(a.jump_height, b.jump_height, 1e-8);
      EXPECT_NEAR(a.jump_time, b.jump_time, 1e-8 * a.jump_time);
      EXPECT_NEAR(a.jump_distance, -b.jump_distance, 1e-7);
      EXPECT_NEAR(a.jump_spin, -b.jump_spin, 1e-7);
    }
  }
  EXPECT_GT(jumps, 200);
}

/// A motor of torque sin(theta) on level ground does to the energy what the slope does, over the same
/// distance from a release turned by theta. The inertia about the contact is that of another angle, so that
/// spins, times and forces are others.
TEST(Drive, AMotorOnLevelGroundIsASlopeToTheEnergyAndToNothingElse) {
  Design slope;
  Design level = slope;
  level.slope = 0.0, level.drive_torque = std::sin(slope.slope);
  level.release_angle += slope.slope;
  const auto roll_of = [](const Design& design) {
    return begin_roll(reduce<double>(design), design.release_angle, design.release_spin);
  };
  for (const double x : {0.1, 1.0, 3.0, 10.0, 25.0})
    EXPECT_NEAR(vis_viva_past_release(roll_of(slope), x), vis_viva_past_release(roll_of(level), x), 1e-13)
        << x;
  const Outcome down = testing::solve_all<Batch>({slope}, unit_scene(), 1e-12)[0],
                driven = testing::solve_all<Batch>({level}, unit_scene(), 1e-12)[0];
  ASSERT_EQ(down.status, Status::jumped);
  ASSERT_EQ(driven.status, Status::jumped);
  EXPECT_GT(std::abs(down.jump_time - driven.jump_time), 0.1);
  EXPECT_GT(std::abs(down.jump_height - driven.jump_height), 0.01);

  // Where energy alone decides they are equal: how far a hoop rolls up before it turns round.
  for (Design* design : {&slope, &level}) design->release_angle += 2.0;
  FoundLiftOffs told[2];
  for (int i = 0; i < 2; ++i) {
    Design uphill = i == 0 ? slope : level;
    const Hoop<double> hoop = reduce<double>(uphill);
    uphill.release_spin = -std::sqrt(0.5 / contact_inertia(hoop, trig(uphill.release_angle)));
    Outcome outcome;
    ExactSolver<double>(1e-12).solve({&uphill, 1}, unit_scene(), {&outcome, 1}, &told[i]);
    ASSERT_FALSE(told[i].turns.empty());
    told[i].turns[0] -= uphill.release_angle;
  }
  EXPECT_NEAR(told[0].turns[0], told[1].turns[0], 1e-13);
  EXPECT_LT(told[0].turns[0], 0.0);
}

/// Without slip and with: of what the motor has put in nothing is lost but to sliding and landing.
TEST(Drive, TheMotorsWorkIsInTheEnergy) {
  std::mt19937_64 random(174);
  int looked_at = 0;
  for (int i = 0; i < 60; ++i) {
    const Design design = either_way(random);
    const Hoop<double> hoop = reduce<double>(design);
    const Motion motion = noslip::tell_exactly(design, unit_scene(), 1e-12, 0.5);
    if (motion.points.empty()) continue;
    const double energy = rolling_energy(hoop, design.release_angle, design.release_spin);
    for (const MotionPoint& point : motion.points) {
      if (point.phase != Phase::rolling) break;
      ++looked_at;
      // of terms that grow with the way
      ASSERT_NEAR(rolling_energy(hoop, point.phi, point.spin), energy, 1e-11 * (10.0 + std::abs(point.phi)))
          << testing::told(design);
    }
  }
  EXPECT_GT(looked_at, 300);
  Design sticky{.drive_torque = 0.2, .mu_static = 1e3};
  const Outcome stuck = CoulombSolver<double>(1e-12).solve(sticky, unit_scene(Friction::coulomb));
  ASSERT_EQ(stuck.status, Status::jumped);
  EXPECT_NEAR(stuck.energy_lost, 0.0, 0.01) << "it slips only on its way off, and where it lands after a hop";
  Design slippery = sticky;
  slippery.mu_static = 0.4;
  EXPECT_GT(CoulombSolver<double>(1e-12).solve(slippery, unit_scene(Friction::coulomb)).energy_lost, 0.02);
}

/// It slips a little less on every swing, and would for ever.
TEST(Turning, AHoopThatRocksToRestIsStalled) {
  const Design design{.slope = 0.01029316891313108,
                      .mass_ratio = 4.4850089259475681,
                      .inertia_factor = 0.5219673517387865,
                      .release_angle = 5.8034564119454215,
                      .release_spin = 0.88061767176000127,
                      .mu_static = 0.41702228616633563};
  const Scene scene = unit_scene(Friction::coulomb);
  const Outcome exact = CoulombSolver<double>(1e-10).solve(design, scene),
                integrated = CoulombIntegration(testing::adaptive("gsl-rk8pd", 1e-11)).solve(design, scene);
  EXPECT_EQ(exact.status, Status::stalled);
  EXPECT_TRUE(same_flags(exact, integrated));
  EXPECT_EQ(phase_letters(exact.phase_sequence).substr(0, 8), "RSRSRSRS");
}

}  // namespace
}  // namespace leapmap
