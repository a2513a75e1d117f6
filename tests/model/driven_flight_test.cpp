// SPDX-License-Identifier: GPL-3.0-or-later
/// Flights in which the motor goes on: events against dense sampling, methods against methods, and what
/// becomes of maps that idle motors leave without an answer.
#include "hoop/driven_flight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hoop/flight_search.hpp"
#include "leapmap/solve.hpp"
#include "model/model.hpp"
#include "referee/referee.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

using testing::uniform;
using Long = long double;

struct Subject {
  Hoop<double> hoop{};
  double angle, spin, normal;
};

Subject random_flight(std::mt19937_64& random) {
  Subject subject;
  const double slope = uniform(random, -1.2, 1.2);
  subject.hoop.sin_slope = std::sin(slope), subject.hoop.cos_slope = std::cos(slope);
  subject.hoop.rho = uniform(random, 0.05, 1.0);
  subject.hoop.aloft = uniform(random, -3.0, 3.0) * std::exp(uniform(random, -3.0, 1.0));
  subject.angle = uniform(random, -3.2, 3.2);
  subject.spin = uniform(random, -1.0, 1.0) * std::exp(uniform(random, -1.0, 2.5));
  subject.normal = random() % 2 == 0 ? 0.0 : uniform(random, 0.0, 1.0);
  return subject;
}

/// The height of the hoop as the equation has it, term by term.
Long height(const Subject& s, Long t) {
  const Long phi = s.angle + s.spin * t + 0.5L * s.hoop.aloft * t * t;
  return -s.hoop.rho * std::cos(Long(s.angle)) +
         (s.normal + s.hoop.rho * std::sin(Long(s.angle)) * s.spin) * t - 0.5L * s.hoop.cos_slope * t * t +
         s.hoop.rho * std::cos(phi);
}

TEST(DrivenFlights, AreThoseThatManyLooksSee) {
  std::mt19937_64 random(49);
  int flew = 0, dipped = 0;
  for (int i = 0; i < 300; ++i) {
    const Subject s = random_flight(random);
    DrivenFlight<double> driven(s.hoop, s.angle, s.spin, s.normal);
    const Flight<double> flight = driven.fly();
    const Long step = 0.005L / (1.0L + std::abs(s.spin) + std::sqrt(std::abs(s.hoop.aloft)));
    Long highest = 0.0L, lowest = 0.0L, landing = 0.0L;
    bool above = false;
    for (Long t = step; t < 60.0L && landing == 0.0L; t += step) {
      const Long y = height(s, t);
      above = above || y > 1e-12L;
      if (above && y <= 0.0L) landing = t;
      (above ? highest : lowest) = above ? std::max(highest, y) : std::min(lowest, y);
    }
    if (!(highest > 1e-6L)) continue;  // a rise that looks may miss
    ++flew, dipped += lowest < -1e-6L;
    // Between two looks y'' of some hundreds at most adds that; a landing is within one step.
    const double curve = s.hoop.cos_slope + s.hoop.rho * (std::pow(std::abs(s.spin) + 8.0, 2) + 30.0);
    const double between = curve * static_cast<double>(step * step);
    ASSERT_NEAR(2.0 * flight.height, static_cast<double>(highest), between) << i;
    ASSERT_NEAR(2.0 * flight.dip, static_cast<double>(lowest), between) << i;
    ASSERT_NEAR(flight.flight_time, static_cast<double>(landing), 1.01 * static_cast<double>(step)) << i;
    // Roundings of terms that grow with the way.
    const double rounding = 1e-14 * (1.0 + std::abs(s.spin)) * (1.0 + flight.flight_time);
    EXPECT_NEAR(static_cast<double>(height(s, flight.apex_time)), 2.0 * flight.height, rounding) << i;
    EXPECT_NEAR(static_cast<double>(height(s, flight.flight_time)), 0.0, 20.0 * rounding) << i;
    EXPECT_NEAR(static_cast<double>(height(s, driven.lowest_at())), 2.0 * flight.dip, rounding) << i;
  }
  EXPECT_GT(flew, 120);
  EXPECT_GT(dipped, 3);
}

TEST(DrivenFlights, GoOverIntoThoseOfAnIdleMotor) {
  std::mt19937_64 random(50);
  int flew = 0;
  for (int i = 0; i < 500; ++i) {
    Subject s = random_flight(random);
    s.normal = 0.0, s.hoop.aloft = 0.0;
    const LiftOff<double> lift_off{0.0, s.angle, s.spin};
    const Flight<double> idle = fly(s.hoop, lift_off);
    s.hoop.aloft = 1e-15;
    const Flight<double> driven = fly(s.hoop, lift_off);
    ASSERT_EQ(idle.height > 1e-9, driven.height > 1e-9) << i;
    if (!(idle.height > 1e-9)) continue;
    ++flew;
    const double rounding = 1e-13 * (1.0 + s.spin * s.spin);
    EXPECT_NEAR(driven.height, idle.height, rounding);
    EXPECT_NEAR(driven.dip, idle.dip, rounding);
    EXPECT_NEAR(driven.flight_time, idle.flight_time, 1e-10) << "a landing that only grazes moves the most";
  }
  EXPECT_GT(flew, 100);
}

/// Exact solvers, integrations and the referee, which shares no formula with them.
TEST(DrivenFlights, OfRandomDesignsAreTheSameByEveryMethod) {
  std::mt19937_64 random(51);
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Scene scene = testing::unit_scene(friction);
    const Model& model = model_of(scene);
    const IntegrationOptions options = testing::adaptive("gsl-rk8pd", 1e-12);
    referee::Referee referee(scene, 1e-12);
    int jumped = 0, differ = 0;
    const int count = 150;
    for (int i = 0; i < count; ++i) {
      Design design = testing::either_way(random, friction);
      design.drive_torque = uniform(random, -1.0, 1.0);
      Outcome exact, integrated;
      model.exact(scene, 1e-11, {.landing = true})({&design, 1}, {&exact, 1});
      model.integration(scene, options)({&design, 1}, {&integrated, 1});
      const Outcome judged = referee.solve(design);
      if (judged.status == Status::failed || integrated.status == Status::failed) continue;
      if (!same_flags(exact, judged) || !same_flags(exact, integrated)) {
        ++differ;  // beside an event, whose side an error of 1e-12 decides
        continue;
      }
      if (exact.status != Status::jumped) continue;
      ++jumped;
      const double grows =
          1e-10 * (1.0 + std::abs(exact.jump_spin));  // what a way of some turns makes of 1e-12
      EXPECT_NEAR(exact.jump_height, judged.jump_height, grows) << i;
      EXPECT_NEAR(exact.jump_height, integrated.jump_height, grows) << i;
      EXPECT_NEAR(exact.flight_time, judged.flight_time, grows * (1.0 + exact.flight_time)) << i;
      EXPECT_NEAR(exact.jump_range, judged.jump_range, grows * (1.0 + std::abs(exact.jump_range))) << i;
      EXPECT_NEAR(exact.landing_impulse, judged.landing_impulse, grows * (1.0 + exact.landing_impulse)) << i;
    }
    EXPECT_GT(jumped, count / 5);
    EXPECT_LE(differ, 1);
  }
}

/// Level ground, a motor that drives; what an idle one leaves without an answer, a third, all jumps.
TEST(DrivenFlights, LeaveAlmostNoMotorMapWithoutAnAnswer) {
  std::mt19937_64 random(52);
  const std::size_t count = testing::how_many(800);
  std::vector<Design> designs(count);
  for (Design& design : designs)
    design = {.slope = 0.0,
              .mass_ratio = std::exp(uniform(random, std::log(0.5), std::log(10.0))),
              .drive_torque = uniform(random, 0.2, 1.0),
              .mu_static = uniform(random, 0.3, 1.0)};
  const auto indeterminate = [&](const Scene& scene) {
    std::size_t number = 0;
    for (const Outcome& outcome : solve(designs, scene)) number += outcome.status == Status::indeterminate;
    return number;
  };
  EXPECT_LT(indeterminate(testing::unit_scene(Friction::coulomb)), count / 100);
  EXPECT_GT(indeterminate(testing::idle_scene(Friction::coulomb)), count / 4);
}

/// Free flight begins with y'' > 0 where n0, which has the torque in it, falls through zero.
TEST(DrivenFlights, WithFrictionNeverBeginBySinking) {
  std::mt19937_64 random(53);
  const Scene scene = testing::unit_scene(Friction::coulomb);
  int flights = 0;
  for (int i = 0; i < 150; ++i) {
    Design design = testing::either_way(random);
    design.drive_torque = uniform(random, -1.0, 1.0);
    design.mu_static = uniform(random, 0.1, 1.2);
    const Motion motion = model_of(scene).tell_exactly(design, scene, 1e-10, 2e-2);
    for (const MotionPoint& point : motion.points) {
      ASSERT_TRUE(point.phase != Phase::flight || point.y > -1e-9) << "design " << i << " at " << point.t;
      flights += point.phase == Phase::flight;
    }
  }
  EXPECT_GT(flights, 500);
}

}  // namespace
}  // namespace leapmap
