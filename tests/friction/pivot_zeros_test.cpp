// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/pivot_zeros.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <complex>
#include <numbers>
#include <random>

#include "friction/edge_looks.hpp"
#include "hoop/sliding.hpp"
#include "numerics/wide.hpp"

namespace leapmap {
namespace {

using Complex = std::complex<double>;

/// The pivot and its derivative at a complex angle.
std::array<Complex, 2> pivot_at(const Hoop<double>& hoop, double m, const Complex& phi) {
  const Complex s = std::sin(phi), c = std::cos(phi);
  const double rho = hoop.rho;
  return {hoop.Ic + rho * s * (rho * s - m * (1.0 - rho * c)),
          rho * (rho * 2.0 * s * c - m * c + m * rho * (c * c - s * s))};
}

struct Slides {
  std::mt19937_64 random{7};
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
  Hoop<double> hoop() { return reduce(0.3, uniform(0.2, 20.0), uniform(0.1, 1.0), uniform(0.1, 1.0), 0.0); }
};

TEST(PivotZeros, AreWhereThePivotVanishes) {
  Slides slides;
  int good = 0;
  constexpr int all = 2'000;
  for (int k = 0; k < all; ++k) {
    const Hoop<double> hoop = slides.hoop();
    const double m = slides.uniform(-1.5, 1.5);
    const PivotZeros<double> zeros = pivot_zeros(hoop, m);
    double farthest = 0.0;  // Newton's step from there
    for (std::size_t i = 0; i < 4; ++i) {
      double step = 1.0;
      for (const double side : {1.0, -1.0}) {
        const auto [value, rate] = pivot_at(hoop, m, {zeros.angle[i], side * zeros.height[i]});
        step = std::min(step, std::abs(value / rate));
      }
      farthest = std::max(farthest, step);
    }
    good += farthest < 1e-3;  // some few come slowly: two of their zeros lie side by side
  }
  EXPECT_GT(good, all * 98 / 100);
}

/// Without friction sin(phi) = +- i sqrt(Ic) / rho.
TEST(PivotZeros, AreKnownWithoutFriction) {
  Slides slides;
  for (int k = 0; k < 100; ++k) {
    const Hoop<double> hoop = slides.hoop();
    const PivotZeros<double> zeros = pivot_zeros(hoop, 0.0);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(std::sin(zeros.angle[i]), 0.0, 1e-6) << k;
      EXPECT_NEAR(zeros.height[i], std::asinh(std::sqrt(hoop.Ic) / hoop.rho), 1e-6) << k;
    }
  }
}

/// No zero is inside of the ellipse, and where one limits the length it is on it.
TEST(PivotZeros, LieOutsideOfAPanelsEllipse) {
  Slides slides;
  constexpr double longest = 2.0;
  int limited = 0;
  for (int k = 0; k < 2'000; ++k) {
    const PivotZeros<double> zeros = pivot_zeros(slides.hoop(), slides.uniform(-1.5, 1.5));
    const double angle = slides.uniform(-20.0, 20.0), way = k % 2 ? 1.0 : -1.0, stretch = 1.8,
                 shift = -slides.uniform(0.01, longest);
    const double length = resolved_length(zeros, angle, way, shift, stretch, longest);
    ASSERT_GT(length, 0.0) << k;
    ASSERT_LE(length, longest) << k;
    const double begin = std::sqrt(-shift), end = std::sqrt(length - shift);
    double nearest = 1e300;  // distances to the ends summed up, in panels
    for (std::size_t i = 0; i < 4; ++i)
      for (int turn = -8; turn <= 8; ++turn) {
        const double ahead = way * (zeros.angle[i] - angle) + 2.0 * std::numbers::pi * turn;
        const Complex q = std::sqrt(Complex{ahead - shift, zeros.height[i]});
        nearest = std::min(nearest, (std::abs(q - begin) + std::abs(q - end)) / (end - begin));
      }
    EXPECT_GT(nearest, stretch * (1.0 - 1e-9)) << k;
    if (length == longest) continue;
    ++limited;
    EXPECT_LT(nearest, stretch * (1.0 + 1e-9)) << k;
  }
  EXPECT_GT(limited, 200);
}

/// Whichever way it slides. What a panel keeps from zero is some hundredths of a radian.
TEST(EdgeLooks, SeeEveryPivotThatVanishes) {
  using Lane = WideOf<Batch>;
  constexpr std::size_t width = Lanes<Lane>::count;
  Slides slides;
  const EdgeLooks<Lane> looks;
  int with_edge = 0;
  for (int k = 0; k < 100; ++k) {
    std::array<Hoop<double>, width> hoops;
    LaneArray<Lane> m;
    for (std::size_t i = 0; i < width; ++i) hoops[i] = slides.hoop(), m[i] = slides.uniform(0.0, 1.5);
    Hoop<Lane> in_lanes{};
    in_lanes.rho = gathered<Lane>([&](std::size_t i) { return hoops[i].rho; });
    in_lanes.Ic = gathered<Lane>([&](std::size_t i) { return hoops[i].Ic; });
    const auto kept = lanes_of(looks.least_pivot(in_lanes, Lanes<Lane>::load(m.data())));
    for (std::size_t i = 0; i < width; ++i)
      for (const double way : {1.0, -1.0}) {
        double least = HUGE_VAL, steepest = 0.0;
        for (int look = 0; look < 500; ++look) {
          const auto [value, rate] = pivot_at(hoops[i], way * m[i], std::numbers::pi * look / 250.0);
          least = std::min(least, value.real()), steepest = std::max(steepest, std::abs(rate.real()));
        }
        if (least <= 0.0) {
          EXPECT_GT(kept[i], 0.02 * steepest) << hoops[i].rho << " " << m[i];
          EXPECT_LT(kept[i], 0.2 * steepest) << hoops[i].rho << " " << m[i];
          ++with_edge;
        }
        if (least > 0.1) {  // far more than the pivot can fall between two looks
          EXPECT_EQ(kept[i], 0.0) << hoops[i].rho << " " << m[i];
        }
      }
  }
  EXPECT_GT(with_edge, 50);
}

}  // namespace
}  // namespace leapmap
