// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/referee.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>

#include "hoop/landing.hpp"
#include "hoop/sliding.hpp"
#include "support/designs.hpp"
#include "support/reference_table.hpp"

namespace leapmap::referee {
namespace {

using leapmap::testing::ReferenceRow, leapmap::testing::uniform;

/// A table's rows, one in so many, by the referee at a tolerance of 1e-13. What it is off by is what its
/// steps add up to over some revolutions.
void compare_with(const std::string& table, std::size_t every, const Scene& scene, double allowed) {
  Referee referee(scene, 1e-13);
  const double second = std::sqrt(scene.radius / scene.gravity);
  const auto rows = leapmap::testing::read_reference(table);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < rows.size(); i += every) {
    const ReferenceRow& row = rows[i];
    Design design = row.design();
    if (scene.friction == Friction::coulomb)
      design.mu_static = row.number("mu_static"), design.mu_kinetic = row.number("mu_kinetic"),
      design.restitution = row.number("restitution");
    const Outcome outcome = referee.solve(design);
    const std::string where = table + " row " + std::to_string(i + 1);
    EXPECT_EQ(name_of(outcome.status), row.cells.at("status")) << where;
    EXPECT_EQ(outcome.spurious_first_jump, row.has("spurious") ? row.number("spurious") : 255) << where;
    const auto check = [&](const std::string& name, double value, double unit) {
      if (!row.has(name)) return;
      EXPECT_NEAR(value, unit * row.number(name), allowed * unit * (1.0 + std::abs(row.number(name))))
          << where << " " << name;
      ++compared;
    };
    check("jump_height", outcome.jump_height, 1.0);
    check("first_jump_height", outcome.first_jump_height, 1.0);
    check("jump_angle", outcome.jump_angle, 1.0);
    check("jump_spin", outcome.jump_spin, 1.0);
    check("jump_time", outcome.jump_time, second);
    check("first_jump_time", outcome.first_jump_time, second);
    check("apex_time", outcome.apex_time, second);
    check("flight_time", outcome.flight_time, second);
  }
  EXPECT_GT(compared, 3 * rows.size() / every);
}

TEST(Referee, AgreesWithTheTables) {
  const Scene idle{.motor_in_flight = false};
  compare_with("noslip_general.csv", 5, idle, 1e-11);
  compare_with("noslip_top_release.csv", 5, idle, 1e-11);
  compare_with("noslip_turning.csv", 5, idle, 1e-11);
  compare_with("noslip_drive.csv", 5, idle, 1e-11);
  Scene coulomb{.friction = Friction::coulomb, .hop_height = 0.0, .motor_in_flight = false};
  // of these the tables' times are good to 1e-8 and heights to 1e-8
  compare_with("coulomb_first_liftoff.csv", 5, coulomb, 1e-8);
  coulomb.hop_height = 0.05;
  compare_with("coulomb_turning_drive.csv", 5, coulomb, 1e-8);
}

TEST(Referee, TellsTimesInSecondsOfWhateverRadiusAndGravityThereAre) {
  const Design design{.release_angle = 3.3, .mu_static = 0.4};
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Scene unit{.friction = friction, .radius = 1.0, .gravity = 1.0},
        moon{.friction = friction, .radius = 3.0, .gravity = 1.62};
    const Outcome one = Referee(unit, 1e-13).solve(design), other = Referee(moon, 1e-13).solve(design);
    ASSERT_EQ(one.status, Status::jumped);
    EXPECT_TRUE(same_flags(one, other));
    const double second = std::sqrt(3.0 / 1.62);
    EXPECT_NEAR(other.jump_time, second * one.jump_time, 1e-11 * other.jump_time);
    EXPECT_NEAR(other.flight_time, second * one.flight_time, 1e-11 * other.flight_time);
    EXPECT_NEAR(other.jump_height, one.jump_height, 1e-11);
    EXPECT_NEAR(other.jump_spin, one.jump_spin, 1e-11 * one.jump_spin);
  }
}

Motion any_motion(std::mt19937_64& random, const Body& body) {
  return {0.0,
          body.R,
          uniform(random, -4.0, 4.0),
          uniform(random, -2.0, 2.0),
          uniform(random, -2.0, 0.0),
          uniform(random, -20.0, 20.0)};
}

/// (7) to (9) and the mode's two equations with both multipliers, row by row, and their right sides.
Eigen::Vector<long double, 5> all_at_once(const Body& body, double slope, const Mode& mode,
                                          const Motion& at) {
  using Number = long double;
  const Number m = body.m, m_p = body.m_p, R = body.R, L = body.L, g = body.g, M = m + m_p,
               s = std::sin(Number(at.phi)), c = std::cos(Number(at.phi)), w2 = Number(at.spin) * at.spin;
  Eigen::Matrix<Number, 5, 5> A = Eigen::Matrix<Number, 5, 5>::Zero();
  A.row(0) << M, 0, -m_p * L * c, -1, 0;
  A.row(1) << 0, M, m_p * L * s, 0, -1;
  A.row(2) << -m_p * L * c, m_p * L * s, body.I + m_p * L * L, R, 0;
  const bool is_free = mode.kind == Mode::flies || mode.kind == Mode::unheld;
  A(3, mode.kind == Mode::rolls ? 0 : 3) = 1;
  if (mode.kind == Mode::rolls) A(3, 2) = -R;
  if (mode.kind == Mode::slides) A(3, 4) = -mode.drag;
  A(4, is_free ? 4 : 1) = 1;
  Eigen::Vector<Number, 5> b = Eigen::Vector<Number, 5>::Zero();
  b[0] = M * g * std::sin(Number(slope)) - m_p * w2 * L * s;
  b[1] = -M * g * std::cos(Number(slope)) - m_p * w2 * L * c;
  b[2] = body.motor - m_p * g * L * std::sin(Number(slope) + at.phi);
  return A.fullPivLu().solve(b);
}

TEST(Referee, ItsForcesSolveItsEquationsWhateverTheMasses) {
  std::mt19937_64 random(5);
  for (const Mode::Kind kind : {Mode::rolls, Mode::slides, Mode::flies, Mode::unheld})
    for (const double inertia : {0.0, 1e-9, 1e-3, 1.0})
      for (const double offset : {1e-3, 0.3, 1.0})
        for (const double mass : {1e-3, 1.0, 1e3}) {
          const bool is_free = kind == Mode::flies || kind == Mode::unheld;
          if (is_free && inertia < 1e-3) continue;  // next to nothing turns there
          for (int k = 0; k < 20; ++k) {
            const Design design{.slope = 0.4,
                                .mass_ratio = mass,
                                .offset_ratio = offset,
                                .inertia_factor = inertia,
                                .drive_torque = 0.3};
            const Body body = body_of(design, {.motor_in_flight = false, .radius = 1.0, .gravity = 1.0});
            const Mode mode{kind, uniform(random, -0.4, 0.4)};
            Motion at{};
            at.phi = uniform(random, -4.0, 4.0), at.spin = uniform(random, -2.0, 2.0);
            const Forces forces = forces_of(body, mode, at);
            const Eigen::Vector<long double, 5> right = all_at_once(body, design.slope, mode, at);
            const std::array<double, 5> numbers{forces.x, forces.y, forces.phi, forces.friction,
                                                forces.normal};
            // Roundings of the largest of them, times how much masses and lengths of several magnitudes, and
            // a slide next to Painleve's edge, amplify them: up to 1e4.
            const double size = 1.0 + static_cast<double>(right.lpNorm<Eigen::Infinity>());
            for (std::size_t i = 0; i < numbers.size(); ++i)
              EXPECT_NEAR(numbers[i], static_cast<double>(right[static_cast<Eigen::Index>(i)]), 1e-11 * size)
                  << "mode " << kind << " I " << inertia << " L " << offset << " m_p " << mass << " " << i;
          }
        }
}

TEST(Referee, SolvesAHoopWithoutInertiaOrMass) {
  Referee referee(Scene{}, 1e-13);
  EXPECT_EQ(referee.solve({.mass_ratio = 0.0, .inertia_factor = 0.0}).status, Status::no_jump);
}

TEST(Referee, ItsForcesDoNoWorkThatItsEnergyDoesNotShow) {
  std::mt19937_64 random(3);
  const Body body = body_of({.mass_ratio = 3.0, .offset_ratio = 0.8}, {});
  for (int i = 0; i < 50; ++i) {
    Motion at = any_motion(random, body);
    // Rolling and in flight energy is kept; sliding it falls by the friction force's power.
    for (const Mode mode : {Mode{Mode::rolls}, Mode{Mode::slides, -0.3}, Mode{Mode::flies}}) {
      if (mode.kind != Mode::flies) at.y_rate = 0.0;
      if (mode.kind == Mode::rolls) at.x_rate = body.R * at.spin;
      const Forces forces = forces_of(body, mode, at);
      const auto later = [&](double t) {
        return Motion{at.x + t * at.x_rate,     at.y + t * at.y_rate,     at.phi + t * at.spin,
                      at.x_rate + t * forces.x, at.y_rate + t * forces.y, at.spin + t * forces.phi};
      };
      constexpr double h = 1e-6;
      const double power = (energy(body, later(h)) - energy(body, later(-h))) / (2.0 * h);
      const double friction = mode.kind == Mode::slides ? forces.friction * slip_of(body, at) : 0.0;
      // differences of energies of some joules, an h apart
      EXPECT_NEAR(power, friction, 1e-6 * (1.0 + std::abs(energy(body, at)) + std::abs(friction)));
    }
  }
}

TEST(Referee, LandsAsTheSolversDoAndSlidesIntoTheSameEdge) {
  std::mt19937_64 random(4);
  const Scene scene{.radius = 1.0, .gravity = 1.0};
  for (int i = 0; i < 300; ++i) {
    const Design design{.mass_ratio = uniform(random, 0.5, 20.0), .offset_ratio = uniform(random, 0.3, 1.0)};
    const Body body = body_of(design, scene);
    const Hoop<double> hoop = reduce<double>(design);
    const Motion before = any_motion(random, body);
    const double mu = uniform(random, 0.0, 1.5), restitution = uniform(random, 0.0, 0.9);
    const Landed landed = referee::land(body, before, mu, restitution, 0.0);
    const Motion& after = landed.after;
    const Landing<double> landing =
        land<double>(hoop, trig(before.phi), {before.x_rate - before.spin, before.y_rate, before.spin}, mu,
                     restitution, 0.0);
    const double rounding = 1e-12 * (1.0 + std::abs(before.spin)) * (1.0 + 1.0 / hoop.Ic);
    EXPECT_NEAR(after.spin, landing.after.spin, rounding);
    EXPECT_NEAR(after.y_rate, landing.after.normal, rounding);
    EXPECT_NEAR(slip_of(body, after), landing.after.slip, rounding);
    EXPECT_NEAR(landed.impulse / body.mass(), landing.impulse.normal, rounding);
    const Landed held = land_without_slip(body, before);
    const Landing<double> holding =
        hold<double>(hoop, trig(before.phi), {before.x_rate - before.spin, before.y_rate, before.spin});
    EXPECT_NEAR(held.after.spin, holding.after.spin, rounding);
    EXPECT_NEAR(held.impulse / body.mass(), holding.impulse.normal, rounding);

    const double D =
        1.0 + hoop.rho * std::sin(before.phi) / hoop.Ic * sliding_lever(hoop, trig(before.phi), mu);
    const double D0 = 1.0 + std::pow(hoop.rho * std::sin(before.phi), 2) / hoop.Ic;
    EXPECT_NEAR(sliding_determinant(body, {Mode::slides, -mu}, before), D / D0,
                1e-12 * (1.0 + 1.0 / hoop.Ic));
  }
}

TEST(Referee, GivesUpWithAWordWhereItsIntegrationDoes) {
  Scene scene;
  scene.runway = 1e9;
  scene.hop_height = 1e9;
  const Outcome outcome = Referee(scene, 1e-13, 500).solve({.slope = 0.01});
  EXPECT_EQ(outcome.status, Status::failed);
  EXPECT_NE(outcome.failure, nullptr);
}

}  // namespace
}  // namespace leapmap::referee
