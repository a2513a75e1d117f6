// SPDX-License-Identifier: GPL-3.0-or-later
/// Proofs against 40-digit tables, against the solvers on random designs, and of boxes against designs
/// inside.
#include "leapmap/prove.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <set>

#include "leapmap/leapmap.hpp"
#include "leapmap/worst_case.hpp"
#include "proof/acting.hpp"
#include "proof/cells.hpp"
#include "proof/zeros.hpp"
#include "support/aimed.hpp"
#include "support/designs.hpp"
#include "support/exact.hpp"
#include "support/reference_table.hpp"

namespace leapmap {
namespace {

using testing::uniform;

TEST(Balls, HoldWhatTheyStandFor) {
  const Ball third = Ball(1) / Ball(3);
  EXPECT_LT(third.lower(), third.upper());
  EXPECT_TRUE((third * Ball(3)).holds(1.0));
  EXPECT_TRUE(Ball::between(-1.0, 2.0).holds(-1.0) && Ball::between(-1.0, 2.0).holds(2.0));
  EXPECT_EQ(Ball::between(-1.0, 2.0).sign(), 0);
  EXPECT_FALSE(Ball::between(0.0, 1.0) < Ball(1.0)) << "1 is not less than 1";
  EXPECT_TRUE(Ball::between(0.0, 0.5) < Ball(1.0));
  EXPECT_FALSE((sqrt(Ball(-1.0))).is_finite());
}

TEST(Balls, LoseNothingToCancellation) {
  for (const double x : {1e-12, 1e-5, 0.01, 0.3, 2.0, 40.0}) {
    const Ball ball(x), less = x_minus_sin(ball, trig(ball)), versine = trig(ball).versine;
    const long double truth = x < 0.1 ? powl(x, 3) / 6 * (1 - static_cast<long double>(x) * x / 20)
                                      : x - sinl(static_cast<long double>(x));
    const auto width = [](const Ball& of) { return (of.upper() - of.lower()) / std::abs(of.upper()); };
    // Two neighbouring doubles about a ball of 64 bits; cancellation would leave 1e-4 of x = 1e-12.
    EXPECT_LT(width(less), 1e-14) << x;
    EXPECT_LT(width(versine), 1e-14) << x;
    // The series is cut after x^5 / 120, of which x^7 / 5040 is 2e-11 at 0.01.
    EXPECT_NEAR(less.middle(), static_cast<double>(truth), 1e-8 * static_cast<double>(truth)) << x;
  }
}

TEST(ZeroSearch, FindsEachZeroOnceAndSaysWhereItCannot) {
  const auto sine = [](double from, double to) {
    const auto [sin, cos] = sincos_of(Ball::between(from, to));
    return Sample<Ball>{sin, cos};
  };
  ZeroSearch search(sine, 1.0, 10.0, 0.7, 1e-9);
  for (const double zero : {std::numbers::pi, 2 * std::numbers::pi, 3 * std::numbers::pi}) {
    const auto found = search.next();
    ASSERT_TRUE(found && found->is_root());
    EXPECT_LE(found->from, zero);
    EXPECT_GE(found->to, zero);
  }
  EXPECT_FALSE(search.next());
  const auto touches = [](double from, double to) {  // (x - 0.3)^2 is zero, and falls and rises
    const Ball x = Ball::between(from, to) - Ball(0.3);
    return Sample<Ball>{x * x, Ball(2) * x};
  };
  ZeroSearch double_zero(touches, 0.0, 1.0, 0.25, 1e-6);
  const auto found = double_zero.next();
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->is_root());
  EXPECT_FALSE(double_zero.next());
}

void expect_holds(const testing::ReferenceRow& row, const std::string& name, const Enclosure& within,
                  const std::string& where) {
  if (!row.has(name)) {
    EXPECT_TRUE(std::isnan(within.low)) << where << " " << name;
    return;
  }
  // The table's 17 digits are a rounding off.
  const double truth = row.number(name), rounding = 1e-15 * (1.0 + std::abs(truth));
  EXPECT_LE(within.low, truth + rounding) << where << " " << name;
  EXPECT_GE(within.high, truth - rounding) << where << " " << name;
}

class ProofTables : public ::testing::TestWithParam<const char*> {};
TEST_P(ProofTables, LieInTheirEnclosures) {
  const auto rows = testing::read_reference(GetParam());
  std::size_t open = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const std::string where = fmt::format("{} row {}", GetParam(), i + 1);
    const Proof proof = prove(row.design(), testing::idle_scene());
    if (!proof.proved) {
      ++open;
      continue;
    }
    EXPECT_EQ(name_of(proof.status), row.cells.at("status")) << where;
    if (row.has("candidates")) {
      EXPECT_EQ(proof.lift_offs, row.number("candidates")) << where;
    }
    EXPECT_EQ(proof.spurious_first_jump, row.has("spurious") ? row.number("spurious") : 255) << where;
    expect_holds(row, "jump_height", proof.height, where);
    expect_holds(row, "first_jump_height", proof.first_height, where);
    const auto time = [&](const std::string& name, const Enclosure& within) {
      Enclosure own{within.low / time_unit(testing::idle_scene()),
                    within.high / time_unit(testing::idle_scene())};
      expect_holds(row, name, own, where);
    };
    time("jump_time", proof.time);
    time("first_jump_time", proof.first_time);
  }
  EXPECT_LE(open * 50, rows.size()) << "one in fifty may be too near an event, or turn too often in flight";
}
INSTANTIATE_TEST_SUITE_P(NoSlip, ProofTables,
                         ::testing::Values("noslip_top_release.csv", "noslip_general.csv",
                                           "noslip_turning.csv", "noslip_drive.csv", "noslip_stress.csv"));

Design design_at_random(std::mt19937_64& random) {
  const auto sometimes = [&](double share) { return uniform(random, 0.0, 1.0) < share; };
  Design design;
  design.slope = sometimes(0.1) ? 0.0 : uniform(random, -0.1, 0.9);
  design.mass_ratio = std::exp(uniform(random, -2.0, 3.0));
  design.offset_ratio = sometimes(0.3) ? 1.0 : uniform(random, 0.05, 1.0);
  design.inertia_factor = sometimes(0.5) ? 1.0 : uniform(random, 0.3, 1.0);
  design.release_angle = sometimes(0.3) ? std::numbers::pi : uniform(random, 0.0, 6.28);
  design.release_spin = sometimes(0.5) ? 0.0 : uniform(random, -2.0, 3.0);
  design.drive_torque = sometimes(0.6) ? 0.0 : uniform(random, -0.2, 0.4);
  design.resisting_torque = sometimes(0.8) ? 0.0 : uniform(random, 0.0, 0.1);
  return design;
}

/// What the solver finds is what is proved, to the tolerances of its heights and times.
void expect_proved(const Proof& proof, const Outcome& ours, const std::string& which) {
  EXPECT_EQ(name_of(proof.status), name_of(ours.status)) << which;
  EXPECT_EQ(proof.spurious_first_jump, ours.spurious_first_jump) << which;
  EXPECT_EQ(proof.lift_offs, ours.candidates) << which;
  const auto expect_near = [&](const Enclosure& within, double value, double allowed) {
    EXPECT_EQ(std::isnan(within.low), std::isnan(value)) << which;
    if (std::isnan(value)) return;
    EXPECT_GE(value, within.low - allowed) << which;
    EXPECT_LE(value, within.high + allowed) << which;
  };
  expect_near(proof.height, ours.jump_height, 1e-11 * (1.0 + ours.jump_height));
  expect_near(proof.first_height, ours.first_jump_height, 1e-11 * (1.0 + ours.first_jump_height));
  constexpr double at_once = 1e-15;  // s: a lift-off some roundings past the release
  expect_near(proof.time, ours.jump_time, 1e-9 * ours.jump_time + at_once);
  expect_near(proof.first_time, ours.first_jump_time, 1e-9 * ours.first_jump_time + at_once);
}

TEST(Proofs, OfRandomDesignsAreWhatTheSolverFinds) {
  std::mt19937_64 random(31);
  const std::size_t count = testing::how_many(600);
  std::size_t open = 0, jumped = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const Design design = design_at_random(random);
    const Scene scene{.motor_in_flight = n % 3 != 0};
    const Proof proof = prove(design, scene);
    const Outcome ours = solve(design, scene);
    if (!proof.proved) {  // what the solver does not follow, a torque that reverses, cannot be proved either
      open += ours.status != Status::failed;
      continue;
    }
    jumped += proof.status == Status::jumped;
    expect_proved(proof, ours, testing::told(design));
  }
  EXPECT_LE(open * 100, count);
  EXPECT_GE(jumped * 3, count);
}

TEST(Proofs, OfDesignsAimedAtAnEventAreRightOrOpen) {
  std::mt19937_64 random(32);
  const std::size_t count = testing::how_many(200);
  std::size_t decided = 0, beside = 0, aimed = 0;
  while (aimed < count) {
    const auto design = testing::aimed_at_a_node(random);
    if (!design) continue;
    ++aimed;
    const Proof proof = prove(*design);
    if (!proof.proved) continue;
    if (!prove(within_rounding(*design)).proved) {  // nothing that computes in doubles can tell
      ++beside;
      continue;
    }
    ++decided;
    const Outcome ours = solve(*design);
    if (ours.status != Status::failed) expect_proved(proof, ours, testing::told(*design));
  }
  EXPECT_LE(beside * 10, count * 3);
  EXPECT_GE(decided * 10, count * 6) << "a tenth is aimed at the edge of a release, where nothing is sure";
}

/// A box about a design in some of its parameters: about rest and about no torque, and up to the rim too.
DesignBox box_at_random(std::mt19937_64& random, const Design& middle) {
  DesignBox box{middle, middle};
  const auto widen = [&](double Design::*member, double by, double least, double most) {
    if (uniform(random, 0.0, 1.0) < 0.5) return;
    box.from.*member = std::max(least, box.from.*member - by * uniform(random, 0.0, 1.0));
    box.to.*member = std::min(most, box.to.*member + by * uniform(random, 0.0, 1.0));
  };
  widen(&Design::slope, 0.002, -1.0, 1.0), widen(&Design::mass_ratio, 0.004 * middle.mass_ratio, 0.0, 1e3);
  widen(&Design::offset_ratio, 0.002, 0.0, 1.0), widen(&Design::inertia_factor, 0.004, 0.0, 1.0);
  widen(&Design::release_angle, 0.003, -10.0, 10.0), widen(&Design::release_spin, 0.003, -5.0, 5.0);
  if (box.from.slope < box.to.slope || box.from.release_spin < box.to.release_spin)
    widen(&Design::drive_torque, 0.002, -1.0, 1.0);
  else
    widen(&Design::resisting_torque, 0.01, 0.0, 1.0);
  return box;
}

TEST(Proofs, OfBoxesHoldOfTheDesignsInside) {
  std::mt19937_64 random(33);
  const std::size_t count = testing::how_many(240);
  std::size_t proved = 0, failed = 0, timed = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const DesignBox box = box_at_random(random, design_at_random(random));
    const Scene scene{.motor_in_flight = n % 3 != 0};
    const Proof proof = prove(box, scene, true);
    if (!proof.proved) continue;
    ++proved, timed += !std::isnan(proof.time.low);
    for (int k = 0; k < 12; ++k) {
      Design design = box.from;
      for (const auto member : acting)
        if (box.from.*member < box.to.*member)
          design.*member = k < 4 ? (random() % 2 ? box.from.*member : box.to.*member)
                                 : uniform(random, box.from.*member, box.to.*member);
      const Outcome inside = solve(design, scene);
      failed += inside.status == Status::failed;
      EXPECT_EQ(name_of(inside.status), name_of(proof.status)) << testing::told(design);
      EXPECT_EQ(inside.spurious_first_jump, proof.spurious_first_jump) << testing::told(design);
      if (proof.lift_offs >= 0) {
        EXPECT_EQ(inside.candidates, proof.lift_offs) << testing::told(design);
      }
      const auto expect_inside = [&](const Enclosure& within, double value) {
        if (std::isnan(value) || std::isnan(within.low)) return;
        EXPECT_GE(value, within.low - 1e-12) << testing::told(design);
        EXPECT_LE(value, within.high + 1e-12) << testing::told(design);
      };
      EXPECT_EQ(std::isnan(inside.jump_height), std::isnan(proof.height.low)) << testing::told(design);
      expect_inside(proof.height, inside.jump_height);
      expect_inside(proof.first_height, inside.first_jump_height);
      expect_inside(proof.time, inside.jump_time);
      expect_inside(proof.first_time, inside.first_jump_time);
    }
  }
  EXPECT_GE(timed * 5, count) << "but for hoops that turn round, or do not jump";
  EXPECT_EQ(failed, 0u) << "of what no method follows nothing is proved";
  EXPECT_GE(proved * 10, count * 6) << "boxes of a tenth of a degree and half a per cent are mostly proved";
}

TEST(Proofs, OfARotationThatMayReverseAgainstATorqueAreOpen) {
  Design uphill{.slope = -0.2, .release_spin = 1.0};
  DesignBox box{uphill, uphill};
  box.to.resisting_torque = 0.01;
  EXPECT_FALSE(prove(box).proved) << "without the torque it turns round and jumps";
  uphill.resisting_torque = 0.01;
  EXPECT_EQ(name_of(solve(uphill).status), "failed");
  EXPECT_FALSE(prove(uphill).proved);
}

TEST(Proofs, OfBoxesNarrowWithTheSquareOfTheirWidth) {
  const Design paper;
  const auto excess = [&](double width) {
    DesignBox box{paper, paper};
    box.from.slope -= width, box.to.slope += width;
    const Proof proof = prove(box);
    EXPECT_TRUE(proof.proved);
    const double ends = std::abs(solve(box.to).jump_height - solve(box.from).jump_height);
    return proof.height.high - proof.height.low - ends;
  };
  // The mean-value form is off by the change of the slope over the box, times its width.
  const double wide = excess(4e-3), narrow = excess(1e-3);
  EXPECT_GT(wide, 0.0);
  EXPECT_LT(narrow, wide / 10.0);
}

TEST(Cells, AreCrossedWhereTwoDesignsDiffer) {
  const Scene scene;
  Design low, high;
  low.slope = 0.12, high.slope = 0.25;
  low.mass_ratio = high.mass_ratio = 0.43;
  ASSERT_NE(name_of(solve(low, scene).status), name_of(solve(high, scene).status));
  while (high.slope - low.slope > 1e-3) {  // towards a discontinuity between them
    Design middle = low;
    middle.slope = 0.5 * (low.slope + high.slope);
    (solve(middle, scene).status == solve(low, scene).status ? low : high) = middle;
  }
  const CellProof cell = prove_cell({low, high}, scene);
  EXPECT_EQ(cell.finding, CellFinding::crossed);
  ASSERT_TRUE(cell.differ);
  const auto& [one, other] = *cell.differ;
  EXPECT_NE(name_of(solve(one, scene).status), name_of(solve(other, scene).status));
  for (const Design& design : *cell.differ) {
    EXPECT_GE(design.slope, low.slope);
    EXPECT_LE(design.slope, high.slope);
  }
  Design beside = high;
  beside.slope += 0.05;
  DesignBox plain{beside, beside};
  plain.to.slope += 1e-3;
  const CellProof proved = prove_cell(plain, scene);
  EXPECT_EQ(proved.finding, CellFinding::proved);
  EXPECT_TRUE(proved.height.holds(solve(beside, scene).jump_height));
}

Spec paper_within(double degrees) {
  Spec spec;
  spec.scatter.spreads = {{"slope", Spread::Law::uniform, degrees * std::numbers::pi / 180.0},
                          {"mass_ratio", Spread::Law::uniform, 2.0, true},
                          {"release_angle", Spread::Law::uniform, 3.0 * std::numbers::pi / 180.0}};
  return spec;
}

TEST(WorstCases, OfThePapersHoopAreProvedAndEncloseTheLowestJumpFound) {
  Spec spec = paper_within(1.0);
  spec.goals = {{.field = "jump_height", .at_least = 0.9}};
  const WorstCase found = worst_case(spec);
  EXPECT_EQ(found.answer, WorstCase::Answer::proved);
  ASSERT_TRUE(found.worst);
  const double worst = solve(*found.worst).jump_height;
  EXPECT_NEAR(worst, found.height.high, 1e-12) << "the solver's of the hoop whose height is proved";
  EXPECT_EQ(prove(*found.worst).height.high, found.height.high);
  EXPECT_LT(found.height.high - found.height.low, 1e-3 + 1e-12) << "as asked";
  std::mt19937_64 random(34);
  for (int n = 0; n < 2000; ++n) {
    Design made;
    made.slope += uniform(random, -1.0, 1.0) * std::numbers::pi / 180.0;
    made.mass_ratio *= 1.0 + 0.02 * uniform(random, -1.0, 1.0);
    made.release_angle += 3.0 * uniform(random, -1.0, 1.0) * std::numbers::pi / 180.0;
    EXPECT_GE(solve(made).jump_height, found.height.low) << testing::told(made);
  }
}

TEST(WorstCases, HaveACounterexampleThatMissesTheGoal) {
  Spec spec = paper_within(1.0);
  spec.goals = {{.field = "jump_height", .at_least = 0.95}};
  const WorstCase found = worst_case(spec);
  EXPECT_EQ(found.answer, WorstCase::Answer::counterexample);
  ASSERT_TRUE(found.worst);
  EXPECT_LT(solve(*found.worst).jump_height, 0.95);
}

TEST(WorstCases, MayBeOfHoopsThatMustNotJump) {
  Spec spec = paper_within(0.2);
  spec.design.slope = 0.05, spec.scene.runway = 1.0;
  spec.goals = {{.field = "status",
                 .at_least = static_cast<double>(Status::no_jump),
                 .at_most = static_cast<double>(Status::no_jump)}};
  const WorstCase found = worst_case(spec);
  EXPECT_EQ(found.answer, WorstCase::Answer::proved);
  EXPECT_EQ(found.boxes, 1);
  EXPECT_TRUE(std::isnan(found.height.low));
}

TEST(WorstCases, HoldAcrossAFoldWhereALiftOffAppears) {
  Spec spec;  // a hoop from a drawing on slopes from 18 to 34.8 deg; at 23.4 deg its first lift-off appears
  spec.design.mass_ratio = 1.5901639344262295, spec.design.offset_ratio = 0.6245704467353952;
  spec.design.inertia_factor = 1.1491174206148012, spec.design.slope = 26.4 * std::numbers::pi / 180.0;
  const double width = 8.4 * std::numbers::pi / 180.0;
  spec.scatter.spreads = {{"slope", Spread::Law::uniform, width}};
  const WorstCase found = worst_case(spec);
  EXPECT_EQ(found.answer, WorstCase::Answer::proved);
  std::set<int> lift_offs;
  for (int n = 0; n <= 4000; ++n) {
    Design made = spec.design;
    made.slope += width * (n / 2000.0 - 1.0);
    const Outcome outcome = solve(made);
    lift_offs.insert(outcome.candidates);
    EXPECT_GE(outcome.jump_height, found.height.low) << testing::told(made);
  }
  EXPECT_EQ(lift_offs, (std::set{1, 2})) << "a discontinuity is crossed";
}

TEST(WorstCases, StayWithinWhatADesignMayBe) {
  Spec spec = paper_within(10.0);
  spec.design.slope = 1.5;  // 86 deg, and its tolerance goes beyond the vertical
  EXPECT_NE(worst_case(spec, {.most_boxes = 40}).answer, WorstCase::Answer::proved);
}

TEST(WorstCases, AreTheSameOnAnyNumberOfThreads) {
  const WorstCase one = worst_case(paper_within(0.5), {.threads = 1}),
                  two = worst_case(paper_within(0.5), {.threads = 2});
  EXPECT_EQ(one.boxes, two.boxes);
  EXPECT_EQ(one.height.low, two.height.low);
  EXPECT_EQ(one.height.high, two.height.high);
}

template <class F>
std::string why_refused(const F& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Proofs, RefuseWhatIsNotTheirs) {
  const Scene slipping{.friction = Friction::coulomb};
  EXPECT_NE(why_refused([&] { static_cast<void>(prove(Design{}, slipping)); }).find("with friction"),
            std::string::npos);
  DesignBox reversed{Design{.slope = 0.5}, Design{.slope = 0.4}};
  EXPECT_NE(why_refused([&] { static_cast<void>(prove(reversed)); }).find("in order"), std::string::npos);
  Spec normal = paper_within(1.0);
  normal.scatter.spreads[0].law = Spread::Law::normal;
  EXPECT_NE(why_refused([&] { static_cast<void>(worst_case(normal)); }).find("uniform"), std::string::npos);
  Spec timed = paper_within(1.0);
  timed.goals = {{.field = "flight_time", .at_least = 0.1}};
  EXPECT_NE(why_refused([&] { static_cast<void>(worst_case(timed)); }).find("goal.flight_time"),
            std::string::npos);
}

}  // namespace
}  // namespace leapmap
