// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/panel_fall.hpp"

#include <gtest/gtest.h>

#include <random>

#include "numerics/panel_place.hpp"

namespace leapmap {
namespace {

constexpr std::size_t n = 24;
using Panel = SpectralPanel<double, n>;

template <class F>
PanelFall<double> fall_of(const F& f, double slack = 0.0) {
  static const Panel panel;
  Panel::Values values, rates;
  for (std::size_t i = 0; i < n; ++i) {
    const Sample<double> at = f(panel.node[i]);
    values[i] = at.value, rates[i] = at.rate;
  }
  return first_fall(panel, values, rates, f(0.0), f(1.0), slack);
}

/// Dips as narrow as one likes, anywhere between the nodes, are found if they go below zero, and only then.
TEST(PanelFall, DipsBetweenNodesAreFoundIfAndOnlyIfTheyReachZero) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double at = 0.01 + 0.98 * uniform(random), depth = std::pow(10.0, -13.0 * uniform(random));
    for (const double sign : {1.0, -1.0}) {
      // (x - at)^2 plus or minus a depth, and something smooth that keeps both
      const auto f = [&](double x) {
        const double d = x - at, g = d * d + sign * depth, wave = 2.0 + std::sin(3.0 * x);
        return Sample<double>{g * wave, 2.0 * d * wave + g * 3.0 * std::cos(3.0 * x)};
      };
      const PanelFall<double> fall = fall_of(f);
      const double enters = at - std::sqrt(depth);
      if (sign > 0.0) {
        EXPECT_GT(fall.place, 1.0) << at << " " << depth;
      } else if (enters > 1e-3) {
        EXPECT_NEAR(fall.place, enters, 1e-13 / std::sqrt(depth) + 1e-14) << "rounding over the slope there";
      }
    }
  }
}

TEST(PanelFall, TheFirstOfSeveralIsFound) {
  const auto f = [](double x) { return Sample<double>{std::cos(20.0 * x), -20.0 * std::sin(20.0 * x)}; };
  EXPECT_NEAR(fall_of(f).place, std::acos(0.0) / 20.0, 1e-8);  // what 24 nodes make of three waves
}

TEST(PanelFall, AGuardThatStartsAtZeroIsAboveItFromThere) {
  EXPECT_GT(fall_of([](double x) { return Sample<double>{x, 1.0}; }).place, 1.0);
  EXPECT_GT(fall_of([](double x) { return Sample<double>{x * x, 2.0 * x}; }).place, 1.0);
  EXPECT_NEAR(fall_of([](double x) {
                return Sample<double>{x * (0.5 - x), 0.5 - 2.0 * x};
              }).place,
              0.5, 1e-14);
  EXPECT_LT(fall_of([](double x) { return Sample<double>{-x, -1.0}; }).place, 1e-12);
  for (const double end : {1e-3, 1e-4, 1e-7})  // before the first node
    EXPECT_NEAR(fall_of([&](double x) {
                  return Sample<double>{x * (end - x), end - 2.0 * x};
                }).place /
                    end,
                1.0, 1e-15 / (end * end) + 1e-12)
        << "rounding of what is about end^2 in size";
}

TEST(PanelFall, WhatTheSlackCannotTellIsUnsure) {
  const auto dip = [](double depth) {
    return [depth](double x) { return Sample<double>{(x - 0.37) * (x - 0.37) + depth, 2.0 * (x - 0.37)}; };
  };
  EXPECT_TRUE(fall_of(dip(1e-12), 1e-11).unsure);
  EXPECT_TRUE(fall_of(dip(-1e-12), 1e-11).unsure);
  EXPECT_FALSE(fall_of(dip(1e-9), 1e-11).unsure);
  EXPECT_FALSE(fall_of(dip(-1e-9), 1e-11).unsure);
}

TEST(Spectral, TheFourthDerivativeIsBounded) {
  static const Panel panel;
  Panel::Values values;
  for (const double k : {0.5, 2.0, 6.0}) {
    for (std::size_t i = 0; i < n; ++i) values[i] = std::sin(k * panel.node[i] + 0.3);
    const double bound = panel.roughness(values).fourth;
    EXPECT_GT(bound, std::pow(k, 4) * 0.3) << "no less than the largest there is";
    EXPECT_LT(bound, std::pow(k, 4) * 30.0 + 1e-3) << "and of use";
    EXPECT_NEAR(panel.roughness(values).tail, panel.tail(values), 1e-14);  // roundings of the same sums
  }
}

/// Lanes take the even and the odd part apart, one panel the nodes side by side.
TEST(Spectral, IntegralsInLanesAreThoseOfOnePanel) {
  using Wide = SpectralPanel<Batch, n>;
  static const Panel panel;
  static const Wide wide;
  Panel::Values values;
  Wide::Values in_lanes;
  constexpr std::size_t last = Lanes<Batch>::count - 1;
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = std::exp(panel.node[i]) * std::cos(5.0 * panel.node[i] + 0.3);
    LaneArray<Batch> lanes;  // other functions in the other lanes
    for (std::size_t k = 0; k <= last; ++k) lanes[k] = values[i] * static_cast<double>(last - k + 1);
    in_lanes[i] = Lanes<Batch>::load(lanes.data());
  }
  const Panel::Integrated one = panel.integrated(values);
  const Wide::Integrated many = wide.integrated(in_lanes);
  constexpr double roundings = 4e-15;  // of sums of 24 values up to 2
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(lanes_of(many.running[i])[last], one.running[i], roundings);
  EXPECT_NEAR(lanes_of(many.whole)[last], one.whole, roundings);
  EXPECT_NEAR(lanes_of(many.tail)[last], one.tail, 10.0 * roundings);
  EXPECT_NEAR(lanes_of(wide.roughness(in_lanes).tail)[last], one.tail, 10.0 * roundings);
  EXPECT_NEAR(lanes_of(wide.roughness(in_lanes).fourth)[last] / panel.roughness(values).fourth, 1.0,
              1e-9);  // coefficients of 1e-15 by up to 1e7
  // The integral itself, e^x (cos y + 5 sin y) / 26, y = 5 x + 0.3.
  const auto primitive = [](double x) {
    return std::exp(x) * (std::cos(5.0 * x + 0.3) + 5.0 * std::sin(5.0 * x + 0.3)) / 26.0;
  };
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_NEAR(one.running[i], primitive(panel.node[i]) - primitive(0.0), roundings);
}

/// On integrands with a pole beside the panel, or beyond its end.
/// Of functions that differ tenfold on a panel, at any place and at its ends.
TEST(Spectral, APlaceIsFoundByTheIntegralUpToThere) {
  const Panel panel;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double rise = 5.0 * (uniform(random) - 0.5), size = std::exp(10.0 * (uniform(random) - 0.5));
    const auto integral = [&](double x) { return size * std::expm1(rise * x) / rise; };
    Panel::Values integrals, values;
    for (std::size_t k = 0; k < n; ++k)
      integrals[k] = integral(panel.node[k]), values[k] = size * std::exp(rise * panel.node[k]);
    const double place = i % 50 == 0 ? 0.0 : i % 50 == 1 ? 1.0 : uniform(random);
    // Some roundings of the integral over the least value.
    EXPECT_NEAR(place_of_integral(panel, integrals, values, integral(1.0), integral(place)), place, 1e-13);
  }
}

TEST(Spectral, IntegralsUpToAPlaceAreFarFinerThanTheirIntegrandsTail) {
  static const Panel panel;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-0.3, 1.3), logarithm(-1.3, 0.5);
  int resolved = 0, hardly = 0;
  for (int round = 0; round < 2'000; ++round) {
    const double a = place(random), b = std::pow(10.0, logarithm(random));
    Panel::Values values;
    for (std::size_t i = 0; i < n; ++i) values[i] = b / ((panel.node[i] - a) * (panel.node[i] - a) + b * b);
    const Panel::Integrated sums = panel.integrated(values);
    if (!(sums.tail < 1e-3)) continue;
    ++resolved, hardly += sums.tail > 1e-6;
    // The tail is of degree 23: its integral is some hundred times smaller, but the last two coefficients may
    // both be small by chance. Slides count on a quarter.
    const double most = 0.1 * sums.tail + 1e-14;
    const auto exact = [&](double x) { return std::atan((x - a) / b) + std::atan(a / b); };
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(sums.running[i], exact(panel.node[i]), most);
    for (double x = 0.01; x < 1.0; x += 0.03)
      ASSERT_NEAR(panel.values<1>({&sums.running}, x)[0], exact(x), most) << a << ' ' << b;
  }
  EXPECT_GT(resolved, 1'000);
  EXPECT_GT(hardly, 100);
}

TEST(PlainFall, InLanesItIsWhereOnePanelAloneHasIt) {
  using Wide = SpectralPanel<Batch, n>;
  const Wide wide;
  constexpr std::size_t width = Lanes<Batch>::count;
  std::mt19937_64 random(3);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int plain = 0, falls = 0, all = 0;
  for (int round = 0; round < 300; ++round) {
    std::array<std::array<double, 4>, width> waves;  // some begin at zero
    for (auto& [height, speed, phase, level] : waves) {
      height = uniform(0.1, 1.0), speed = uniform(0.5, 4.0), phase = uniform(0.0, 6.28);
      level = random() % 2 ? -height * std::sin(phase) : uniform(-1.0, 1.0);
      if (round % 3 == 0)  // others dip a little below zero
        phase = uniform(2.0, 4.0), level = height - std::pow(10.0, uniform(-5.0, -1.0));
    }
    const auto at = [&](std::size_t lane, double x) {
      const auto [height, speed, phase, level] = waves[lane];
      const double start = height * std::sin(phase) + level;
      const double up = start < 0.0 ? -1.0 : 1.0;  // it does not begin below zero
      return Sample<double>{up * (height * std::sin(phase + speed * x) + level),
                            up * height * speed * std::cos(phase + speed * x)};
    };
    const auto in_lanes = [&](double x) {
      LaneArray<Batch> value, rate;
      for (std::size_t lane = 0; lane < width; ++lane)
        value[lane] = at(lane, x).value, rate[lane] = at(lane, x).rate;
      return Sample<Batch>{Lanes<Batch>::load(value.data()), Lanes<Batch>::load(rate.data())};
    };
    Wide::Values values, rates;
    for (std::size_t i = 0; i < n; ++i)
      values[i] = in_lanes(wide.node[i]).value, rates[i] = in_lanes(wide.node[i]).rate;
    const auto found = plain_fall(wide, values, rates, in_lanes(0.0), in_lanes(1.0),
                                  wide.roughness(values).fourth, Batch(1e-12), Batch(0.0) == Batch(0.0));
    const unsigned is_plain = Lanes<Batch>::bits(found.is_plain);
    const auto places = lanes_of(found.place);
    for (std::size_t lane = 0; lane < width; ++lane) {
      ++all;
      if (!(is_plain >> lane & 1u)) continue;
      ++plain;
      const double place = fall_of([&](double x) { return at(lane, x); }, 1e-12).place;
      falls += place <= 1.0;
      // Roundings over slopes, which are above 0.01 but for dips.
      const double slope = place <= 1.0 ? std::abs(at(lane, place).rate) : 1.0;
      EXPECT_NEAR(places[lane], place, 1e-13 + (round % 3 == 0 ? 2e-15 / slope : 0.0))
          << round << " " << lane;
    }
  }
  EXPECT_GT(plain, all * 7 / 10);
  EXPECT_GT(falls, all / 5);
}

}  // namespace
}  // namespace leapmap
