// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/boundaries.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "boundaries/cliff.hpp"
#include "leapmap/errors.hpp"
#include "model/model.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

Axis spaced(const char* key, double from, double to, std::size_t count) {
  Axis axis{key, {}};
  for (std::size_t i = 0; i < count; ++i)
    axis.values.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  return axis;
}

Spec over(std::vector<Axis> axes) {
  Spec spec;
  spec.axes = std::move(axes);
  return spec;
}

/// On level ground a thin hoop whose mass lies on top, all but at rest, leaves the ground if its mass ratio
/// is more than 13: the normal force then grazes zero. w0^2 > sqrt(27 (1 - rho) / (1 + rho)) - 1 moves it by
/// 1e-17.
TEST(Boundaries, OnLevelGroundTheHoopLeavesItFromAMassRatioOf13On) {
  Spec spec = over({spaced("mass_ratio", 12.0, 14.5, 6)});
  spec.design.slope = 0.0;
  spec.design.release_spin = 1e-8;
  spec.scene.hop_height = 0.0;
  spec.scene.runway = 1.0;
  const Boundaries found = find_boundaries(spec);
  ASSERT_EQ(found.cliffs.size(), 1u);
  EXPECT_NEAR(found.cliffs[0].value, 13.0, 13.0 * 1e-12);
  EXPECT_EQ(found.cliffs[0].kind, CliffKind::fold);
  EXPECT_EQ(found.cliffs[0].below.status, Status::no_jump);
  EXPECT_EQ(found.cliffs[0].above.jumps_on, 1);
}

/// Where long doubles see the same two outcomes, by their own bisection.
TEST(Boundaries, AreWhereLongDoublesSeeThem) {
  std::mt19937_64 random(19);
  std::size_t compared = 0, hoops = 0;
  double worst = 0.0;
  while (compared < 150 && ++hoops < 400) {
    Spec spec = over({spaced("slope", 0.05, 0.85, 9)});
    spec.design = testing::random_design(random);
    for (const Cliff& cliff : find_boundaries(spec).cliffs) {
      const auto seen = [&](double slope) {
        Design design = spec.design;
        design.slope = slope;
        return discrete(model_of(spec.scene).refined(design, spec.scene), false);
      };
      double low = cliff.value - 1e-7, high = cliff.value + 1e-7;
      if (!(seen(low) == cliff.below) || !(seen(high) == cliff.above)) continue;
      for (double middle; (middle = 0.5 * (low + high)) != low && middle != high;)
        (seen(middle) == cliff.below ? low : high) = middle;
      ++compared;
      worst = std::max(worst, std::abs(low - cliff.value));
      // Roundings of G and of a height, over how fast they change with the slope; the worst here is 1e-14.
      EXPECT_NEAR(cliff.value, low, 1e-12);
    }
  }
  EXPECT_GE(compared, 150u);
  RecordProperty("worst", std::to_string(worst));
}

/// The paper's hoop over the slope: between 0.02 and 0.6 its jump passes from lift-off to lift-off.
TEST(Boundaries, FindEveryCliffBetweenTwoNeighboursThatDiffer) {
  const Boundaries fine = find_boundaries(over({spaced("slope", 0.02, 0.62, 20'001)}));
  const Boundaries coarse = find_boundaries(over({spaced("slope", 0.02, 0.62, 2)}));
  std::set<double> places;
  for (const Cliff& cliff : fine.cliffs) places.insert(cliff.value);
  ASSERT_GT(places.size(), 6u);
  // Each cliff of the coarse grid is one of the fine grid's, to rounding; and one outcome leads to the next.
  ASSERT_GT(coarse.cliffs.size(), 1u);
  for (std::size_t i = 0; i < coarse.cliffs.size(); ++i) {
    const double value = coarse.cliffs[i].value;
    const auto near = places.lower_bound(value - 1e-12);
    ASSERT_TRUE(near != places.end() && *near <= value + 1e-12) << value;
    EXPECT_FALSE(coarse.cliffs[i].below == coarse.cliffs[i].above);
  }
  EXPECT_EQ(coarse.cliffs.front().below, fine.cliffs.front().below);
  EXPECT_EQ(coarse.cliffs.back().above, fine.cliffs.back().above);
}

/// A stepped outcome in place of hoops: what is planted is found.
TEST(Bisection, FindsANarrowBandThatIsLikeNeitherSide) {
  const auto outcome_at = [](double x) {
    Outcome outcome;
    outcome.status = x < 0.3          ? Status::no_jump
                     : x < 0.3 + 1e-9 ? Status::stalled
                                      : Status::airborne_at_release;
    return outcome;
  };
  const Solver solve = [&](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) outcomes[i] = outcome_at(designs[i].slope);
  };
  std::vector<Stretch> stretches{{0, {0.0, outcome_at(0.0)}, {1.0, outcome_at(1.0)}, 0.0},
                                 {1, {0.25, outcome_at(0.25)}, {0.5, outcome_at(0.5)}, 0.0}};
  std::map<std::size_t, std::vector<double>> found;
  bisect(
      solve, false, stretches,
      [](std::size_t, double x) {
        Design design;
        design.slope = x;
        return design;
      },
      [&](const Stretch& at) {
        found[at.line].push_back(at.below.at);
        EXPECT_EQ(at.above.at, std::nextafter(at.below.at, 2.0)) << "nothing lies between";
      },
      [] {});
  for (auto& [line, places] : found) {
    std::ranges::sort(places);
    ASSERT_EQ(places.size(), 2u);
    EXPECT_LT(places[0], 0.3);
    EXPECT_NEAR(places[0], 0.3, 1e-15);
    EXPECT_NEAR(places[1], 0.3 + 1e-9, 1e-15);
  }
  EXPECT_EQ(found.size(), 2u);
}

TEST(Bisection, DoesNotAskAgainWhereTheMethodGivesUp) {
  int failures = 0;
  const auto outcome_at = [](double x) {
    Outcome outcome;
    outcome.status = x < 0.3 ? Status::no_jump : x < 0.4 ? Status::failed : Status::stalled;
    return outcome;
  };
  const Solver solve = [&](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      outcomes[i] = outcome_at(designs[i].slope);
      failures += outcomes[i].status == Status::failed;
    }
  };
  std::vector<Stretch> found;
  bisect(
      solve, false, {{0, {0.0, outcome_at(0.0)}, {1.0, outcome_at(1.0)}, 0.0}},
      [](std::size_t, double x) {
        Design design;
        design.slope = x;
        return design;
      },
      [&](const Stretch& at) { found.push_back(at); }, [] {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(failures, 1);
  EXPECT_EQ(found[0].below.outcome.status, Status::no_jump);
  EXPECT_EQ(found[0].above.outcome.status, Status::failed);
}

TEST(Boundaries, OfAPlaneAreCurvesThatLeadFromEdgeToEdgeOfTheGridOrMeetOthers) {
  const Spec spec = over({spaced("slope", 0.05, 0.85, 41), spaced("mass_ratio", 0.5, 8.0, 41)});
  const Boundaries found = find_boundaries(spec);
  ASSERT_FALSE(found.curves.empty());
  std::vector<int> used(found.cliffs.size(), 0);
  std::size_t ends = 0, loose = 0;
  for (const CliffCurve& curve : found.curves) {
    for (const std::size_t cliff : curve.cliffs) ++used[cliff];
    for (std::size_t i = 0; i + 1 < curve.cliffs.size(); ++i) {
      // Neighbours are in one cell of the grid.
      const auto a = place_of(found, found.cliffs[curve.cliffs[i]]),
                 b = place_of(found, found.cliffs[curve.cliffs[i + 1]]);
      EXPECT_LE(std::abs(a[0] - b[0]), 0.02 * (1.0 + 1e-12));
      EXPECT_LE(std::abs(a[1] - b[1]), 0.1875 * (1.0 + 1e-12));
    }
    for (const auto& [cliff, meeting] : {std::pair{curve.cliffs.front(), curve.meeting_from},
                                         std::pair{curve.cliffs.back(), curve.meeting_to}}) {
      ++ends;
      const auto at = place_of(found, found.cliffs[cliff]);
      const bool on_border = at[0] == 0.05 || at[0] == 0.85 || at[1] == 0.5 || at[1] == 8.0;
      if (meeting.empty() && !on_border) ++loose;
    }
  }
  // Curves nearer each other than a cell may end there, and kinds change along them.
  EXPECT_LT(loose, ends / 2);
  const auto unused = std::ranges::count(used, 0);
  EXPECT_LT(unused, static_cast<std::ptrdiff_t>(found.cliffs.size() / 20));
}

TEST(Boundaries, AreTheSameCurvesFromEitherEndOfAnAxisThatRisesAndFalls) {
  // So coarse a plane has several cliffs on an edge; the last two of its columns are swapped.
  Axis columns = spaced("mass_ratio", 0.5, 20.0, 3);
  std::swap(columns.values[1], columns.values[2]);
  const Axis rows = spaced("slope", 0.05, 0.85, 12);
  const auto lengths_of = [&](const Axis& axis) {
    const Boundaries found = find_boundaries(over({rows, axis}));
    std::vector<double> lengths;
    for (const CliffCurve& curve : found.curves) {
      double length = 0.0;
      for (std::size_t i = 0; i + 1 < curve.cliffs.size(); ++i) {
        const auto a = place_of(found, found.cliffs[curve.cliffs[i]]),
                   b = place_of(found, found.cliffs[curve.cliffs[i + 1]]);
        length += std::hypot(a[0] - b[0], a[1] - b[1]);
      }
      lengths.push_back(length);
    }
    std::ranges::sort(lengths);
    return lengths;
  };
  Axis backwards = columns;
  std::ranges::reverse(backwards.values);
  const auto there = lengths_of(columns), back = lengths_of(backwards);
  ASSERT_EQ(there.size(), back.size());
  ASSERT_GE(there.size(), 3u);
  // Cliffs are bisected to rounding, and a curve has some tens of them.
  for (std::size_t i = 0; i < there.size(); ++i) EXPECT_NEAR(there[i], back[i], 1e-9);
}

TEST(Boundaries, DoNotDependOnThreads) {
  const Spec spec = over({spaced("slope", 0.05, 0.85, 31), spaced("mass_ratio", 0.5, 8.0, 33)});
  const Boundaries one = find_boundaries(spec, {.threads = 1}), three = find_boundaries(spec, {.threads = 3});
  ASSERT_EQ(one.cliffs.size(), three.cliffs.size());
  for (std::size_t i = 0; i < one.cliffs.size(); ++i) {
    EXPECT_EQ(one.cliffs[i].value, three.cliffs[i].value);
    EXPECT_EQ(one.cliffs[i].kind, three.cliffs[i].kind);
  }
}

TEST(Boundaries, WithFrictionAreNamedAndTellPhasesApartIfAsked) {
  Spec spec = over({spaced("slope", 0.1, 0.8, 15), spaced("mu_static", 0.2, 1.4, 13)});
  spec.scene.friction = Friction::coulomb;
  spec.design.mass_ratio = 6.0;
  const Boundaries plain = find_boundaries(spec), phases = find_boundaries(spec, {.phases = true});
  EXPECT_GT(phases.cliffs.size(), plain.cliffs.size());
  std::map<CliffKind, std::size_t> kinds;
  for (const Cliff& cliff : phases.cliffs) ++kinds[cliff.kind];
  EXPECT_GT(kinds[CliffKind::phase], 0u);
  EXPECT_EQ(kinds[CliffKind::fold], 0u);
  for (const Cliff& cliff : plain.cliffs) {
    const bool painleve =
        cliff.below.status == Status::indeterminate || cliff.above.status == Status::indeterminate;
    EXPECT_EQ(cliff.kind == CliffKind::painleve, painleve);
  }
}

TEST(Boundaries, OfHoopsThatTurnRoundAndRunwaysAreNamed) {
  Spec turning = over({spaced("release_spin", -2.5, -0.1, 25)});
  turning.design.slope = 0.3;
  turning.design.release_angle = 1.0;
  std::set<CliffKind> kinds;
  for (const Cliff& cliff : find_boundaries(turning).cliffs) kinds.insert(cliff.kind);
  Spec runway = over({spaced("slope", 0.02, 0.4, 77)});
  runway.scene.runway = 2.0;
  for (const Cliff& cliff : find_boundaries(runway).cliffs) kinds.insert(cliff.kind);
  EXPECT_TRUE(kinds.contains(CliffKind::turn));
  EXPECT_TRUE(kinds.contains(CliffKind::runway));
}

TEST(NearCliffs, AlongAxesAreThoseOfTheGridAndNoneIsNearerThanTheNearest) {
  const Spec spec = over({spaced("slope", 0.05, 0.85, 81), spaced("mass_ratio", 0.5, 8.0, 76)});
  Design design;
  const NearCliffs near = near_cliffs(spec, design);
  ASSERT_EQ(near.along.size(), 2u);
  ASSERT_EQ(near.nearest.size(), 1u);
  // The paper's hoop: a slope of 0.4494 makes it jump at its first lift-off.
  Spec line = over({spaced("slope", 0.4, 0.85, 46)});
  const Boundaries ahead = find_boundaries(line);
  ASSERT_FALSE(ahead.cliffs.empty());
  const auto up =
      std::ranges::find_if(near.along[0], [](const NearCliff& cliff) { return cliff.at[0] > 0.4; });
  ASSERT_TRUE(up != near.along[0].end());
  EXPECT_NEAR(up->at[0], ahead.cliffs.front().value, 1e-14);
  for (const auto& axis : near.along)
    for (const NearCliff& cliff : axis) EXPECT_LE(near.nearest[0].distance, cliff.distance);
  // No cliff of a fine grid is nearer, but for a share of its cells.
  const Boundaries all = find_boundaries(spec);
  double least = 1.0;
  for (const Cliff& cliff : all.cliffs) {
    const auto at = place_of(all, cliff);
    least = std::min(least, std::hypot((at[0] - design.slope) / 0.8, (at[1] - design.mass_ratio) / 7.5));
  }
  EXPECT_LE(near.nearest[0].distance, least * (1.0 + 1e-9));
  EXPECT_GT(near.nearest[0].distance, 0.98 * least);
}

TEST(Boundaries, RefuseWhatIsNoGrid) {
  Spec list;
  EXPECT_THROW(find_boundaries(list), InputError);
  EXPECT_THROW(find_boundaries(over({{"slope", {0.4}}})), InputError);
  EXPECT_THROW(
      find_boundaries(over({spaced("slope", 0.1, 0.8, 15'000), spaced("mass_ratio", 0.5, 8.0, 15'000)})),
      InputError);
  Design beyond;
  beyond.slope = 1.0;
  EXPECT_THROW(near_cliffs(over({spaced("slope", 0.1, 0.8, 8)}), beyond), InputError);
  const BoundaryOptions stopped{.stop_requested = [] { return true; }};
  EXPECT_THROW(find_boundaries(over({spaced("slope", 0.1, 0.8, 8)}), stopped), Stopped);
}

}  // namespace
}  // namespace leapmap
