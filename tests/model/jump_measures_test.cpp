// SPDX-License-Identifier: GPL-3.0-or-later
/// How far jumps go and how hard they land: against the referee, which has none of their formulas, against
/// integration, against their differences, and against momentum and energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "leapmap/gradient.hpp"
#include "leapmap/solve.hpp"
#include "referee/referee.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap {
namespace {

class Measures : public ::testing::TestWithParam<Friction> {};
INSTANTIATE_TEST_SUITE_P(BothModels, Measures, ::testing::Values(Friction::sticking, Friction::coulomb),
                         [](const auto& of) {
                           return of.param == Friction::coulomb ? "Coulomb" : "Sticking";
                         });

/// The largest difference of two outcomes' measures, relative to one more than their size.
double measure_difference(const Outcome& a, const Outcome& b) {
  double most = 0.0;
  for (const auto& row : measure_rows<double>)
    most = std::max(most, std::abs(a.*row.kept - b.*row.kept) / (1.0 + std::abs(b.*row.kept)));
  return most;
}

TEST_P(Measures, AreThoseOfTheRefereeAndOfIntegration) {
  std::mt19937_64 random(49);
  const Scene scene = testing::unit_scene(GetParam());
  referee::Referee referee(scene, 1e-13);
  int jumps = 0;
  std::vector<double> of_referee, of_integration;
  const int count = static_cast<int>(testing::how_many(400));
  for (int i = 0; i < count; ++i) {
    const Design design = testing::either_way(random, GetParam());
    const Outcome ours = solve(design, scene, {.tolerance = 1e-12});
    for (const auto& row : measure_rows<double>)
      EXPECT_EQ(std::isfinite(ours.*row.kept), ours.status == Status::jumped) << i;
    if (ours.status != Status::jumped) continue;
    ++jumps;
    if (const Outcome theirs = referee.solve(design); same_flags(ours, theirs))
      of_referee.push_back(measure_difference(ours, theirs));
    const Outcome stepped = solve(design, scene, {.method = "gsl-rk8pd", .tolerance = 1e-12});
    if (same_flags(ours, stepped)) of_integration.push_back(measure_difference(ours, stepped));
  }
  // A few lie so near a cliff that the methods differ by what they amplify; the bulk shows the formulas.
  for (std::vector<double>* errors : {&of_referee, &of_integration}) {
    EXPECT_GT(errors->size(), 0.9 * jumps);
    std::ranges::sort(*errors);
    EXPECT_LT((*errors)[errors->size() * 95 / 100], 1e-10);
  }
  EXPECT_GT(jumps, count * 3 / 8);
}

TEST_P(Measures, KeepMomentumAndLoseEnergy) {
  std::mt19937_64 random(50);
  const Scene scene = testing::unit_scene(GetParam());
  int jumps = 0;
  for (int i = 0; i < 300; ++i) {
    Design design = testing::either_way(random, GetParam());
    design.restitution = 0.0;
    const Outcome o = solve(design, scene);
    if (o.status != Status::jumped) continue;
    ++jumps;
    // The centre of mass, which flies a parabola, has its normal velocity changed by the impulse alone: from
    // what it has before the landing to that of a hoop that stays on the plane and turns.
    const Hoop<double> hoop = reduce<double>(design, scene);
    const ContactState<double> before =
        after_flight(hoop, ContactState<double>{.angle = o.jump_angle, .spin = o.jump_spin}, o.flight_time);
    const double lever = hoop.rho * std::sin(before.angle);
    if (GetParam() == Friction::sticking) {
      const double after =
          spin_after_holding(hoop, trig(before.angle), before.slip + before.spin, before.normal, before.spin);
      EXPECT_NEAR(o.landing_impulse, o.landing_normal_speed + lever * (after - before.spin), 1e-11);
    } else {
      EXPECT_NEAR(o.landing_impulse, o.landing_normal_speed + lever * (o.landing_spin - before.spin), 1e-11);
    }
    EXPECT_GT(o.landing_normal_speed, 0.0);
    EXPECT_GE(o.landing_energy_lost, -1e-13);
    // Not more than there is, in all.
    EXPECT_LT(o.landing_energy_lost,
              0.5 * (std::pow(1.0 + std::abs(o.landing_tangential_speed) + std::abs(o.jump_spin), 2) +
                     std::pow(o.landing_normal_speed + std::abs(o.jump_spin), 2)));
  }
  EXPECT_GT(jumps, 100);
}

TEST_P(Measures, HaveTheDerivativesOfTheirDifferences) {
  std::mt19937_64 random(51);
  const Scene scene = testing::unit_scene(GetParam());
  const SolveOptions fine{.tolerance = 1e-13};
  int compared = 0;
  for (int i = 0; i < 25; ++i) {
    Design design = testing::either_way(random, GetParam());
    design.offset_ratio = std::min(design.offset_ratio, 0.98);
    if (solve(design, scene, fine).status != Status::jumped) continue;
    for (const auto& row : measure_rows<double>) {
      const Design found = gradient(design, row.kept, scene, fine);
      for (double Design::*by : {&Design::slope, &Design::mass_ratio, &Design::release_angle}) {
        // Two central differences, extrapolated: errors of h^4, and of rounding over h.
        const auto quotient = [&](double h) {
          Design up = design, down = design;
          up.*by += h, down.*by -= h;
          return (solve(up, scene, fine).*row.kept - solve(down, scene, fine).*row.kept) / (2.0 * h);
        };
        const double wide = quotient(4e-5), narrow = quotient(2e-5), best = narrow + (narrow - wide) / 3.0;
        // Where the two differ a cliff or a fold is near, and no difference tells anything.
        if (!(std::abs(wide - narrow) < 1e-4 * (1.0 + std::abs(best))) || !std::isfinite(found.*by)) continue;
        EXPECT_NEAR(found.*by, best, 1e-6 * (1.0 + std::abs(best))) << i;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Measures, TheMirroredHoopFliesTheOtherWay) {
  Design design{.slope = 0.0, .mass_ratio = 3.0, .release_spin = 1.1};
  const Outcome right = solve(design);
  design.release_angle = -design.release_angle, design.release_spin = -design.release_spin;
  const Outcome left = solve(design);
  ASSERT_EQ(right.status, Status::jumped);
  EXPECT_DOUBLE_EQ(left.jump_range, -right.jump_range);
  EXPECT_DOUBLE_EQ(left.landing_tangential_speed, -right.landing_tangential_speed);
  EXPECT_DOUBLE_EQ(left.landing_impulse, right.landing_impulse);
}

}  // namespace
}  // namespace leapmap
