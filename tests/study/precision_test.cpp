// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/precision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "noslip/exact.hpp"
#include "study/truth.hpp"

namespace leapmap {
namespace {

const Scene scene{.runway = 4.0};

std::vector<Outcome> truth_of(const std::vector<Design>& designs) {
  std::vector<Outcome> truth(designs.size());
  ExactSolver<long double>(1e-18).solve(designs, scene, truth);
  return truth;
}

TEST(Precision, RandomDesignsAreThoseOfTheirSeedOnEveryMachine) {
  const auto designs = random_designs(3, 1);
  EXPECT_EQ(designs[0].slope, random_designs(1, 1)[0].slope);
  EXPECT_NE(designs[0].slope, random_designs(1, 2)[0].slope);
  for (const Design& design : random_designs(1000, 7)) {
    EXPECT_TRUE(design.slope >= 0.1 && design.slope < 0.8);
    EXPECT_TRUE(design.mass_ratio >= 0.5 && design.mass_ratio < 10.0);
    EXPECT_TRUE(design.offset_ratio >= 0.3 && design.offset_ratio < 1.0);
  }
}

TEST(Precision, ASeriesStandsTogetherWithTheCheapestSettingFirst) {
  for (const bool quick : {false, true}) {
    const auto contestants = precision_contestants(quick);
    std::set<std::tuple<std::string, bool, RollingModel>> ended;
    for (std::size_t i = 1; i < contestants.size(); ++i) {
      const Contestant &before = contestants[i - 1], &here = contestants[i];
      if (here.same_series(before)) {
        EXPECT_LT(here.setting, before.setting) << here.method;
      } else {
        EXPECT_TRUE(ended.insert({before.method, before.fixed_step, before.model}).second) << before.method;
      }
    }
    EXPECT_EQ(ended.size() + 1, 1u + 11u + 8u + 3u + 4u)
        << "exact, adaptive, fixed steps of GSL, of games, models";
  }
}

TEST(Precision, MeasuresSmallerErrorsAndMoreWorkAtSmallerTolerances) {
  const auto designs = random_designs(30, 3);
  const auto truth = truth_of(designs);
  const auto at = [&](const char* method, double tolerance) {
    const auto model =
        std::string_view(method) == "exact" ? RollingModel::energy_integral : RollingModel::one_coordinate;
    return measure({method, false, tolerance, 0, model}, designs, scene, truth, 0.1);
  };
  const Measurement coarse = at("gsl-rk8pd", 1e-6), fine = at("gsl-rk8pd", 1e-11), exact = at("exact", 1e-12);
  EXPECT_LT(fine.max_height_error, 1e-3 * coarse.max_height_error);
  EXPECT_LT(fine.max_time_error, 1e-3 * coarse.max_time_error);
  EXPECT_LE(fine.median_height_error, fine.max_height_error);
  EXPECT_GT(fine.evaluations, coarse.evaluations);
  EXPECT_EQ(fine.evaluations, at("gsl-rk8pd", 1e-11).evaluations)
      << "work does not depend on the machine's mood";
  EXPECT_EQ(fine.wrong + fine.failed + exact.wrong + exact.failed, 0.0);
  EXPECT_LT(exact.max_height_error, 1e-14);
  EXPECT_TRUE(std::isnan(exact.evaluations));
  EXPECT_GT(exact.seconds, 0.0);
  EXPECT_LT(exact.max_height_error, fine.max_height_error);
}

TEST(Precision, MoreModelThanRollingNeedsCostsTimeAndItsCurvedConstraintsDriftUnlessProjected) {
  const auto designs = random_designs(20, 3);
  const auto truth = truth_of(designs);
  const auto by = [&](RollingModel model) {
    return measure({"gsl-rk8pd", false, 1e-8, 0, model}, designs, scene, truth, 0.1);
  };
  const Measurement one = by(RollingModel::one_coordinate), paper = by(RollingModel::multipliers),
                    curved = by(RollingModel::centre_of_mass),
                    projected = by(RollingModel::centre_of_mass_projected);
  EXPECT_TRUE(std::isnan(one.drift)) << "nothing to violate";
  // The paper's constraints are linear, and every Runge-Kutta step keeps them but for rounding.
  EXPECT_LT(paper.drift, 1e-13);
  EXPECT_GT(curved.drift, 1e-9) << "of the size of the tolerance";
  EXPECT_LT(projected.drift, 1e-13);
  for (const Measurement* m : {&one, &paper, &curved, &projected}) {
    EXPECT_EQ(m->wrong + m->failed, 0.0);
    EXPECT_LT(m->max_height_error, 1e-6) << "a hundred times the tolerance";
  }
}

TEST(Precision, WrongFlagsAndFailuresAreSharesAndNoErrors) {
  const auto designs = random_designs(20, 3);
  auto truth = truth_of(designs);
  ASSERT_EQ(truth[4].status, Status::jumped);
  truth[4].candidates += 1;
  truth[5].spurious_first_jump ^= 1;
  const Measurement wrong =
      measure({"exact", false, 1e-12, 0, RollingModel::energy_integral}, designs, scene, truth, 0.1);
  EXPECT_EQ(wrong.wrong, 0.1);
  EXPECT_LT(wrong.max_height_error, 1e-14) << "errors are of the others";
  const Measurement failed = measure({"euler", true, 0.5, 1}, designs, scene, truth, 0.1);
  EXPECT_EQ(failed.failed + failed.wrong, 1.0);
  EXPECT_GT(failed.failed, 0.8) << "steps this long lose energy or gain it, and say so";
  EXPECT_TRUE(std::isnan(failed.max_height_error));
}

TEST(Precision, WithFrictionExactAndIntegrationsConvergeToTheSame) {
  const Scene coulomb{.friction = Friction::coulomb, .runway = 4.0};
  const auto designs = random_designs(20, 3, Friction::coulomb);
  EXPECT_EQ(designs[0].slope, random_designs(1, 3, Friction::coulomb)[0].slope);
  std::vector<Outcome> truth;
  for (const Truth& known : truths_of(designs, coulomb)) {
    EXPECT_EQ(known.witness, Witness::both);
    truth.push_back(known.outcome);
  }
  const auto by = [&](const char* method, double tolerance,
                      RollingModel model = RollingModel::one_coordinate) {
    return measure({method, false, tolerance, 0, model}, designs, coulomb, truth, 0.1);
  };
  const Measurement coarse = by("gsl-rk8pd", 1e-6), fine = by("gsl-rk8pd", 1e-11),
                    exact = by("exact", 1e-12, RollingModel::energy_integral);
  EXPECT_EQ(coarse.wrong + fine.wrong + fine.failed + exact.wrong + exact.failed, 0.0);
  EXPECT_LT(fine.max_height_error, 1e-3 * coarse.max_height_error);
  EXPECT_GT(fine.evaluations, coarse.evaluations);
  EXPECT_LT(exact.max_height_error, 1e-13);
}

TEST(Precision, LeavesOutTheSettingsThatTakeTooLong) {
  PrecisionOptions options;
  options.designs = 10;
  options.quick = true;
  options.budget = 0.05;  // far more than exact needs, on a machine as busy as may be
  std::size_t told = 0;
  const auto rows = study_precision(options, scene, [&](const PrecisionRow&) { ++told; });
  EXPECT_EQ(told, rows.size());
  const auto is = [](const char* method) {
    return [method](const PrecisionRow& row) {
      return row.contestant.method == method && row.designs == "random" && !row.contestant.fixed_step;
    };
  };
  EXPECT_EQ(std::ranges::count_if(rows, is("exact")), 5);
  EXPECT_GE(std::ranges::count_if(rows, is("gsl-rk1imp")), 1) << "one is always tried";
  EXPECT_LT(std::ranges::count_if(rows, is("gsl-rk1imp")), 4);
}

}  // namespace
}  // namespace leapmap
