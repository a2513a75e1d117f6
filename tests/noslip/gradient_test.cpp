// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/gradient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "leapmap/gradient.hpp"
#include "model/fields.hpp"
#include "support/designs.hpp"
#include "support/differences.hpp"
#include "support/reference_table.hpp"

namespace leapmap {
namespace {

using testing::either_way;
using testing::unit_scene;

GradientWanted everything(std::size_t parameters) {
  GradientWanted wanted;
  for (const Field& field : map_fields())
    if (const auto* quantity = std::get_if<Quantity>(&field.source)) wanted.of.push_back(quantity->member);
  for (std::size_t k = 0; k < parameters; ++k) wanted.by.push_back(k);
  return wanted;
}

TEST(RollingGradients, AreThoseOfTheTableInFortyDigits) {
  const auto rows = testing::read_reference("noslip_gradient.csv");
  std::vector<Design> designs;
  for (const testing::ReferenceRow& row : rows) designs.push_back(row.design());
  std::vector<Outcome> outcomes(designs.size());
  const GradientWanted wanted = everything(without_slip);
  Gradients gradients(wanted);
  RollingGradients(1e-10, {}, wanted).solve(designs, testing::idle_scene(), outcomes, gradients);
  std::size_t compared = 0;
  for (const Field& field : gradient_fields()) {
    const auto& [of, by, hoop] = std::get<Derivative>(field.source);
    const std::string name(field.name);
    if (!rows[0].cells.contains(name)) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!rows[i].has(name)) continue;
      ++compared;
      // Roundings of times to lift-offs, which grow with the way; the worst here is 2e-12.
      EXPECT_NEAR(gradients.column(of, by)[i] / rows[i].number(name), 1.0, 1e-11) << name << " of row " << i;
    }
  }
  EXPECT_GT(compared, 1500u);
}

TEST(RollingGradients, AgreeWithDifferencesOfLongDoublesWhicheverWayAHoopIsReleased) {
  std::mt19937_64 random(20261123);
  const Scene scene = unit_scene();
  std::vector<Design> designs;
  for (int i = 0; i < 300; ++i) designs.push_back(either_way(random));
  std::vector<Outcome> outcomes(designs.size());
  const GradientWanted wanted = everything(without_slip);
  Gradients gradients(wanted);
  RollingGradients(1e-10, {}, wanted).solve(designs, scene, outcomes, gradients);
  // The differences' own error is allowed, and 1e-6 of a scale of a thousandth.
  const testing::Comparison found =
      testing::compare_with_differences(designs, scene, outcomes, gradients, 1e-6);
  EXPECT_EQ(found.wrong, 0u) << found.first_wrong;
  EXPECT_EQ(found.missing, 0u) << found.first_missing;
  EXPECT_GT(found.compared, 8'000u);
}

TEST(RollingGradients, DoNotDependOnTheCompanyInTheLanesBeyondRounding) {
  std::mt19937_64 random(5);
  std::vector<Design> designs;
  for (int i = 0; i < 64; ++i) designs.push_back(either_way(random));
  const GradientWanted wanted = everything(without_slip);
  RollingGradients solver(1e-10, {}, wanted);
  std::vector<Outcome> outcomes(designs.size());
  Gradients together(wanted), alone(wanted);
  solver.solve(designs, unit_scene(), outcomes, together);
  std::size_t compared = 0;
  for (std::size_t d = 0; d < designs.size(); ++d) {
    Outcome outcome;
    solver.solve({&designs[d], 1}, unit_scene(), {&outcome, 1}, alone);
    for (std::size_t i = 0; i < wanted.of.size(); ++i)
      for (std::size_t j = 0; j < wanted.by.size(); ++j) {
        const double a = together.column(i, j)[d], b = alone.column(i, j)[0];
        EXPECT_EQ(std::isnan(a), std::isnan(b));
        if (std::isnan(a)) continue;
        ++compared;
        EXPECT_NEAR(a, b, 1e-9 * (1e-3 + std::abs(b)));  // times' numbers of nodes are shared
      }
  }
  EXPECT_GT(compared, 1'000u);
}

/// The paper's hoop on a slope where its first lift-off has just been born.
TEST(RollingGradients, AreLargeAndRightBesideAFoldAndNaNOnIt) {
  Scene scene = unit_scene();
  scene.hop_height = 0.0;
  const auto first_angle = [&](double slope) {
    Design design;
    design.slope = slope;
    Outcome outcome;
    ExactSolver<long double>(1e-15).solve({&design, 1}, scene, {&outcome, 1});
    return outcome.jump_angle;
  };
  double below = 0.543, above = 0.544;  // between them the lift-off at 4.6 radians is born
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (below + above);
    (first_angle(middle) > 6.0 ? below : above) = middle;
  }
  const auto by_slope = [&](double slope) {
    Design design;
    design.slope = slope;
    return gradient(design, &Outcome::jump_angle, scene).slope;
  };
  // It goes with the root of the distance; a difference over a hundredth of that is right to 1e-5.
  for (const double distance : {1e-4, 1e-6, 1e-8}) {
    const double slope = above + distance, h = 0.01 * distance;
    const double differences = (first_angle(slope + h) - first_angle(slope - h)) / (2.0 * h);
    EXPECT_NEAR(by_slope(slope) / differences, 1.0, 1e-4) << distance;
    EXPECT_LT(by_slope(slope), -0.5 / std::sqrt(distance));
  }
  EXPECT_TRUE(std::isnan(by_slope(above + 1e-13))) << "where its root is known to half its digits";
}

TEST(RollingGradients, OfATimeFromRestByTheSpinIsThatOfASpinEitherWay) {
  const auto time = [](double spin) {
    Design design;
    design.release_angle = 3.6;
    design.release_spin = spin;
    return solve(design, unit_scene(), SolveOptions{.tolerance = 1e-13}).jump_time;
  };
  Design design;
  design.release_angle = 3.6;
  constexpr double h = 1e-4;
  EXPECT_NEAR(gradient(design, &Outcome::jump_time, unit_scene()).release_spin,
              (time(h) - time(-h)) / (2.0 * h), 1e-6);  // the error of differences, h squared
}

/// Uphill it turns round a hair from where it was released; time is a smooth function of the spin through
/// zero.
TEST(RollingGradients, OfTimesBySmallSpinsEitherWayAreThatFromRest) {
  const auto by_spin = [](double spin, Friction friction) {
    Design design;
    design.release_spin = spin;
    return gradient(design, &Outcome::jump_time, unit_scene(friction)).release_spin;
  };
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const double at_rest = by_spin(0.0, friction);
    EXPECT_LT(at_rest, -1.0);
    for (const double size : {1e-12, 1e-9, 3e-9, 1e-8, 3e-8, 1e-7, 1e-6})
      for (const double way : {-1.0, 1.0})
        // It changes by about as much as the spin does.
        EXPECT_NEAR(by_spin(way * size, friction), at_rest, 10.0 * size + 1e-9) << way * size;
  }
}

/// A hoop released uphill that just comes over the top: the time goes with the logarithm of how nearly.
TEST(RollingGradients, OfTimesBesideAStallAreRightOrNaN) {
  const auto told = [](double e) {
    Design design;
    design.slope = 0.1, design.mass_ratio = 3.0, design.release_angle = 5.0;
    design.release_spin = -0.8790838552403418 - e;
    return e * gradient(design, &Outcome::jump_time, {}).release_spin;
  };
  const double right = told(1e-7);
  EXPECT_NEAR(told(1e-8), right, 1e-5 * std::abs(right));
  std::size_t told_so = 0;
  for (const double e : {1e-10, 1e-11, 1e-12, 1e-13, 1e-14}) {
    const double found = told(e);
    told_so += std::isnan(found);
    // The place of the stall itself is known to 1e-16.
    if (std::isnan(found)) continue;
    EXPECT_NEAR(found, right, (1e-5 + 3e-16 / e) * std::abs(right)) << e;
  }
  EXPECT_GE(told_so, 2u);
}

TEST(Gradients, OfDesignsAreInSecondsAndNaNByWhatTheModelHasNot) {
  const Design hoop;
  const Design si = gradient(hoop, &Outcome::jump_time),
               own = gradient(hoop, &Outcome::jump_time, unit_scene());
  EXPECT_NEAR(si.slope / own.slope, time_unit(Scene{}), 1e-14);
  EXPECT_TRUE(std::isnan(si.mu_static) && std::isnan(si.mu_kinetic) && std::isnan(si.restitution));
  Design never;
  never.mass_ratio = 0.0;
  EXPECT_TRUE(std::isnan(gradient(never, &Outcome::jump_height).slope));
  EXPECT_THROW(gradient(hoop, &Outcome::jump_height, {}, {.method = "gsl-rk8pd"}), InputError);
  EXPECT_TRUE(gradient(std::span<const Design>{}, &Outcome::jump_height).empty());
}

}  // namespace
}  // namespace leapmap
