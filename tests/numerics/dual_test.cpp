// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/dual.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hoop/flight.hpp"
#include "hoop/rolling_by_angle.hpp"
#include "hoop/units.hpp"
#include "noslip/exact.hpp"
#include "support/designs.hpp"
#include "support/reference_table.hpp"

namespace leapmap {
namespace {

using testing::uniform;

/// Something of everything that a Dual can do.
template <class T>
T of_all(const T& x, const T& y) {
  using std::abs, std::acos, std::asin, std::floor, std::sqrt;
  const SinCos<T> turned = sincos_of(x * y);
  const T a = sqrt(x + turned.sin * turned.sin) / (y - turned.cos * T(0.1)),
          b = acos(x * T(0.3)) - asin(y * T(0.2));
  return select(a > b, abs(-a) * b, a + b * floor(x * T(7.3)));
}

TEST(Dual, HasTheDerivativesThatDifferencesInLongDoubleTell) {
  std::mt19937_64 random(41);
  int compared = 0;
  for (int i = 0; i < 1'000; ++i) {
    const double x = uniform(random, 0.2, 2.0), y = uniform(random, 1.0, 3.0);
    using D = Dual<double, 2>;
    const D found = of_all(D::parameter(x, 0), D::parameter(y, 1));
    EXPECT_NEAR(found.value, of_all(x, y), 1e-14);  // the same operations, but for contractions
    const long double h = 1e-6L;
    const auto at = [&](long double dx, long double dy) { return of_all<long double>(x + dx, y + dy); };
    // Beside a step of the floor or of the choice differences tell nothing.
    if (std::abs(at(h, h) - at(-h, -h)) > 1e-3L) continue;
    ++compared;
    // Central differences are off by h^2 third derivatives, here up to some thousands.
    const auto expect_close = [&](double ours, long double differences) {
      EXPECT_LE(std::abs(ours - differences), 1e-8L * (1 + std::abs(differences))) << x << " " << y;
    };
    expect_close(found.by[0], (at(h, 0) - at(-h, 0)) / (2 * h));
    expect_close(found.by[1], (at(0, h) - at(0, -h)) / (2 * h));
  }
  EXPECT_GT(compared, 990);
}

TEST(Dual, InLanesIsADualInEachLane) {
  std::mt19937_64 random(42);
  constexpr std::size_t width = Lanes<Batch>::count;
  for (int i = 0; i < 200; ++i) {
    LaneArray<Batch> x, y;
    for (std::size_t k = 0; k < width; ++k)
      x[k] = uniform(random, 0.2, 2.0), y[k] = uniform(random, 1.0, 3.0);
    using Many = Dual<Batch, 2>;
    const Many found = of_all(Many::parameter(Lanes<Batch>::load(x.data()), 0),
                              Many::parameter(Lanes<Batch>::load(y.data()), 1));
    for (std::size_t k = 0; k < width; ++k) {
      using One = Dual<double, 2>;
      const One alone = of_all(One::parameter(x[k], 0), One::parameter(y[k], 1));
      EXPECT_NEAR(lanes_of(found)[k], alone.value, 1e-13);  // roundings of two sines and square roots
      for (std::size_t p = 0; p < 2; ++p)
        EXPECT_NEAR(lanes_of(found.by[p])[k], alone.by[p], 1e-12 * (1.0 + std::abs(alone.by[p])));
    }
  }
}

TEST(Dual, BesideAnEdgeAParameterThatDoesNotActHasNoDerivative) {
  using D = Dual<double, 2>;
  D nothing(0.0);
  nothing.by[0] = 1.0;
  EXPECT_EQ(sqrt(nothing).by[1], 0.0);
  EXPECT_TRUE(std::isinf(sqrt(nothing).by[0])) << "a fold";
}

/// The equations of rolling and flight as they stand, on duals, at roots found in plain numbers.
TEST(Dual, EquationsOnDualsGiveTheTablesDerivativesOfHeights) {
  using D = Dual<double, 7>;
  const Scene scene;
  const auto rows = testing::read_reference("noslip_gradient.csv");
  constexpr std::array names{"slope",         "mass_ratio",   "offset_ratio", "inertia_factor",
                             "release_angle", "release_spin", "drive_torque"};
  ExactSolver<double> solver(1e-12);
  std::size_t compared = 0;
  for (const testing::ReferenceRow& row : rows) {
    const Design design = row.design();
    Outcome outcome;
    solver.solve({&design, 1}, scene, {&outcome, 1});
    ASSERT_EQ(outcome.status, Status::jumped);
    std::array<D, 7> p;
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = D::parameter(row.number(names[k]), k);
    const Hoop<D> hoop = reduce(p[0], p[1], p[2], p[3], p[6]);
    const Roll<D> roll = begin_roll(hoop, p[4], p[5]);
    const auto at_root = [](const auto& f, double x) {
      const auto sample = f(D(x));
      return D(x) - sample.value / sample.rate;
    };
    const D angle = at_root([&](const D& x) { return lift(roll, x); }, outcome.jump_angle);
    const Trig<D> phi = trig(angle);
    const D spin = sqrt(vis_viva(roll, angle, phi) / contact_inertia(hoop, phi));
    const Toss<D> toss = toss_of(hoop, angle, phi, spin);
    const D apex = at_root([&](const D& psi) { return toss_climb(toss, psi); },
                           outcome.apex_time / time_unit(scene) * outcome.jump_spin);
    const D height = D(0.5) * hoop.rho * toss_height(toss, apex).value;
    for (std::size_t k = 0; k < p.size(); ++k) {
      const std::string column = std::string("jump_height_by_") + names[k];
      if (!row.has(column)) continue;
      ++compared;
      // Some tens of roundings; the worst here is 3e-15.
      EXPECT_NEAR(height.by[k] / row.number(column), 1.0, 1e-13) << column;
    }
  }
  EXPECT_GT(compared, 6 * rows.size());
}

}  // namespace
}  // namespace leapmap
