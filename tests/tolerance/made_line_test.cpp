// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops made after lines of drawings: interpolated where they may be.
#include "tolerance/made_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/designs.hpp"
#include "support/scattered.hpp"
#include "tolerance/scatter_solver.hpp"

namespace leapmap {
namespace {

using testing::plausible;

std::vector<Design> line_from(Design first, double Design::*member, double step, std::size_t count) {
  std::vector<Design> drawings(count, first);
  for (std::size_t j = 0; j < count; ++j) drawings[j].*member += step * static_cast<double>(j);
  return drawings;
}

TEST(MadeLines, AreOfManyDrawingsWithinATolerance) {
  const auto suits = [](double Design::*member, double step, std::size_t count) {
    const Scatter scatter = plausible();  // slope 1.5 deg, mass_ratio 4 %
    const auto drawings = line_from({.mass_ratio = 2.0}, member, step, count);
    return MadeLine::suits(line_of(drawings), drawings, MadeHoops(scatter, {}, {}, points_of(scatter)));
  };
  EXPECT_TRUE(suits(&Design::slope, 0.02, 40) && suits(&Design::mass_ratio, 0.07, 40));
  EXPECT_FALSE(suits(&Design::slope, 0.03, 40)) << "steps beyond the tolerance";
  EXPECT_FALSE(suits(&Design::mass_ratio, 0.09, 40)) << "4 % of 2";
  EXPECT_FALSE(suits(&Design::slope, 0.02, 31)) << "too few";
  EXPECT_FALSE(suits(&Design::offset_ratio, -0.001, 40)) << "has no tolerance";
}

TEST(DrawnLines, AreThoseThatDifferInOneParameterAndOneWay) {
  const auto along = [](std::initializer_list<double> slopes) {
    std::vector<Design> drawings;
    for (const double slope : slopes) drawings.push_back({.slope = slope});
    return drawings;
  };
  EXPECT_EQ(line_of(along({0.1, 0.2, 0.3})).along, (std::vector{0.1, 0.2, 0.3}));
  EXPECT_EQ(line_of(along({0.1, 0.2, 0.15})).count, 2u) << "turns round";
  EXPECT_EQ(line_of(along({0.1, 0.1, 0.2})).count, 1u) << "the same twice";
  EXPECT_EQ(line_of(along({0.1})).count, 1u);
  std::vector<Design> corner = along({0.1, 0.2, 0.3, 0.4});
  corner[2].mass_ratio = 7.0, corner[3].mass_ratio = 7.0;
  EXPECT_EQ(line_of(corner).count, 2u) << "goes on along another parameter";
}

/// The statistics of drawings, interpolated and not.
struct BothWays {
  MadeColumns exact, interpolated;
  double solved;  ///< share of hoops solved when interpolated
};

BothWays told(const Scatter& scatter, const std::vector<Design>& drawings, const Solver& solver) {
  const std::vector<const Field*> fields{find_field("yield"), find_field("yield_error"),
                                         find_field("jump_height_mean"), find_field("jump_height_q05")};
  const std::vector<Goal> goals{{"jump_height", 0.5, HUGE_VAL}};
  BothWays both{MadeColumns(fields), MadeColumns(fields), 0.0};
  std::size_t solved = 0;
  const Solver counted = [&](std::span<const Design> designs, std::span<Outcome> outcomes) {
    solved += designs.size();
    solver(designs, outcomes);
  };
  for (const bool interpolates : {false, true}) {
    solved = 0;
    ScatterSolver solve(scatter, {}, {}, points_of(scatter), goals, {find_field("jump_height")}, counted,
                        interpolates);
    solve.solve(drawings, interpolates ? both.interpolated : both.exact);
  }
  both.solved = static_cast<double>(solved) / static_cast<double>(drawings.size() * scatter.samples);
  return both;
}

TEST(MadeLines, TellWhatSolvingEveryHoopTells) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform;
  const Scene scene{.friction = Friction::coulomb};
  const Solver exact = model_of(scene).exact(scene, 1e-10, {});
  Scatter scatter = plausible();
  scatter.samples = 256;
  const Field &yield = *find_field("yield"), &error = *find_field("yield_error"),
              &mean = *find_field("jump_height_mean");
  double solved = 0.0;
  int compared = 0;
  constexpr int lines = 12;
  for (int i = 0; i < lines; ++i) {
    const Design first{.slope = 0.15 + 0.25 * uniform(random), .mass_ratio = 1.0 + 4.0 * uniform(random)};
    const auto drawings = i % 2 == 0 ? line_from(first, &Design::slope, 2e-3, 60)
                                     : line_from(first, &Design::mass_ratio, 0.03, 60);
    const BothWays both = told(scatter, drawings, exact);
    solved += both.solved / lines;
    for (std::size_t j = 0; j < drawings.size(); ++j) {
      // A hoop more or less is less than the error; an interpolated height is right to some 1e-5.
      EXPECT_NEAR(both.interpolated.column(yield)[j], both.exact.column(yield)[j],
                  both.exact.column(error)[j]);
      EXPECT_GE(both.interpolated.column(error)[j], 0.9 * both.exact.column(error)[j]);
      if (both.exact.column(yield)[j] < 0.5) continue;
      EXPECT_NEAR(both.interpolated.column(mean)[j], both.exact.column(mean)[j], 2e-4);
      ++compared;
    }
  }
  EXPECT_GT(compared, lines * 60 / 10);
  EXPECT_LT(solved, 0.5);
}

TEST(MadeLines, NeedOneHoopOfEightWhereNothingBreaks) {
  // Heights on a cubic, whose interpolation is exact: one hoop of eight is solved, and no more.
  const Solver cubic = [](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      outcomes[i] = {};
      outcomes[i].status = Status::jumped, outcomes[i].phase_sequence = 1;
      outcomes[i].jump_height = 1.0 + 1e-3 * std::pow(designs[i].slope, 3);
    }
  };
  const Scatter scatter{{{"slope", Spread::Law::normal, 0.01}}, 256};
  const BothWays both = told(scatter, line_from({}, &Design::slope, 1e-3, 81), cubic);
  EXPECT_LT(both.solved, 1.0 / MadeLine::stride + 0.03);
  for (std::size_t j = 0; j < 81; ++j)
    EXPECT_NEAR(both.interpolated.column(*find_field("jump_height_mean"))[j],
                both.exact.column(*find_field("jump_height_mean"))[j], 1e-13);
}

/// The statistics of hoops made after 81 drawings with slopes from 0.4 to 0.48. describe(slope - 0.44,
/// outcome) sets a hoop's outcome. The goal is a height of 0.5.
template <class F>
BothWays told_around(double width, const F& describe) {
  const Scatter scatter{{{"slope", Spread::Law::normal, width}}, 1024};
  return told(scatter, line_from({.slope = 0.4}, &Design::slope, 1e-3, 81),
              [&](std::span<const Design> designs, std::span<Outcome> outcomes) {
                for (std::size_t i = 0; i < designs.size(); ++i) {
                  outcomes[i] = {};
                  describe(designs[i].slope - 0.44, outcomes[i]);
                }
              });
}

void jump(Outcome& outcome, std::uint64_t phases, double height) {
  outcome.status = Status::jumped, outcome.phase_sequence = phases, outcome.jump_height = height;
}

/// Expects yields that differ by at most three hoops of 1,024, and that are neither all high nor all low.
void expect_yields(const BothWays& both, const std::string& what) {
  const auto exact = both.exact.column(*find_field("yield")),
             made = both.interpolated.column(*find_field("yield"));
  for (std::size_t j = 0; j < exact.size(); ++j) EXPECT_NEAR(made[j], exact[j], 0.003) << what << ' ' << j;
  EXPECT_LT(*std::ranges::min_element(exact), 0.7) << what << ": nothing is put to the test";
  EXPECT_GT(*std::ranges::max_element(exact), 0.3) << what << ": nothing is put to the test";
}

/// Expects means that differ by at most 1 % of their standard error, if heights vary like slopes.
void expect_means(const BothWays& both, double width, const std::string& what) {
  const auto exact = both.exact.column(*find_field("jump_height_mean")),
             made = both.interpolated.column(*find_field("jump_height_mean"));
  for (std::size_t j = 0; j < exact.size(); ++j) EXPECT_NEAR(made[j], exact[j], 0.01 * width / 32.0) << what;
}

TEST(MadeLines, NeedOneHoopOfEightWherePhasesChangeButNumbersDoNot) {
  const BothWays both = told_around(
      0.01, [](double x, Outcome& outcome) { jump(outcome, x > 0.0 ? 2 : 1, 0.5 + x + 1e-3 * x * x); });
  EXPECT_LT(both.solved, 1.0 / MadeLine::stride + 0.03);
  expect_yields(both, "smooth");
  expect_means(both, 0.01, "smooth");
}

TEST(MadeLines, SolveHoopsWhoseNumbersBreakWherePhasesChange) {
  // The numbers break on either side of the change of phases.
  const std::vector<std::pair<std::string, double (*)(double)>> breaks{
      {"kink", [](double x) { return x > 0.0 ? 0.5 * x : 0.0; }},
      {"kink before", [](double x) { return x < 0.0 ? 0.5 * x : 0.0; }},
      {"bend", [](double x) { return x > 0.0 ? 50.0 * x * x : 0.0; }},
      {"step", [](double x) { return x > 0.0 ? 0.02 : 0.0; }},
      {"step before", [](double x) { return x < 0.0 ? 0.02 : 0.0; }}};
  constexpr double width = 0.002;
  for (const auto& [what, change] : breaks) {
    const BothWays both = told_around(
        width, [&](double x, Outcome& outcome) { jump(outcome, x > 0.0 ? 2 : 1, 0.5 + x + change(x)); });
    expect_yields(both, what);
    expect_means(both, width, what);
  }
}

TEST(MadeLines, SolveAllHoopsAroundNarrowBandsBetweenAnyPhases) {
  // Bands two drawings wide, amid hoops that jump to 1 and whose phases are the same on both sides, or not.
  struct Band {
    std::string what;
    void (*describe)(Outcome& outcome, bool upper);
    double island = 1.0;  ///< beyond, nothing jumps
  };
  constexpr auto falls = [](Outcome& outcome, bool) { jump(outcome, 3, 0.0); };
  constexpr auto stalls = [](Outcome& outcome, bool) { outcome.status = Status::stalled; };
  constexpr auto both_ways = [](Outcome& outcome, bool upper) {
    outcome.status = upper ? Status::stalled : Status::indeterminate;
  };
  const std::vector<Band> bands{
      {"numbers", falls},
      {"numbers on an island too small for nodes of eight drawings", falls, 0.01},
      {"status", stalls},
      {"status on such an island", stalls, 0.01},
      {"two of them", both_ways},
      {"two of them on such an island", both_ways, 0.01},
      {"no number", [](Outcome& outcome, bool) { jump(outcome, 3, Outcome::none); }}};
  for (const Band& band : bands)
    for (const std::uint64_t beyond : {1, 2}) {
      const BothWays both = told_around(0.002, [&](double x, Outcome& outcome) {
        if (std::abs(x) > band.island)
          outcome.status = Status::no_jump, outcome.phase_sequence = 4;
        else if (std::abs(x) < 1e-3)
          band.describe(outcome, x > 0.0);
        else
          jump(outcome, x < 0.0 ? 1 : beyond, 1.0 + x);
      });
      expect_yields(both, band.what + (beyond == 1 ? "" : ", between two phases"));
    }
  const BothWays predictable = told_around(0.002, [](double x, Outcome& outcome) {
    jump(outcome, std::abs(x) < 1e-3 ? 3 : x < 0.0 ? 1 : 2, 1.0 + x);
  });
  EXPECT_LT(predictable.solved, 1.0 / MadeLine::stride + 0.03) << "phases are not asked for";
}

TEST(MadeLines, SolvePhasesExactlyIfTheyAreTheGoalOrNoNumberIs) {
  // Phases change; between them is a narrow band with another number of lift-offs.
  const Solver solver = [](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const double x = designs[i].slope - 0.44;
      outcomes[i] = {};
      jump(outcomes[i], x > 0.0 ? 2 : 1, 1.0);
      outcomes[i].candidates = std::abs(x) < 1e-3 ? 2 : 1;
    }
  };
  const Scatter scatter{{{"slope", Spread::Law::normal, 0.002}}, 1024};
  const std::vector<const Field*> fields{find_field("yield")};
  const auto drawings = line_from({.slope = 0.4}, &Design::slope, 1e-3, 81);
  for (const Goal& goal : {Goal{"phase_sequence", 2.0, 2.0}, Goal{"candidates", 1.0, 1.0}}) {
    MadeColumns exact(fields), interpolated(fields);
    for (const bool interpolates : {false, true})
      ScatterSolver(scatter, {}, {}, points_of(scatter), {goal}, {}, solver, interpolates)
          .solve(drawings, interpolates ? interpolated : exact);
    for (std::size_t j = 0; j < drawings.size(); ++j)
      EXPECT_NEAR(interpolated.column(*fields[0])[j], exact.column(*fields[0])[j], 0.002) << goal.field << j;
  }
}

TEST(MadeLines, InterpolateWhatAppliesWithoutAJumpAsWell) {
  // No hoop jumps; how far it slides has a kink, of which phases tell nothing.
  const Solver kinked = [](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      outcomes[i] = {};
      outcomes[i].status = Status::no_jump, outcomes[i].phase_sequence = 1;
      outcomes[i].slip_distance = 3.0 + std::abs(designs[i].slope - 0.44) + std::sin(40.0 * designs[i].slope);
    }
  };
  const Scatter scatter{{{"slope", Spread::Law::normal, 0.002}}, 256};
  const std::vector<Goal> goals{{"slip_distance", 2.6, HUGE_VAL}};
  const std::vector<const Field*> fields{find_field("yield")};
  MadeColumns exact(fields), interpolated(fields);
  const auto drawings = line_from({}, &Design::slope, 1e-3, 81);
  for (const bool interpolates : {false, true})
    ScatterSolver(scatter, {}, {}, points_of(scatter), goals, {}, kinked, interpolates)
        .solve(drawings, interpolates ? interpolated : exact);
  for (std::size_t j = 0; j < drawings.size(); ++j)
    EXPECT_NEAR(interpolated.column(*fields[0])[j], exact.column(*fields[0])[j], 1.0 / 256) << j;
}

TEST(MadeLines, SolveAllHoopsAroundBandsThatTheyWouldPassOver) {
  // A band of hoops that do not jump, two drawings wide, amid others that all do.
  const Solver banded = [](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      outcomes[i] = {};
      const bool in_band = std::abs(designs[i].slope - 0.44) < 1e-3;
      outcomes[i].status = in_band ? Status::no_jump : Status::jumped;
      outcomes[i].phase_sequence = in_band ? 2 : 1;
      if (!in_band) outcomes[i].jump_height = 1.0;
    }
  };
  const Scatter scatter{{{"slope", Spread::Law::normal, 0.002}}, 1024};
  const BothWays both = told(scatter, line_from({}, &Design::slope, 1e-3, 81), banded);
  const auto exact = both.exact.column(*find_field("yield")),
             made = both.interpolated.column(*find_field("yield")),
             error = both.interpolated.column(*find_field("yield_error"));
  for (std::size_t j = 0; j < exact.size(); ++j) EXPECT_NEAR(made[j], exact[j], error[j]) << j;
  EXPECT_LT(both.solved, 0.6) << "and no others";
  EXPECT_LT(*std::ranges::min_element(exact), 0.7) << "else there is nothing to pass over";
}

}  // namespace
}  // namespace leapmap
