// SPDX-License-Identifier: GPL-3.0-or-later
/// The designs that are found: feasible, better than brute force, the same for the same seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "design/front.hpp"
#include "design/improve.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/leapmap.hpp"
#include "spec/spec.hpp"
#include "tolerance/made_sample.hpp"

namespace leapmap {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t sample = 1 << 11, brute = 30,
                      most = 1;  // with sanitizers a hoop takes twenty times as long
#else
constexpr std::size_t most = 8;
/// Hoops of a sample: 16384 unless LEAPMAP_SEARCHED says how many.
const std::size_t sample =
    std::getenv("LEAPMAP_SEARCHED") ? std::strtoul(std::getenv("LEAPMAP_SEARCHED"), nullptr, 10) : 1 << 14;
/// Hoops of a grid along each of three parameters: 48 beside 16384.
const auto brute = static_cast<std::size_t>(std::cbrt(7.0 * static_cast<double>(sample)));
#endif

struct Asked {
  const char* name;
  std::string text;
  std::size_t dimensions;
};
void PrintTo(const Asked& asked, std::ostream* out) { *out << asked.name; }

const std::string common =
    "slope = { from = \"2 deg\", to = \"30 deg\" }\nmass_ratio = { from = 0.1, to = 20, scale = \"log\" }\n";

/// With sanitizers.
bool too_slow(const Asked& asked) { return most == 1 && std::string(asked.name) == "slipping"; }

class Questions : public ::testing::TestWithParam<Asked> {};

/// The best of a grid, as costs; infinite if none is feasible.
double best_of_grid(const Question& question) {
  Judge judge(question, 0, {});
  const std::size_t dimensions = question.dimensions(), each = dimensions == 2 ? brute * 4 : brute;
  std::size_t count = 1;
  for (std::size_t k = 0; k < dimensions; ++k) count *= each;
  double best = HUGE_VAL;
  constexpr std::size_t block = 1 << 14;
  std::vector<double> places;
  std::vector<Verdict> verdicts;
  for (std::size_t first = 0; first < count; first += block) {
    places.clear();
    verdicts.resize(std::min(block, count - first));
    for (std::size_t i = first; i < first + verdicts.size(); ++i)
      for (std::size_t k = 0, rest = i; k < dimensions; ++k, rest /= each)
        places.push_back(static_cast<double>(rest % each) / static_cast<double>(each - 1));
    judge.judge(places, verdicts);
    for (const Verdict& verdict : verdicts)
      if (verdict.feasible()) best = std::min(best, verdict.cost[0]);
  }
  return best;
}

TEST_P(Questions, AreAnsweredBetterThanByAGrid) {
  if (too_slow(GetParam()))
    GTEST_SKIP() << "friction with sanitizers takes minutes, and has tests of its own";
  const Spec spec = parse_spec(GetParam().text);
  const Question question = question_of(spec);
  const FoundDesigns found = find_designs(spec, {.most = most, .sample = sample});
  ASSERT_TRUE(found.reached);
  const double cost =
      question.objectives[0].maximize ? -found.designs[0].objectives[0] : found.designs[0].objectives[0];
  const double grid = best_of_grid(question);
  ASSERT_TRUE(std::isfinite(grid)) << "the grid has to find something to compare with";
  EXPECT_LE(cost, grid + 1e-10 * std::abs(grid))
      << "goals are kept by 4e-10 of a time, and 1e-12 of any other quantity";
}

TEST_P(Questions, GoalsHoldForEachDesignAsTheSolverSeesItAlone) {
  if (too_slow(GetParam()))
    GTEST_SKIP() << "friction with sanitizers takes minutes, and has tests of its own";
  const Spec spec = parse_spec(GetParam().text);
  const FoundDesigns found = find_designs(spec, {.most = most, .sample = sample});
  ASSERT_FALSE(found.designs.empty());
  const Question question = question_of(spec);
  for (const FoundDesign& one : found.designs) {
    const Outcome outcome = solve(one.design, spec.scene);
    for (const GoalCheck& goal : goal_checks(question.one.goals))
      EXPECT_TRUE(goal.reached(one.design, outcome)) << goal.field->name;
    for (const FreeParameter& parameter : question.free) {
      EXPECT_GE(one.design.*parameter.variable.parameter(), parameter.side.low);
      EXPECT_LE(one.design.*parameter.variable.parameter(), parameter.side.high);
    }
  }
}

TEST_P(Questions, TheSameSeedFindsTheSameWhateverTheThreads) {
  if (too_slow(GetParam()))
    GTEST_SKIP() << "friction with sanitizers takes minutes, and has tests of its own";
  const Spec spec = parse_spec(GetParam().text);
  const FoundDesigns one = find_designs(spec, {.most = most, .sample = sample / 8, .threads = 1}),
                     three = find_designs(spec, {.most = most, .sample = sample / 8, .threads = 3});
  ASSERT_EQ(one.designs.size(), three.designs.size());
  EXPECT_EQ(one.evaluations, three.evaluations);
  for (std::size_t i = 0; i < one.designs.size(); ++i) {
    EXPECT_EQ(one.designs[i].design.slope, three.designs[i].design.slope);
    EXPECT_EQ(one.designs[i].design.mass_ratio, three.designs[i].design.mass_ratio);
    EXPECT_EQ(one.designs[i].objectives, three.designs[i].objectives);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ten, Questions,
    ::testing::Values(
        Asked{"the_highest", "[design]\n" + common + "[goal]\nmaximize = [\"jump_height\"]", 2},
        Asked{"the_lightest",
              "[design]\n" + common +
                  "offset_ratio = { from = 0.6, to = 1 }\n[goal]\njump_height = { at_least = 0.9 }\nminimize "
                  "= [\"mass_ratio\"]",
              3},
        Asked{"the_soonest",
              "[design]\n" + common + "[goal]\njump_height = { at_least = 0.8 }\nminimize = [\"jump_time\"]",
              2},
        Asked{
            "the_highest_first_hop",
            "[design]\n" + common + "[goal]\nspurious_first_jump = { is = 0 }\nmaximize = [\"jump_height\"]",
            2},
        Asked{"within_a_time",
              "[design]\n" + common + "[goal]\njump_time = { at_most = 0.5 }\nmaximize = [\"jump_height\"]",
              2},
        Asked{"slipping",
              "[scene]\nfriction = \"coulomb\"\n[design]\n" + common +
                  "[goal]\njump_height = { at_least = 0.8 }\nminimize = [\"slope\"]",
              2}),
    [](const auto& asked) { return asked.param.name; });

TEST(Search, TellsWhatBindsAndHowFarTheCliffIs) {
  const FoundDesigns found =
      find_designs(parse_spec("[design]\n" + common + "[goal]\nmaximize = [\"jump_height\"]"),
                   {.most = most, .sample = sample});
  const FoundDesign& best = found.designs.at(0);
  EXPECT_NE(std::ranges::find(best.binds, "cliff (fold)"), best.binds.end())
      << "the highest jump is beside the cliff where a lift-off is born";
  ASSERT_FALSE(best.cliff.empty());
  EXPECT_LT(best.cliff[0].distance, 1e-9) << "found to rounding, and settled 1e-12 away";
  ASSERT_EQ(best.gradients.size(), 1u);
  EXPECT_EQ(best.gradients[0].by.slope, gradient(best.design, &Outcome::jump_height).slope);
  Design beyond = best.design;
  double least = best.outcome.jump_height;
  for (const double way : {-1.0, 1.0})
    for (double Design::*member : {&Design::slope, &Design::mass_ratio}) {
      beyond = best.design, beyond.*member *= 1.0 + way * 1e-6;
      least = std::min(least, solve(beyond).jump_height);
    }
  EXPECT_LT(least, 0.9 * best.outcome.jump_height) << "a millionth farther on another lift-off is the jump";
}

TEST(Search, SaysThatNoDesignDoesItAndHowNearOneComes) {
  const FoundDesigns found = find_designs(
      parse_spec("[design]\n" + common + "[goal]\njump_height = { at_least = 2.0 }\nminimize = [\"slope\"]"),
      {.most = most, .sample = sample});
  EXPECT_FALSE(found.reached);
  ASSERT_EQ(found.designs.size(), 1u);
  ASSERT_EQ(found.missed.size(), 1u);
  const FoundDesigns highest =
      find_designs(parse_spec("[design]\n" + common + "[goal]\nmaximize = [\"jump_height\"]"),
                   {.most = most, .sample = sample});
  EXPECT_NEAR(found.missed[0], highest.designs[0].objectives[0], 1e-6)
      << "the nearest miss is the highest jump there is";
}

TEST(Search, MakesHoopsSurerThanAnyOfAGrid) {
  const std::string text =
      "[design]\nslope = { from = \"8 deg\", to = \"31 deg\" }\nmass_ratio = { from = 1, to = 6 "
      "}\n[scatter]\nslope = { normal = \"2 deg\" }\nmass_ratio = { normal = \"3 %\" }\nsamples = 64\n"
      "[goal]\njump_height = { at_least = 1.0 }\n";
  const FoundDesigns found =
      find_designs(parse_spec(text + "maximize = [\"yield\"]"), {.most = most, .sample = 1024});
  ASSERT_TRUE(found.reached);
  const Question question = question_of(parse_spec(text + "maximize = [\"yield\"]"));
  Judge judge(question, 0, {});
  double surest = 0.0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j)
      if (const Verdict verdict = judge.judge(std::vector{i / 20.0, j / 20.0}); verdict.feasible())
        surest = std::max(surest, -verdict.cost[0]);
  EXPECT_GT(surest, 0.5);
  EXPECT_GE(found.designs[0].objectives[0], surest);
  const FoundDesigns sure =
      find_designs(parse_spec(text + "yield = { at_least = 0.8 }\nminimize = [\"mass_ratio\"]"),
                   {.most = most, .sample = 1024});
  ASSERT_TRUE(sure.reached);
  EXPECT_LT(sure.designs[0].objectives[0], found.designs[0].design.mass_ratio) << "less sure is lighter";
  Spec one = question.one;
  one.design = sure.designs[0].design;
  EXPECT_GE(scatter(one).yield.value, 0.8) << "as leapmap scatter tells it, with the same hoops";
}

TEST(Search, StopsWhenItIsAsked) {
  FindOptions options;
  int asked = 0;
  options.threads = 1;
  options.stop_requested = [&] { return ++asked > 3; };
  EXPECT_THROW(
      find_designs(parse_spec("[design]\n" + common + "[goal]\nmaximize = [\"jump_height\"]"), options),
      Stopped);
}

TEST(Search, ListsItsDesignsForASweep) {
  const Spec spec = parse_spec("[design]\n" + common +
                               "[goal]\njump_height = { at_least = 0.5 }\nmaximize = [\"jump_height\"]");
  const FoundDesigns found = find_designs(spec, {.most = most, .sample = sample / 8});
  const Spec list = list_of(spec, found);
  check_spec(list);
  ASSERT_EQ(list.list.count, found.designs.size());
  EXPECT_EQ(list.list.columns[0].values[0], found.designs[0].design.slope);
}

/// A front of places with these costs.
Front front_of(std::initializer_list<std::array<double, 2>> costs) {
  std::vector<Place> places;
  for (const auto& cost : costs) places.push_back({{}, {.violation = 0.0, .cost = cost}});
  Front front;
  front.add(std::move(places));
  return front;
}

TEST(Fronts, KeepWhatNothingDominates) {
  const Front front = front_of({{0, 4}, {1, 3}, {1, 2}, {2, 2}, {3, 2.5}, {4, 0}, {4, 0}});
  ASSERT_EQ(front.places().size(), 3u);
  EXPECT_EQ(front.places()[1].verdict.cost, (std::array{1.0, 2.0}));
  EXPECT_DOUBLE_EQ(front.hypervolume(), (1 * 0 + 3 * 2) / 16.0);
}

TEST(Fronts, TakeWhatNothingThereIsAsGoodAs) {
  const Front front = front_of({{0, 4}, {1, 2}, {4, 0}});
  const auto takes = [&](double first, double second) {
    return front.takes({.violation = 0.0, .cost = {first, second}});
  };
  EXPECT_TRUE(takes(-1, 5) && takes(0.5, 3) && takes(0, 3.9) && takes(5, -1));
  EXPECT_FALSE(takes(0, 4) || takes(1, 2) || takes(1.5, 2) || takes(1, 2.1) || takes(5, 0));
  EXPECT_FALSE(front.takes({.violation = 0.1, .cost = {-1, -1}})) << "misses a goal";
}

TEST(Fronts, ThinnedKeepTheirEndsAndWhatAddsMost) {
  Front front = front_of({{0, 4}, {0.1, 3.9}, {1, 1}, {2, 0.9}, {4, 0}});
  front.thin(3);
  ASSERT_EQ(front.places().size(), 3u);
  EXPECT_EQ(front.places()[0].verdict.cost[0], 0.0);
  EXPECT_EQ(front.places()[1].verdict.cost[0], 1.0);
  EXPECT_EQ(front.places()[2].verdict.cost[0], 4.0);
}

TEST(Fronts, DominateMoreThanAsManyRandomDesignsAsWereSolved) {
  const Spec spec =
      parse_spec("[design]\n" + common + "[goal]\nmaximize = [\"jump_height\"]\nminimize = [\"jump_time\"]");
  const FoundDesigns found = find_designs(spec, {.sample = sample});
  ASSERT_GT(found.designs.size(), 20u);
  for (std::size_t i = 1; i < found.designs.size(); ++i) {
    ASSERT_LT(found.designs[i].objectives[0], found.designs[i - 1].objectives[0]) << "in order of the first";
    ASSERT_LT(found.designs[i].objectives[1], found.designs[i - 1].objectives[1])
        << "and none dominates its neighbour";
  }
  const Question question = question_of(spec);
  Judge judge(question, 0, {});
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  const std::size_t count = 8 * sample;
  std::vector<double> places(2 * count);
  for (double& coordinate : places) coordinate = uniform(random);
  std::vector<Verdict> verdicts(count);
  judge.judge(places, verdicts);
  std::size_t dominating = 0, feasible = 0;
  for (const Verdict& verdict : verdicts) {
    if (!verdict.feasible()) continue;
    ++feasible;
    // A random design that nothing of the front is at least as good as.
    dominating += std::ranges::none_of(found.designs, [&](const FoundDesign& one) {
      return -one.objectives[0] <= verdict.cost[0] && one.objectives[1] <= verdict.cost[1];
    });
  }
  EXPECT_GT(feasible, count / 10);
  EXPECT_LT(dominating, feasible / 1000) << "between neighbours of the front there is a little room";
}

}  // namespace
}  // namespace leapmap
