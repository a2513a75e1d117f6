// SPDX-License-Identifier: GPL-3.0-or-later
// A hoop with a driven pendulum: its equations, its limits, and whole designs against the referee.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "leapmap/errors.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/trace.hpp"
#include "model/fields.hpp"
#include "pendulum/solver.hpp"
#include "referee/referee.hpp"
#include "referee/robot.hpp"

namespace leapmap::pendulum {
namespace {

constexpr Scene level{.model = Mechanism::pendulum, .radius = 1.0, .gravity = 1.0};

Scene with(Friction friction, MotorLaw law = MotorLaw::constant) {
  Scene scene = level;
  scene.friction = friction, scene.motor_law = law;
  return scene;
}

struct Draws {
  std::mt19937_64 generator;
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(generator); }
  double log_between(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  int below(int count) { return std::uniform_int_distribution(0, count - 1)(generator); }
};

/// Robots of all kinds; half of them with a motor whose torque falls with its speed.
Design random_robot(Draws& draws) {
  Design design;
  design.slope = draws.below(3) ? draws.between(-0.3, 0.6) : 0.0;
  design.mass_ratio = draws.log_between(0.2, 20.0);
  design.offset_ratio = draws.between(0.3, 1.0);
  design.inertia_factor = draws.between(0.5, 1.0);
  design.pendulum_inertia = draws.below(2) ? draws.between(0.0, 0.5) : 0.0;
  design.release_spin = draws.below(2) ? draws.between(-1.0, 1.0) : 0.0;
  design.pendulum_angle = draws.between(-3.0, 3.0);
  design.pendulum_spin = draws.below(2) ? draws.between(-1.0, 1.0) : 0.0;
  design.motor_torque = draws.between(-2.0, 2.0);
  if (draws.below(2)) design.no_load_speed = draws.between(2.0, 12.0);
  return design;
}

/// What that law needs besides.
void add_law(Draws& draws, MotorLaw law, Design& design) {
  if (law == MotorLaw::constant) return;
  const bool of_angle = law == MotorLaw::until_angle || law == MotorLaw::angle;
  design.motor_target = of_angle ? draws.between(-6.0, 6.0) : draws.between(-3.0, 3.0);
  if (law == MotorLaw::angle)
    design.motor_gain = draws.between(0.5, 5.0), design.motor_damping = draws.between(0.1, 2.0);
  if (law == MotorLaw::speed && draws.below(2)) design.motor_gain = draws.between(0.5, 5.0);
}

constexpr std::array laws{MotorLaw::constant, MotorLaw::until_angle, MotorLaw::until_speed, MotorLaw::speed,
                          MotorLaw::angle};

TEST(Pendulum, ForcesAreThoseOfNewtonAndEuler) {
  Draws draws{std::mt19937_64(1)};
  for (int k = 0; k < 2'000; ++k) {
    Design design = random_robot(draws);
    System system{.robot = reduce(design), .motor = Motor(design, level)};
    Y at{};
    for (double& number : at) number = draws.between(-3.0, 3.0);
    const referee::Robot robot = referee::robot_of(design, level);
    const referee::RobotMotion motion{at[x],  1.0 + at[y], at[phi], at[psi], at[vx],
                                      at[vy], at[w],       at[u],   0.0};
    const double torque = referee::motor_range(robot, motion).up / robot.weight();
    for (const auto mode : {ContactMode::rolls, ContactMode::slides, ContactMode::flies})
      for (const bool holds : {false, true}) {
        system.mode = mode, system.drag = draws.between(-0.8, 0.8);
        // A sliding contact has one answer only off Painleve's region.
        if (mode == ContactMode::slides && pivot(system.robot, sincos_of(at[psi]), system.drag, holds) < 1e-3)
          continue;
        const Forces<double> ours = system.forces(at, Drive<double>{holds ? 0.0 : torque, holds});
        const referee::RobotForces theirs =
            referee::forces_of(robot,
                               {static_cast<referee::RobotMode::Kind>(mode),
                                holds ? referee::Motored::holds : referee::Motored::up, system.drag},
                               motion);
        const double size = 1.0 + std::abs(theirs.phi) + std::abs(theirs.psi) + std::abs(theirs.normal);
        const double near = 1e-10 * size;  // of the eleven equations' condition
        EXPECT_NEAR(ours.along, theirs.x, near);
        EXPECT_NEAR(ours.across, theirs.y, near);
        EXPECT_NEAR(ours.hoop, theirs.phi, near);
        EXPECT_NEAR(ours.pendulum, theirs.psi, near);
        EXPECT_NEAR(ours.normal * robot.weight(), theirs.normal, near);
        EXPECT_NEAR(ours.friction * robot.weight(), theirs.friction, near);
        EXPECT_NEAR(ours.torque * robot.weight(), theirs.torque, near);
      }
  }
}

TEST(Pendulum, EnergyGrowsByTheMotorsWorkAlone) {
  Draws draws{std::mt19937_64(2)};
  double most = 0.0;
  for (int k = 0; k < 100; ++k) {
    Design design = random_robot(draws);
    const MotorLaw law = laws[static_cast<std::size_t>(k % 5)];
    add_law(draws, law, design);
    const Scene scene = with(Friction::sticking, law);
    const Robot robot = reduce(design);
    const double released_energy = energy(robot, released(design));
    Solver solver(adaptive("gsl-rk8pd", 1e-12));
    Observer observer;
    const auto look = [&](const TakenStep& step) {
      Y at;
      ASSERT_TRUE(step.state_at(step.end, at));
      const double now = energy(robot, at);
      most = std::max(
          most, std::abs(now - released_energy - at[work]) / (1.0 + std::abs(now) + std::abs(at[work])));
    };
    observer.contact_step = observer.flight_step = look;
    solver.solve(design, scene, observer);
  }
  EXPECT_LT(most, 1e-9);  // of steps that allow 1e-12 each
}

TEST(Pendulum, LockedIsThePassiveHoop) {
  Draws draws{std::mt19937_64(3)};
  int jumps = 0;
  for (int k = 0; k < 200; ++k) {
    Design hoop;
    hoop.slope = draws.between(0.02, 0.8), hoop.mass_ratio = draws.log_between(0.5, 50.0);
    hoop.offset_ratio = draws.between(0.5, 1.0), hoop.inertia_factor = draws.between(0.5, 1.0);
    hoop.release_angle = draws.between(2.0, 4.0);
    hoop.release_spin = draws.between(0.0, 1.0);
    Design robot = hoop;
    robot.pendulum_angle = hoop.release_angle, robot.pendulum_spin = hoop.release_spin;
    robot.motor_torque = 1e3, robot.motor_target = -1e3;  // beyond which it brakes from the start
    const Scene locked = with(Friction::sticking, MotorLaw::until_angle);
    Scene passive = locked;
    passive.model = Mechanism::hoop, passive.motor_law = MotorLaw::constant;
    const Outcome ours = solve(robot, locked), theirs = solve(hoop, passive);
    ASSERT_EQ(ours.status, theirs.status);
    ASSERT_EQ(ours.candidates, theirs.candidates);
    EXPECT_EQ(ours.spurious_first_jump, theirs.spurious_first_jump);
    if (ours.status != Status::jumped) continue;
    ++jumps;
    EXPECT_NEAR(ours.jump_height, theirs.jump_height, 1e-8 * (1.0 + theirs.jump_height));  // steps of 1e-10
    EXPECT_NEAR(ours.jump_time, theirs.jump_time, 1e-8 * (1.0 + theirs.jump_time));
    EXPECT_NEAR(ours.jump_range, theirs.jump_range, 1e-7 * (1.0 + std::abs(theirs.jump_range)));
    EXPECT_NEAR(ours.max_normal_force, theirs.max_normal_force, 1e-7 * (1.0 + theirs.max_normal_force));
    EXPECT_NEAR(ours.motor_energy, 0.0, 1e-12);  // the brake holds, and nothing turns against it
  }
  EXPECT_GT(jumps, 100);
}

TEST(Pendulum, WithoutTorqueSwingsAtItsFrequencyAndKeepsItsMomentum) {
  Design design;
  design.slope = 0.0, design.mass_ratio = 1.5, design.offset_ratio = 0.7, design.pendulum_angle = 1e-4;
  const Robot r = reduce(design);
  const double omega = std::sqrt(r.rho / (r.A - r.rho * r.rho / (1.0 + r.J)));
  Scene scene = level;
  scene.patience = 3.0;
  const Motion motion = trace(design, scene, {.interval = 0.1, .tolerance = 1e-13});
  ASSERT_GT(motion.points.size(), 20u);
  for (const MotionPoint& at : motion.points) {
    EXPECT_NEAR(at.pendulum_angle, 1e-4 * std::cos(omega * at.t), 1e-11);  // its cube, 1e-12, is left out
    const double momentum = (1.0 + r.J) * at.spin - r.rho * std::cos(at.pendulum_angle) * at.pendulum_spin;
    EXPECT_NEAR(momentum, 0.0, 1e-15);
  }
}

TEST(Pendulum, OnAMasslessHoopIsPushedAlongByTheTorqueAlone) {
  Design design;
  design.slope = 0.0, design.mass_ratio = 1e9, design.offset_ratio = 0.8, design.pendulum_angle = 0.9;
  design.motor_torque = 0.1;
  Scene scene = level;
  scene.patience = 1.0;
  const Motion motion = trace(design, scene, {.interval = 0.05, .tolerance = 1e-12});
  ASSERT_GT(motion.points.size(), 10u);
  for (const MotionPoint& at : motion.points) {
    const double along = at.x - 0.8 * (std::sin(at.pendulum_angle) - std::sin(0.9));
    EXPECT_NEAR(along, -0.05 * at.t * at.t, 1e-8);  // friction is -tau / R; 1e-9 is the hoop's mass
  }
}

TEST(Pendulum, ATorqueThatLiftsItAtOnceIsALiftOffAtTheRelease) {
  Design design;
  design.slope = 0.0, design.mass_ratio = 4.0, design.pendulum_angle = 2.0, design.motor_torque = -3.0;
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Outcome outcome = solve(design, with(friction));
    EXPECT_EQ(outcome.status, Status::jumped);
    EXPECT_EQ(outcome.jump_time, 0.0);
    EXPECT_EQ(outcome.motor_energy, 0.0);
    EXPECT_TRUE(std::isnan(outcome.efficiency));
  }
  design.motor_torque = 0.0, design.pendulum_spin = 5.0, design.pendulum_angle = std::numbers::pi;
  for (const Friction friction : {Friction::sticking, Friction::coulomb})
    EXPECT_EQ(solve(design, with(friction)).status, Status::airborne_at_release);
}

TEST(Pendulum, ExplicitSteppersTellTheSamePhasesAndOthersAreRefused) {
  Draws draws{std::mt19937_64(9)};
  const Scene scene = with(Friction::coulomb, MotorLaw::until_speed);
  int jumped = 0;
  for (int k = 0; k < 40; ++k) {
    Design design = random_robot(draws);
    add_law(draws, MotorLaw::until_speed, design);
    const Outcome usual = solve(design, scene, {.tolerance = 1e-9});
    jumped += usual.status == Status::jumped;
    for (const char* stepper : {"gsl-rkf45", "gsl-rkck"}) {
      const Outcome other = solve(design, scene, {.method = stepper, .tolerance = 1e-9});
      EXPECT_TRUE(same_flags(usual, other))
          << stepper << ", design " << k << ": " << name_of(usual.status) << " "
          << phase_letters(usual.phase_sequence) << ", " << name_of(other.status) << " "
          << phase_letters(other.phase_sequence);
    }
  }
  EXPECT_GT(jumped, 10);
  EXPECT_THROW(solve(Design{}, scene, {.method = "gsl-bsimp"}), InputError);
  EXPECT_THROW(solve(Design{}, scene, {.method = "gsl-msadams"}), InputError);
}

TEST(Pendulum, EndsThoughItReboundsForEverOrItsTimeIsOverInFlight) {
  Design design;
  design.slope = 0.0, design.mass_ratio = 2.0, design.offset_ratio = 0.568;
  design.motor_torque = 0.6, design.no_load_speed = 8.0, design.mu_static = 2.0;
  Scene scene = with(Friction::coulomb);
  scene.hop_height = 10.0, scene.runway = 1e6, scene.motor_in_flight = false;
  design.restitution = 1.0;
  EXPECT_NE(solve(design, scene).status, Status::jumped);
  scene.runway = 5.0, scene.motor_in_flight = true, scene.patience = 2.5, design.restitution = 0.0;
  EXPECT_EQ(solve(design, scene).status, Status::stalled);
  EXPECT_EQ(referee::Referee(scene, 1e-12).solve(design).status, Status::stalled);
}

TEST(Pendulum, ATorqueThatOnlyTouchesItsLimitLetsNothingGo) {
  // The brake that holds it needs all but all of its torque at one moment.
  Design design;
  design.slope = 0.47514001630829467, design.mass_ratio = 15.17092911901087;
  design.offset_ratio = 0.7389402095478783, design.inertia_factor = 0.8801513373517766;
  design.release_spin = 0.5156789635661707, design.pendulum_angle = 0.2491200350172189;
  design.pendulum_spin = 0.5679887020223422, design.motor_torque = -0.5235456951549398;
  design.motor_target = 3.0;
  const Scene scene = with(Friction::coulomb, MotorLaw::until_angle);
  const double slipped = solve(design, scene, {.method = "gsl-rkf45", .tolerance = 1e-11}).slip_distance;
  EXPECT_NEAR(slipped, 31.3666, 1e-3);
  for (const double tolerance : {1e-9, 1e-10, 1e-11, 1e-12})
    EXPECT_NEAR(solve(design, scene, {.tolerance = tolerance}).slip_distance, slipped, 1e-5) << tolerance;
}

TEST(Pendulum, AnAngleIsSoughtWithAGainAndOnlyWithOne) {
  Design design;
  design.slope = 0.0, design.pendulum_angle = 0.5, design.motor_torque = 3.0, design.motor_target = 0.0;
  const Scene scene = with(Friction::sticking, MotorLaw::angle);
  EXPECT_THROW(solve(design, scene), InputError);
  design.motor_gain = 2.0, design.motor_damping = 1.0;
  EXPECT_NE(solve(design, scene).status, Status::failed);
}

TEST(Pendulum, ItsParametersAreTheLastOfTheTableAsThePageCounts) {
  bool begun = false;
  for (const Parameter& parameter : parameters()) {
    const bool is_its_own = parameter.only_of.model == Mechanism::pendulum;
    EXPECT_TRUE(is_its_own || !begun) << parameter.name;
    begun = begun || is_its_own;
  }
}

TEST(Pendulum, EndsAsItShouldWhereNothingMoves) {
  Design design;
  design.slope = 0.0;
  EXPECT_EQ(solve(design, level).status, Status::stalled);  // it hangs
  for (const double length : {1.0, 0.3, 0.1, 0.01}) {       // balanced on its head, but for roundings
    design.offset_ratio = length, design.pendulum_angle = std::numbers::pi;
    EXPECT_TRUE(trace(design, level, {.interval = 0.1}).phases.empty()) << length;
  }
  design = {}, design.slope = 0.0;
  design.mass_ratio = 0.0, design.motor_torque = 1.0;
  EXPECT_EQ(solve(design, level).status, Status::indeterminate);
  design = {}, design.slope = 0.0, design.inertia_factor = 0.0;
  EXPECT_EQ(solve(design, level).status, Status::indeterminate);
  design = {}, design.slope = 0.0, design.pendulum_angle = 1.0;  // it swings for ever
  EXPECT_EQ(solve(design, level).status, Status::stalled);
}

/// How designs ended by both methods, and the worst difference of what both tell. Where sliding runs into
/// Painleve's edge as n0 falls to zero, both give up.
struct Compared {
  int designs = 0, jumped = 0, failed = 0;
  double worst = 0.0;
};

Compared compare(Friction friction, MotorLaw law, int count, unsigned seed) {
  Draws draws{std::mt19937_64(seed)};
  Scene scene = with(friction, law);
  scene.patience = 40.0;
  referee::Referee referee(scene, 1e-12, 100'000);
  Compared all;
  for (int k = 0; k < count; ++k) {
    Design design = random_robot(draws);
    add_law(draws, law, design);
    if (friction == Friction::coulomb) {
      design.mu_static = draws.between(0.2, 1.5);
      design.restitution = draws.below(3) ? 0.0 : draws.between(0.0, 0.6);
    }
    const Outcome ours = solve(design, scene, {.tolerance = 1e-11}), theirs = referee.solve(design);
    ++all.designs;
    if (ours.status == Status::failed && theirs.status == Status::failed) {
      ++all.failed;
      continue;
    }
    if (!same_flags(ours, theirs)) {
      ADD_FAILURE() << "design " << k << ": " << name_of(ours.status) << ", " << name_of(theirs.status)
                    << ", " << int{ours.candidates} << ", " << int{theirs.candidates} << ", "
                    << phase_letters(ours.phase_sequence) << ", " << phase_letters(theirs.phase_sequence);
      continue;
    }
    all.jumped += ours.status == Status::jumped;
    for (const Field& field : map_fields()) {
      const auto* quantity = std::get_if<Quantity>(&field.source);
      if (!quantity) continue;
      const double a = ours.*quantity->member, b = theirs.*quantity->member;
      if (std::isnan(b)) continue;
      EXPECT_NEAR(a, b, 1e-7 * (1.0 + std::abs(b))) << field.name << " of design " << k;
      all.worst = std::max(all.worst, std::abs(a - b) / (1.0 + std::abs(b)));
    }
  }
  return all;
}

class OfLaw : public ::testing::TestWithParam<std::size_t> {};

TEST_P(OfLaw, RandomRobotsWithoutSlipAreAsTheRefereeHasThem) {
  const Compared all =
      compare(Friction::sticking, laws[GetParam()], 60, 11 + static_cast<unsigned>(GetParam()));
  EXPECT_GT(all.jumped, 10);
  EXPECT_LE(all.failed, 2);
  RecordProperty("worst", std::to_string(all.worst));
}

TEST_P(OfLaw, RandomRobotsWithFrictionAreAsTheRefereeHasThem) {
  const Compared all =
      compare(Friction::coulomb, laws[GetParam()], 60, 21 + static_cast<unsigned>(GetParam()));
  EXPECT_GT(all.jumped, 10);
  EXPECT_LE(all.failed, 2);
}

INSTANTIATE_TEST_SUITE_P(Pendulum, OfLaw, ::testing::Range<std::size_t>(0, 5));

}  // namespace
}  // namespace leapmap::pendulum
