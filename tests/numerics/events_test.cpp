// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/events.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace leapmap {
namespace {

/// A "motion" whose state is time itself, so that any function of time can be a guard with exactly known
/// falls.
struct Falling {
  std::function<double(double)> value, rate;

  Sample<double> operator()(const State<1>& y) const { return {value(y[0]), rate(y[0])}; }
};

template <class Retake>
Sample<double> find_in(const Step<1>& step, std::size_t inside, const Sample<double>& first,
                       const Falling& guard, const Retake& retake, Falls<1>& found) {
  std::vector<Sample<double>> seen;
  for (std::size_t k = 1; k <= inside + 1; ++k) seen.push_back(guard(state_at_look(step, k, inside + 1)));
  find_falls(step, first, seen, guard, retake, found);
  return seen.back();
}

/// Walks [0, end] in steps of h, looking `looks` times inside each; returns the times of all falls.
std::vector<double> falls_of(const Falling& guard, double end, double h, std::size_t looks = 1,
                             double start = 0.0) {
  std::vector<double> times;
  Falls<1> found;
  Sample<double> first = guard({start});
  const int steps = static_cast<int>(std::lround((end - start) / h));
  for (int i = 0; i < steps; ++i) {
    Step<1> step{start + i * h, h, {start + i * h}, {1.0}, {start + (i + 1) * h}, {1.0}};
    const auto retake = [&](double tau, State<1>& y) { return y[0] = step.t0 + tau, true; };
    first = find_in(step, looks, first, guard, retake, found);
    EXPECT_FALSE(found.failed);
    for (const auto& fall : found.falls) times.push_back(step.t0 + fall.tau);
  }
  return times;
}

Falling polynomial(double a, double b, double c) {  // (t - a)(t - b)(t - c)
  return {[=](double t) { return (t - a) * (t - b) * (t - c); },
          [=](double t) { return (t - a) * (t - b) + (t - a) * (t - c) + (t - b) * (t - c); }};
}

TEST(Events, OnlyFallsAreReportedNotRises) {
  const Falling guard{[](double t) { return std::cos(t); }, [](double t) { return -std::sin(t); }};
  const auto times = falls_of(guard, 14.0, 0.25);
  ASSERT_EQ(times.size(), 2u);  // pi/2 and 5 pi/2; the rise at 3 pi/2 is none
  EXPECT_NEAR(times[0], M_PI / 2, 4e-16);
  EXPECT_NEAR(times[1], 5 * M_PI / 2, 4e-15);
}

TEST(Events, APairInsideOneStepIsFoundDownToAHairApart) {
  for (const double gap : {0.5, 1e-2, 1e-4, 1e-6}) {
    const double middle = 0.637;
    const Falling guard{[=](double t) { return (t - middle) * (t - middle) - gap * gap / 4; },
                        [=](double t) { return 2 * (t - middle); }};
    const auto times = falls_of(guard, 1.0, 1.0, 0);
    ASSERT_EQ(times.size(), 1u) << gap;
    // The root's own condition: a rounding of the guard, 1e-17, over its slope there, gap.
    EXPECT_NEAR(times[0], middle - gap / 2, 1e-15 + 1e-16 / gap) << gap;
  }
}

TEST(Events, ATouchIsNoFallAndAHairBelowIsOne) {
  const auto touching = [](double offset) {
    return Falling{[=](double t) { return (t - 0.5) * (t - 0.5) + offset; },
                   [](double t) { return 2 * (t - 0.5); }};
  };
  for (const double h : {1.0, 0.5, 0.25, 0.3}) {  // the touch inside a step, and exactly at a step's end
    EXPECT_EQ(falls_of(touching(0.0), 1.2, h).size(), 0u) << h;
    EXPECT_EQ(falls_of(touching(1e-14), 1.2, h).size(), 0u) << h;
    EXPECT_EQ(falls_of(touching(-1e-14), 1.2, h).size(), 1u) << h;
  }
}

TEST(Events, GrazesAreToldWithTheSideTheyWereDecidedOn) {
  const Falling guard{[](double t) { return (t - 0.4) * (t - 0.4) + 1e-9; },
                      [](double t) { return 2 * (t - 0.4); }};
  Falls<1> found;
  const Step<1> step{0.0, 1.0, {0.0}, {1.0}, {1.0}, {1.0}};
  find_in(
      step, 1, guard({0.0}), guard, [](double tau, State<1>& y) { return y[0] = tau, true; }, found);
  ASSERT_EQ(found.near_misses.size(), 1u);
  EXPECT_NEAR(found.near_misses[0].tau, 0.4, 1e-8);
  EXPECT_NEAR(found.near_misses[0].value, 1e-9, 1e-15);
  EXPECT_TRUE(found.near_misses[0].minimum);
  EXPECT_TRUE(found.falls.empty());
}

TEST(Events, AStartOnTheGuardIsNoFallInItsOwnStep) {
  const Falling guard{[](double t) { return -t; }, [](double) { return -1.0; }};
  EXPECT_EQ(falls_of(guard, 2.0, 0.5).size(), 0u);  // t0 < t* <= t1: t* = 0 belongs to an earlier step
  const Falling rising_first{[](double t) { return t * (1.0 - t); }, [](double t) { return 1.0 - 2 * t; }};
  const auto times = falls_of(rising_first, 2.0, 0.75);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_NEAR(times[0], 1.0, 4e-16);
}

TEST(Events, AFallExactlyAtAStepsEndIsReportedOnce) {
  const Falling guard{[](double t) { return 1.0 - t; }, [](double) { return -1.0; }};
  const auto times = falls_of(guard, 2.0, 0.5);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_DOUBLE_EQ(times[0], 1.0);
}

TEST(Events, ThreeRootsInOneStepGiveTwoFalls) {
  // Falls at 0.3 and rises at 0.5, falls again at 0.8: minus the cubic.
  const Falling up = polynomial(0.3, 0.5, 0.8);
  const Falling guard{[=](double t) { return -up.value(t); }, [=](double t) { return -up.rate(t); }};
  const auto times = falls_of(guard, 1.0, 1.0, 4);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_NEAR(times[0], 0.3, 1e-15);
  EXPECT_NEAR(times[1], 0.8, 1e-15);
}

TEST(Events, ATripleRootIsOneFall) {
  const Falling guard{[](double t) { return std::pow(0.4 - t, 3); },
                      [](double t) { return -3 * std::pow(0.4 - t, 2); }};
  const auto times = falls_of(guard, 1.0, 1.0);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_NEAR(times[0], 0.4, 1e-6);  // a triple root: a third of the digits is all a value of 1e-17 tells
}

TEST(Events, FallsRetriggerAfterARise) {
  const Falling guard{[](double t) { return std::sin(40 * t); },
                      [](double t) { return 40 * std::cos(40 * t); }};
  EXPECT_EQ(falls_of(guard, 3.1, 0.1, 7).size(), 20u);  // one each period of 2 pi / 40, start on the guard
}

TEST(Events, AMaximumAboveZeroBetweenTwoFallenEndsIsOneFall) {
  const Falling guard{[](double t) { return 0.01 - (t - 0.5) * (t - 0.5); },
                      [](double t) { return -2 * (t - 0.5); }};
  const auto times = falls_of(guard, 1.0, 1.0, 0);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_NEAR(times[0], 0.6, 2e-16);
}

TEST(Events, AFailedRetakeIsToldNotHidden) {
  const Falling guard{[](double t) { return 0.5 - t; }, [](double) { return -1.0; }};
  Falls<1> found;
  const Step<1> step{0.0, 1.0, {0.0}, {1.0}, {1.0}, {1.0}};
  find_in(
      step, 1, guard({0.0}), guard, [](double, State<1>&) { return false; }, found);
  EXPECT_TRUE(found.failed);
  EXPECT_TRUE(found.falls.empty());
}

}  // namespace
}  // namespace leapmap
