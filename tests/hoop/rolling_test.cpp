// SPDX-License-Identifier: GPL-3.0-or-later
#include "hoop/rolling.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "support/designs.hpp"

namespace leapmap {
namespace {

/// A hoop in the paper's own dimensional quantities, nothing shared with src/.
struct DimensionalHoop {
  double m, m_p, R, L, I, g, theta;
};

/// The paper's (7)-(9) with both constraints (1), (2) differentiated twice, as one saddle-point system in
/// (x'', y'', phi'', lambda_f, lambda_n).
Eigen::Matrix<double, 5, 1> lagrange_solution(const DimensionalHoop& h, double phi, double phi_dot) {
  const double M = h.m + h.m_p, s = std::sin(phi), c = std::cos(phi), w2 = phi_dot * phi_dot;
  Eigen::Matrix<double, 5, 5> A = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> b;
  A.topLeftCorner<3, 3>() << M, 0, -h.m_p * h.L * c,  //
      0, M, h.m_p * h.L * s,                          //
      -h.m_p * h.L * c, h.m_p * h.L * s, h.I + h.m_p * h.L * h.L;
  const Eigen::Matrix<double, 3, 2> constraint_forces =
      (Eigen::Matrix<double, 3, 2>() << 1, 0, 0, 1, -h.R, 0).finished();
  A.topRightCorner<3, 2>() = -constraint_forces;
  A.bottomLeftCorner<2, 3>() = constraint_forces.transpose();  // x'' - R phi'' = 0, y'' = 0
  b << -h.m_p * w2 * h.L * s + M * h.g * std::sin(h.theta),    //
      -h.m_p * w2 * h.L * c - M * h.g * std::cos(h.theta),     //
      -h.m_p * h.g * h.L * std::sin(h.theta + phi), 0, 0;
  return A.fullPivLu().solve(b);
}

TEST(Rolling, AccelerationAndBothForcesEqualThePapersThreeCoordinateLagrangeEquations) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) {
    const DimensionalHoop h{testing::uniform(random, 0.001, 0.1),
                            testing::uniform(random, 0.001, 0.1),
                            testing::uniform(random, 0.01, 0.5),
                            0.0,
                            0.0,
                            testing::uniform(random, 1.0, 25.0),
                            testing::uniform(random, 0.0, 1.5)};
    DimensionalHoop hoop = h;
    Design design;
    design.slope = h.theta;
    design.mass_ratio = h.m_p / h.m;
    design.offset_ratio = testing::uniform(random, 0.0, 1.0);
    design.inertia_factor = testing::uniform(random, 0.1, 1.0);
    hoop.L = design.offset_ratio * h.R;
    hoop.I = design.inertia_factor * h.m * h.R * h.R;
    const double angle = testing::uniform(random, -10.0, 30.0), spin = testing::uniform(random, -3.0, 3.0);
    const double rate = std::sqrt(h.g / h.R), weight = (h.m + h.m_p) * h.g;

    const auto expected = lagrange_solution(hoop, angle, spin * rate);
    const Hoop<double> groups = reduce<double>(design);
    const Trig<double> phi = trig(angle);
    const double acceleration = angular_acceleration(groups, phi, spin);
    // The saddle-point system's condition is below 1e4 here; forces reach some tens of weights.
    const double tolerance = 1e-10;
    EXPECT_NEAR(acceleration, expected(2) / (rate * rate), tolerance);
    EXPECT_NEAR(friction_force(groups, phi, spin, acceleration), expected(3) / weight, tolerance);
    EXPECT_NEAR(normal_force(groups, phi, spin, acceleration), expected(4) / weight, tolerance);
  }
}

TEST(Rolling, EnergyDoesNotChangeAlongTheMotion) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Hoop<long double> hoop = reduce<long double>(testing::random_design(random));
    const long double angle = testing::uniform(random, 0.0, 30.0), spin = testing::uniform(random, 0.0, 3.0);
    const long double a = angular_acceleration(hoop, trig(angle), spin);
    const long double h = 1e-5L;
    // dE/dt = E_phi w + E_w phi'' by central differences: error of order h^2 times third derivatives below
    // 1e3.
    const long double by_angle =
        (rolling_energy(hoop, angle + h, spin) - rolling_energy(hoop, angle - h, spin)) / (2 * h);
    const long double by_spin =
        (rolling_energy(hoop, angle, spin + h) - rolling_energy(hoop, angle, spin - h)) / (2 * h);
    EXPECT_LE(std::abs(by_angle * spin + by_spin * a), 1e-7L);
  }
}

TEST(Rolling, GradientAndForceRateEqualDifferenceQuotients) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const Hoop<long double> hoop = reduce<long double>(testing::random_design(random));
    const long double angle = testing::uniform(random, 0.0, 30.0), spin = testing::uniform(random, 0.0, 3.0);
    const auto acceleration_at = [&](long double p, long double w) {
      return angular_acceleration(hoop, trig(p), w);
    };
    const auto force_at = [&](long double p, long double w) {
      return normal_force(hoop, trig(p), w, acceleration_at(p, w));
    };
    const long double a = acceleration_at(angle, spin), h = 1e-5L;
    const auto gradient = acceleration_gradient(hoop, trig(angle), spin, a);
    // Central differences err by h^2 times third derivatives, which grow with 1 / J^3: below 1e4 here.
    const long double tolerance = 1e-6L;
    EXPECT_LE(std::abs(gradient.by_angle -
                       (acceleration_at(angle + h, spin) - acceleration_at(angle - h, spin)) / (2 * h)),
              tolerance);
    EXPECT_LE(std::abs(gradient.by_spin -
                       (acceleration_at(angle, spin + h) - acceleration_at(angle, spin - h)) / (2 * h)),
              tolerance);
    const long double rate = (force_at(angle + h, spin) - force_at(angle - h, spin)) / (2 * h) * spin +
                             (force_at(angle, spin + h) - force_at(angle, spin - h)) / (2 * h) * a;
    EXPECT_LE(std::abs(normal_force_rate(hoop, trig(angle), spin, a) - rate), 10 * tolerance);
  }
}

TEST(Rolling, ASymmetricHoopRollsWithHalfTheSlopesGravityAndNeverLifts) {
  Design design;
  design.mass_ratio = 0.0;
  const Hoop<double> hoop = reduce<double>(design);
  for (const double spin : {0.0, 1.0, 10.0}) {
    const double a = angular_acceleration(hoop, trig(1.0), spin);
    EXPECT_DOUBLE_EQ(a, std::sin(design.slope) / 2.0);
    EXPECT_DOUBLE_EQ(normal_force(hoop, trig(1.0), spin, a), std::cos(design.slope));
    EXPECT_DOUBLE_EQ(friction_force(hoop, trig(1.0), spin, a), -std::sin(design.slope) / 2.0);
  }
}

TEST(Rolling, VersineKeepsItsRelativeAccuracyNearZero) {
  const double angle = 1e-9;  // 1 - cos(1e-9) in double is 0; the truth is 5e-19
  EXPECT_NEAR(trig(angle).versine / 5e-19, 1.0, 1e-15);
}

TEST(Rolling, FrictionKeepsItsDigitsWhereTheMassIsOnTheRimOfNearlyNothing) {
  Design design{.slope = 0.4, .mass_ratio = 1e12, .offset_ratio = 1.0};
  for (const double angle : {1e-7, 1e-6, 1e-4, 0.1}) {
    const auto force = [&]<class T>(T) {
      const Hoop<T> hoop = reduce<T>(design);
      const Trig<T> phi = trig(T(angle));
      const T spin = std::sqrt(T(0.8) / contact_inertia(hoop, phi)),
              acceleration = angular_acceleration(hoop, phi, spin);
      return std::pair{friction_force(hoop, phi, spin, acceleration),
                       friction_force_rate(hoop, phi, spin, acceleration)};
    };
    const auto found = force(0.0);
    const auto right = force(0.0L);
    // Some roundings of its terms, which the textbook's 1 - rho cos(phi) loses by the thousand.
    EXPECT_NEAR(found.first / static_cast<double>(right.first), 1.0, 1e-12) << angle;
    EXPECT_NEAR(found.second / static_cast<double>(right.second), 1.0, 1e-11) << angle;
  }
}

TEST(Rolling, TheRateOfFrictionIsThatOfItsDifferences) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 500; ++i) {
    const Hoop<long double> hoop =
        reduce<long double>(Design{.slope = testing::uniform(random, 0.1, 0.8),
                                   .mass_ratio = testing::uniform(random, 0.5, 10.0),
                                   .offset_ratio = testing::uniform(random, 0.3, 1.0)});
    const long double angle = testing::uniform(random, 0.0, 6.0), spin = testing::uniform(random, -3.0, 3.0);
    const long double acceleration = angular_acceleration(hoop, trig(angle), spin), h = 1e-5L;
    // Along the motion, but for a share h^2 of its third derivatives, which needles make up to some
    // thousands.
    const auto force = [&](long double t) {
      const long double there = angle + t * (spin + 0.5L * t * acceleration),
                        turning = spin + t * (acceleration +
                                              0.5L * t * angular_jerk(hoop, trig(angle), spin, acceleration));
      const Trig<long double> phi = trig(there);
      return friction_force(hoop, phi, turning, angular_acceleration(hoop, phi, turning));
    };
    const long double rate = friction_force_rate(hoop, trig(angle), spin, acceleration),
                      difference = (force(h) - force(-h)) / (2.0L * h);
    EXPECT_NEAR(static_cast<double>(rate), static_cast<double>(difference),
                1e-6 * (1.0 + std::abs(static_cast<double>(rate))));
  }
}

}  // namespace
}  // namespace leapmap
