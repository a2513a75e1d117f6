// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing's hoop, and the numbers that matter to its motion.
#include "leapmap/body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hoop/parameters.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/solve.hpp"

namespace leapmap {
namespace {

constexpr double pi = std::numbers::pi;

/// A hoop of 120 mm: a ring from CAD, a slug and a battery opposite.
Body drawing() {
  return {.diameter = 0.12,
          .mass = 0.061,
          .inertia = 1.9e-4,
          .weights = {{.name = "slug", .mass = 0.085, .at = 0.047},
                      {.name = "battery", .mass = 0.012, .at = 0.030, .angle = pi}}};
}

TEST(Bodies, OfADrawingHaveTheMassFirstMomentAndInertiaThatOneAddsUpByHand) {
  const ReducedBody reduced = reduce_body(drawing());
  const double M = 0.158, R = 0.06;
  EXPECT_DOUBLE_EQ(reduced.total_mass, M);
  EXPECT_NEAR(reduced.eccentricity, 3635e-6 / (M * R), 1e-15);
  const double J = 1.9e-4 + 0.085 * 0.047 * 0.047 + 0.012 * 0.03 * 0.03;
  EXPECT_NEAR(reduced.inertia, J / (M * R * R), 1e-15);
}

TEST(Bodies, HaveADesignOfTheirEccentricityAndInertiaHoweverTheirWeightsLie) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < 10'000; ++n) {
    Body body{.diameter = 0.01 + unit(random), .mass = 0.01 + unit(random)};
    const double R = 0.5 * body.diameter;
    if (n % 2 == 0) body.inertia = unit(random) * body.mass * R * R;
    double M = body.mass, x = 0.0, y = 0.0;
    double J = std::isnan(body.inertia) ? body.mass * R * R : body.inertia;
    for (int k = 0; k < n % 5; ++k) {
      const Weight weight{"w" + std::to_string(k), unit(random), R * unit(random), 2.0 * pi * unit(random),
                          1e-3 * unit(random)};
      body.weights.push_back(weight);
      M += weight.mass, J += weight.inertia + weight.mass * weight.at * weight.at;
      x += weight.mass * weight.at * std::cos(weight.angle),
          y += weight.mass * weight.at * std::sin(weight.angle);
    }
    const ReducedBody reduced = reduce_body(body);
    Design design;
    Scene scene;
    apply_body(reduced, body, design, scene);
    const Hoop<double> hoop = reduce<double>(design);
    const double rho = std::hypot(x, y) / (M * R), J0 = J / (M * R * R);
    constexpr double rounding = 1e-14;  // some tens of roundings of sums of numbers up to 1 or J0
    EXPECT_NEAR(hoop.rho, rho, rounding);
    EXPECT_NEAR(hoop.Ic, J0 - rho * rho, rounding * (1.0 + J0));
    EXPECT_NEAR(reduced.eccentricity, rho, rounding);
    EXPECT_NEAR(reduced.inertia, J0, rounding * (1.0 + J0));
    EXPECT_NEAR(scene.mass, M, rounding * M);
    EXPECT_EQ(scene.radius, R);
    EXPECT_LE(design.offset_ratio, 1.0);
    EXPECT_GE(design.inertia_factor, 0.0);
  }
}

TEST(Bodies, OfTheSameTwoNumbersJumpTheSame) {
  const ReducedBody one = reduce_body(drawing());
  // The slug in two halves beside each other, and their spread taken off the ring's inertia.
  Body split = drawing();
  split.weights[0].mass *= 0.5;
  split.weights[0].angle = 0.3, split.weights[0].at = 0.047 / std::cos(0.3);
  split.weights.push_back(split.weights[0]);
  split.weights.back().name = "other half", split.weights.back().angle = -0.3;
  split.inertia -= 0.085 * 0.047 * 0.047 * std::tan(0.3) * std::tan(0.3);
  const ReducedBody two = reduce_body(split);
  Design of_one{.slope = 0.5}, of_two{.slope = 0.5};
  Scene scene;
  apply_body(one, drawing(), of_one, scene);
  apply_body(two, split, of_two, scene);
  const Outcome first = solve(of_one, scene), second = solve(of_two, scene);
  ASSERT_EQ(first.status, Status::jumped);
  EXPECT_NEAR(first.jump_height, second.jump_height, 1e-12);  // a few roundings of the ratios, as they grow
  EXPECT_NEAR(first.jump_time, second.jump_time, 1e-12);
}

TEST(Bodies, OfAThinRingAndOneWeightOnItsRimAreThePapersRatios) {
  const ReducedBody reduced = reduce_body(
      {.diameter = 0.082, .mass = 0.0082, .weights = {{.name = "m", .mass = 0.020, .at = 0.041}}});
  EXPECT_DOUBLE_EQ(reduced.mass_ratio, 20.0 / 8.2);
  EXPECT_DOUBLE_EQ(reduced.offset_ratio, 1.0);
  EXPECT_DOUBLE_EQ(reduced.inertia_factor, 1.0);
}

TEST(Bodies, ThatCannotBeAreRefusedWithTheKey) {
  const auto refusal = [](auto change) -> std::string {
    Body body = drawing();
    change(body);
    try {
      static_cast<void>(reduce_body(body));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const double bad : {-1.0, -0.001, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(refusal([&](Body& b) { b.diameter = bad; }).starts_with("hoop.diameter = ")) << bad;
    EXPECT_TRUE(refusal([&](Body& b) { b.mass = bad; }).starts_with("hoop.mass = ")) << bad;
    EXPECT_TRUE(refusal([&](Body& b) { b.weights[0].mass = bad; }).starts_with("hoop.slug.mass = ")) << bad;
    EXPECT_TRUE(refusal([&](Body& b) { b.weights[0].at = bad; }).starts_with("hoop.slug.at = ")) << bad;
    EXPECT_TRUE(refusal([&](Body& b) { b.weights[1].inertia = bad; }).starts_with("hoop.battery.inertia"))
        << bad;
  }
  EXPECT_TRUE(refusal([](Body& b) { b.mass = 0.0; }).starts_with("hoop.mass = 0 "));
  EXPECT_TRUE(refusal([](Body& b) { b.inertia = -1e-9; }).starts_with("hoop.inertia = -1e-09"));
  EXPECT_TRUE(refusal([](Body& b) { b.weights[0].angle = 180.0; }).starts_with("hoop.slug.angle = 180"));
  EXPECT_TRUE(refusal([](Body& b) { b.weights[0].at = 0.061; }).starts_with("hoop.slug.at = 0.061"));
  EXPECT_NE(refusal([](Body& b) { b.weights[1].name = "slug"; }).find("'slug' appears twice"),
            std::string::npos);
}

}  // namespace
}  // namespace leapmap
