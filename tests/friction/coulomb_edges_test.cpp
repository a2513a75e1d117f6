// SPDX-License-Identifier: GPL-3.0-or-later
/// Designs with friction aimed at the places where the solver changes its mind: the stick limit, n0 = 0 at
/// release, slow releases, Painleve's edge, dips of n0; against long double. LEAPMAP_AIMED: how many.
#include <gtest/gtest.h>

#include <cstdlib>

#include "friction/coulomb.hpp"
#include "hoop/painleve.hpp"
#include "hoop/stick.hpp"
#include "support/aimed.hpp"
#include "support/exact.hpp"

namespace leapmap {
namespace {

using testing::coulomb, testing::how_many, testing::nudged, testing::uniform;

constexpr double tolerance = 1e-10;

Outcome solved(const Design& design, const Scene& scene = coulomb, double asked = tolerance) {
  return CoulombSolver<double>(asked).solve(design, scene);
}
Outcome truth_of(const Design& design, const Scene& scene = coulomb) {
  return CoulombSolver<long double>(1e-12).solve(design, scene);
}

/// Heights and times of one outcome against another's; infinity: their flags differ.
double distance(const Outcome& a, const Outcome& b) {
  if (!same_flags(a, b)) return HUGE_VAL;
  if (a.status != Status::jumped) return 0.0;
  return std::max(std::abs(a.jump_height - b.jump_height) / (1.0 + b.jump_height),
                  std::abs(a.jump_time - b.jump_time) / (1.0 + b.jump_time));
}

/// Whether ours is as near to the truth as the design's own last digits are: ten times what a unit in the
/// last place of a parameter changes, or what the truth is within some of them. (What friction holds but for
/// 32 roundings of the forces' terms, it holds.)
bool is_right(const Outcome& ours, const Outcome& truth, const Design& design, const Scene& scene) {
  const double off = distance(ours, truth);
  if (off <= tolerance) return true;
  for (double Design::*member :
       {&Design::slope, &Design::mass_ratio, &Design::offset_ratio, &Design::inertia_factor,
        &Design::release_angle, &Design::release_spin, &Design::mu_static, &Design::mu_kinetic})
    for (const int ulps : {-1, 1, -4, 4, -16, 16, -128, 128}) {
      Design beside = design;
      beside.*member = nudged(design.*member, ulps);
      if (beside.offset_ratio > 1.0 || beside.mu_static < 0.0 || std::isnan(beside.*member)) continue;
      const Outcome there = truth_of(beside, scene);
      if (distance(ours, there) <= tolerance) return true;
      if (std::isfinite(off) && off <= 10.0 * distance(there, truth)) return true;
    }
  return false;
}

Design some_design(std::mt19937_64& random) {
  Design design;
  design.slope = uniform(random, 0.05, 0.9);
  design.mass_ratio = std::exp(uniform(random, std::log(0.3), std::log(30.0)));
  design.offset_ratio = random() % 4 == 0 ? 1.0 : uniform(random, 0.3, 1.0);
  design.inertia_factor = random() % 2 == 0 ? 1.0 : 0.5;
  design.release_angle = uniform(random, 1.5, 4.7);
  design.mu_static = uniform(random, 0.1, 1.0);
  if (random() % 2 == 0) design.mu_kinetic = design.mu_static * uniform(random, 0.7, 1.0);
  design.restitution = random() % 2 == 0 ? 0.0 : uniform(random, 0.0, 0.7);
  return design;
}

int some_ulps(std::mt19937_64& random) { return std::uniform_int_distribution<int>(-3, 3)(random); }

/// Released where friction just holds, or just does not.
Design at_stick_limit(std::mt19937_64& random) {
  Design design = some_design(random);
  design.release_spin = uniform(random, 0.0, 1.5);
  const Hoop<double> hoop = reduce<double>(design);
  const Trig<double> phi = trig(design.release_angle);
  const double a = angular_acceleration(hoop, phi, design.release_spin);
  const double mu = std::abs(friction_force(hoop, phi, design.release_spin, a) /
                             normal_force(hoop, phi, design.release_spin, a));
  design.mu_static = nudged(mu, some_ulps(random));
  design.mu_kinetic = design.mu_static * uniform(random, 0.7, 1.0);
  return design;
}

/// Released where n0 vanishes.
Design at_free_fall(std::mt19937_64& random) {
  Design design = some_design(random);
  const Hoop<double> hoop = reduce<double>(design);
  const double cosine = std::min(std::cos(design.release_angle), -0.05);
  design.release_spin = nudged(std::sqrt(-hoop.cos_slope / (hoop.rho * cosine)), some_ulps(random));
  return design;
}

Design slow_release(std::mt19937_64& random) {
  Design design = some_design(random);
  design.release_spin = std::pow(10.0, uniform(random, -6.0, -1.0));
  return design;
}

/// Heavy masses from rest, whose slides run into Painleve's edge.
Design near_painleve(std::mt19937_64& random) {
  Design design;
  design.slope = uniform(random, 0.1, 0.9);
  design.mass_ratio = std::pow(10.0, uniform(random, 1.0, 3.0));
  design.offset_ratio = uniform(random, 0.3, 1.0);
  design.inertia_factor = 0.5;
  design.mu_static = uniform(random, 0.1, 1.0);
  design.mu_kinetic = design.mu_static * uniform(random, 0.7, 1.0);
  return design;
}

/// A kinetic friction with which the pivot just touches zero at an angle.
Design touching_painleve(std::mt19937_64& random) {
  Design design = near_painleve(random);
  const Hoop<double> hoop = reduce<double>(design);
  double least = HUGE_VAL;
  for (int k = 1; k < 1000; ++k) {
    const Trig<double> phi = trig(std::numbers::pi * k / 1000);
    least = std::min(least, (hoop.Ic + hoop.rho * hoop.rho * phi.sin * phi.sin) /
                                (hoop.rho * phi.sin * (hoop.clearance + hoop.rho * phi.versine)));
  }
  design.mu_kinetic =
      nudged(least * (1.0 + (random() % 2 == 0 ? 0.0 : uniform(random, -1e-6, 1e-6))), some_ulps(random));
  design.mu_static = design.mu_kinetic * uniform(random, 1.0, 1.3);
  return design;
}

void expect_right(Design (*aim)(std::mt19937_64&), unsigned seed, std::size_t count, double jumps) {
  std::mt19937_64 random(seed);
  std::size_t jumped = 0, failed = 0;
  std::string last_failed;
  for (std::size_t i = 0; i < count; ++i) {
    const Design design = aim(random);
    const Outcome ours = solved(design), truth = truth_of(design);
    jumped += ours.status == Status::jumped;
    if (ours.status == Status::failed) {
      ++failed;
      last_failed = testing::told(design) + fmt::format(" mu_static {}: {}", design.mu_static, ours.failure);
    }
    EXPECT_TRUE(is_right(ours, truth, design, coulomb))
        << testing::told(design)
        << fmt::format(" mu_static {} mu_kinetic {} restitution {}: ", design.mu_static, design.mu_kinetic,
                       design.restitution)
        << name_of(ours.status) << " " << phase_letters(ours.phase_sequence) << " "
        << fmt::format("{} {}", ours.jump_height, ours.jump_time) << ", truth " << name_of(truth.status)
        << " " << phase_letters(truth.phase_sequence) << " "
        << fmt::format("{} {}", truth.jump_height, truth.jump_time);
  }
  EXPECT_EQ(failed, 0u) << last_failed;
  EXPECT_GT(jumped, static_cast<std::size_t>(jumps * static_cast<double>(count)));
}

TEST(AimedCoulomb, AtTheStickLimit) { expect_right(at_stick_limit, 1, how_many(120), 0.5); }
TEST(AimedCoulomb, WhereFreeFallBegins) { expect_right(at_free_fall, 2, how_many(120), 0.2); }
TEST(AimedCoulomb, SlowReleases) { expect_right(slow_release, 3, how_many(120), 0.5); }
TEST(AimedCoulomb, HeavyMassesNearPainlevesEdge) { expect_right(near_painleve, 4, how_many(120), 0.2); }
TEST(AimedCoulomb, WherePainlevesRegionBegins) { expect_right(touching_painleve, 5, how_many(60), 0.05); }

/// Heavy masses from rest: neither the tolerance nor some units in the last place decide flags.
TEST(AimedCoulomb, FlagsDoNotHangOnTheTolerance) {
  std::mt19937_64 random(6);
  for (std::size_t i = 0; i < how_many(150); ++i) {
    const Design design = near_painleve(random);
    Design beside = design;
    beside.slope *= 1.0 + 2e-15, beside.mass_ratio *= 1.0 - 2e-15;
    const Outcome fine = solved(design), coarse = solved(design, coulomb, 1e-9), moved = solved(beside);
    EXPECT_NE(fine.status, Status::failed) << testing::told(design);
    if (same_flags(truth_of(design), truth_of(beside))) {
      EXPECT_TRUE(same_flags(fine, coarse) && same_flags(fine, moved)) << testing::told(design);
    }
  }
}

/// Found by aiming; the truths are two independent programs' in quadruple precision. Each was wrong before.
struct Known {
  Design design;
  double hop_height, height, time;  // time 0: not known
  const char* sequence;             // empty: not known
};

/// A hoop with so little spin slides through a runway before it turns a millionth of a radian.
TEST(AimedCoulomb, SlidesThatHardlyTurnEndWhereTheRunwayDoes) {
  for (const double spin : {1e-9, 1e-8, 1e-7, 1e-6}) {
    const Design design{.slope = 0.216690937580796,
                        .mass_ratio = 13.0,
                        .offset_ratio = 0.0,
                        .release_spin = spin,
                        .mu_static = 0.0};
    const Scene scene{.friction = Friction::coulomb, .runway = 0.3};
    const Outcome outcome = solved(design, scene);
    EXPECT_EQ(outcome.status, Status::no_jump);
    // x = w t + sin(theta) t^2 / 2 = 0.6 pi, of which w t is turned
    const double g = std::sin(design.slope), end = 0.6 * std::numbers::pi;
    const double t = (std::sqrt(spin * spin + 2.0 * g * end) - spin) / g;
    EXPECT_NEAR(outcome.slip_distance, end - spin * t, 1e-9) << spin;
  }
}

/// They took for ever: against Painleve's edge, and beside a stall.
TEST(AimedCoulomb, NoSlideAndNoRollIsEndless) {
  const Design against{.slope = 0.0,
                       .mass_ratio = 697015.0583834717,
                       .offset_ratio = 0.5,
                       .inertia_factor = 0.5,
                       .release_angle = 1.5707963267948966,
                       .release_spin = 1.0,
                       .mu_static = 0.5,
                       .restitution = 0.3471513046631715};
  EXPECT_EQ(solved(against, {.friction = Friction::coulomb, .hop_height = 1e-6, .rest_speed = 0.1}).status,
            Status::indeterminate);
  for (const double slope : {0.038851253022090526, 0.038851253021690346, 0.03885125302165033}) {
    const Design beside{.slope = slope,
                        .mass_ratio = 15.56214633204247,
                        .offset_ratio = 0.30441845510791754,
                        .release_angle = 4.3607424563955846,
                        .release_spin = 0.09023941235359072,
                        .mu_static = 1.0061521329075416,
                        .mu_kinetic = 0.17556111358616475};
    const Status status = solved(beside).status;
    EXPECT_TRUE(status == Status::no_jump || status == Status::failed) << slope;
  }
}

TEST(AimedCoulomb, KnownCases) {
  const Known cases[]{{{.slope = 0.4097929865924131,
                        .mass_ratio = 188.0803499182982,
                        .offset_ratio = 0.6728761363187696,
                        .inertia_factor = 0.5,
                        .mu_static = 0.7295130111149761,
                        .mu_kinetic = 0.6099718925469745},
                       0.05,
                       0.23097994853,
                       0.0,
                       ""},
                      {{.slope = 0.9053046051155265,
                        .mass_ratio = 24.494209566757966,
                        .offset_ratio = 0.7410647990042024,
                        .release_angle = 1.8403594587538714,
                        .release_spin = 0.8499600922619358,
                        .mu_static = 0.3396449128375314,
                        .restitution = 0.6605666024170137},
                       0.3,
                       2.68887006437,
                       0.0,
                       ""},
                      {{.slope = 0.5647115957240031,
                        .mass_ratio = 4.246058805451686,
                        .offset_ratio = 0.978398993194525,
                        .release_angle = 1.9485688953985996,
                        .release_spin = 0.0005557048838113033,
                        .mu_static = 0.8376440911782836},
                       0.05,
                       0.8759065682795,
                       9.856835703437,
                       "RSRSF"},
                      {{.slope = 0.36369480943700777,
                        .mass_ratio = 6.3997768712236915,
                        .offset_ratio = 0.6229009119847162,
                        .mu_static = 0.11204872549173449,
                        .mu_kinetic = 0.08090586380085384,
                        .restitution = 0.33657276843146977},
                       0.05,
                       0.5111272631,
                       0.0,
                       "RSSRSRSF"}};
  for (const Known& known : cases)
    for (const double asked : {1e-9, 1e-10, 1e-12}) {
      Scene scene = coulomb;
      scene.hop_height = known.hop_height;
      const Outcome outcome = solved(known.design, scene, asked);
      ASSERT_EQ(outcome.status, Status::jumped) << testing::told(known.design);
      EXPECT_NEAR(outcome.jump_height, known.height, 6e-11) << testing::told(known.design);  // as told
      if (known.time > 0.0) {
        EXPECT_NEAR(outcome.jump_time / known.time, 1.0, 1e-12);
      }
      if (*known.sequence) {
        EXPECT_EQ(phase_letters(outcome.phase_sequence), known.sequence);
      }
    }
  const Outcome dip = solved({.slope = 0.25379519526111666,
                              .mass_ratio = 5.367210185675648,
                              .offset_ratio = 0.3504671683560445,
                              .release_angle = 4.6284430373502445,
                              .release_spin = 0.9707946945133115,
                              .mu_static = 0.5832768713727738,
                              .mu_kinetic = 0.5268073996799152});
  EXPECT_EQ(phase_letters(dip.phase_sequence), "RSFSRSF");
  EXPECT_EQ(dip.spurious_first_jump, 1);
}

/// Just above what friction holds the slip gains next to nothing before it comes back to zero. It has to be
/// above zero in between all the same: else the hoop would begin to slide there again and again.
TEST(AimedCoulomb, SlidesThatHardlyBeginEnd) {
  std::mt19937_64 random(8);
  int tried = 0;
  for (int i = 0; i < 1'000; ++i) {
    Design design = some_design(random);
    design.release_angle = uniform(random, -3.0, 3.0), design.release_spin = uniform(random, -10.0, 10.0);
    const Hoop<double> hoop = reduce<double>(design, coulomb);
    const Trig<double> phi = trig(design.release_angle);
    const double turns = angular_acceleration(hoop, phi, design.release_spin),
                 N = normal_force(hoop, phi, design.release_spin, turns),
                 held = std::abs(friction_force(hoop, phi, design.release_spin, turns)) / N;
    if (!(N > 0.01) || !(held > 0.02) || !(held < 1.0)) continue;
    design.mu_static = design.mu_kinetic = held * (1.0 - std::pow(10.0, uniform(random, -12.0, -5.0)));
    ++tried;
    const Outcome outcome = solved(design);
    EXPECT_NE(outcome.status, Status::failed) << i << ": " << outcome.failure;
  }
  EXPECT_GT(tried, 200);
}

/// A slip that begins and ends before the first node of its panel, at release and on the way.
TEST(AimedCoulomb, ShortSlipsAreGoneThroughOnce) {
  for (const Design& design : {Design{.slope = 0.46232665277742052,
                              .mass_ratio = 0.72798621597940216,
                              .offset_ratio = 0.75157658302844998,
                              .release_angle = 5.233654068029046,
                              .release_spin = 1.915602291937937,
                              .mu_static = 0.45853220716226134},
                               Design{.slope = 0.2019552905056588,
                               .mass_ratio = 61.949508636908192,
                               .offset_ratio = 0.70011268964224893,
                               .inertia_factor = 0.5,
                               .release_angle = 4.8458986271553348,
                               .release_spin = 1.3180981021436946,
                               .mu_static = 0.61679745334023917}}) {
    const Outcome ours = solved(design);
    EXPECT_EQ(ours.status, Status::jumped) << testing::told(design);
    EXPECT_TRUE(is_right(ours, truth_of(design), design, coulomb)) << testing::told(design);
  }
}

/// A hoop that friction holds rolls through states in which a free one would leave the plane; released in
/// one of them it does the same.
TEST(AimedCoulomb, ReleasedWhereItWouldRollOnItRollsOn) {
  const Design earlier{.slope = 0.678287,
                       .mass_ratio = 9.0575,
                       .offset_ratio = 0.59608,
                       .inertia_factor = 0.5,
                       .release_angle = 2.60498,
                       .release_spin = 1.29,
                       .mu_static = 0.844};
  const Hoop<double> hoop = reduce<double>(earlier);
  const Roll<double> roll = begin_roll(hoop, earlier.release_angle, earlier.release_spin);
  Design later = earlier;
  later.release_angle = 2.63498;
  const Trig<double> phi = trig(later.release_angle);
  later.release_spin = std::sqrt(vis_viva(roll, later.release_angle, phi) / contact_inertia(hoop, phi));
  ASSERT_LT(free_normal_force(hoop, phi, later.release_spin * later.release_spin), 0.0);
  const Outcome a = solved(earlier), b = solved(later);
  ASSERT_EQ(a.status, Status::jumped);
  EXPECT_TRUE(same_flags(a, b)) << phase_letters(b.phase_sequence);
  EXPECT_NEAR(a.jump_height, b.jump_height, 1e-12);
  EXPECT_NEAR(a.jump_angle, b.jump_angle, 1e-12);
}

/// The pivot near its zero, by products of sines, against long double.
TEST(Painleve, ThePivotNearItsEdgeKeepsItsDigits) {
  std::mt19937_64 random(7);
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Design design = near_painleve(random);
    const auto hoop = reduce<long double>(design);
    const long double friction = design.mu_kinetic * (i % 2 == 0 ? 1.0L : -1.0L);
    if (!(sliding_coefficients(hoop, trig(3.0L), friction).pivot > 0.0L)) continue;
    for (const long double way : {1.0L, -1.0L}) {
      const long double left = left_to_edge(hoop, friction, 3.0L, way);
      if (std::isnan(left)) continue;
      ++met;
      const long double there = 3.0L + way * left;
      const PainleveEdge<double> edge{trig(static_cast<double>(there)), trig(static_cast<double>(2 * there)),
                                      static_cast<double>(way)};
      const PainleveEdge<long double> finer{trig(there), trig(2 * there), way};
      const double rate = std::abs(static_cast<double>(pivot_by_angle(hoop, trig(there), friction).rate));
      for (const double x : {1e-12, 1e-6, 1e-3, 0.1}) {
        const double pivot = edge.pivot(reduce<double>(design), static_cast<double>(friction), x);
        EXPECT_NEAR(pivot, static_cast<double>(finer.pivot(hoop, friction, static_cast<long double>(x))),
                    1e-13 * x)
            << "some roundings of terms of size x";
        if (x < 0.01) continue;
        const long double direct =
            sliding_coefficients(hoop, trig(there - way * static_cast<long double>(x)), friction).pivot;
        EXPECT_NEAR(pivot, static_cast<double>(direct), 1e-15);
      }
      EXPECT_GT(rate, 0.0);
      // n0' / n0 by the angle is 2 rho c turn, and goes as the power over the angle left.
      const long double x = 1e-8L;
      const Trig<long double> near = trig(there - way * x);
      const auto grows = 2 * hoop.rho * near.cos * sliding_coefficients(hoop, near, friction).turn;
      EXPECT_NEAR(static_cast<double>(-way * x * grows / power_at_edge(hoop, trig(there), friction)), 1.0,
                  1e-5);
    }
  }
  EXPECT_GT(met, 50);
}

}  // namespace
}  // namespace leapmap
