// SPDX-License-Identifier: GPL-3.0-or-later
#include "hoop/flight_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "numerics/gsl_integrator.hpp"
#include "support/designs.hpp"

namespace leapmap {
namespace {

using FlightState = State<6>;  // x, y, phi, x', y', phi'; y is the height of the lowest point

/// (13) as the paper states it: three coupled equations with the full mass matrix, in units of m + m_p, R, g.
int flight_rhs(double, const double y[], double f[], void* params) {
  const auto& hoop = *static_cast<const Hoop<double>*>(params);
  const double s = std::sin(y[2]), c = std::cos(y[2]), w2 = y[5] * y[5];
  Eigen::Matrix3d mass;
  mass << 1, 0, -hoop.rho * c, 0, 1, hoop.rho * s, -hoop.rho * c, hoop.rho * s, hoop.Ic + hoop.rho * hoop.rho;
  const Eigen::Vector3d force(-hoop.rho * w2 * s + hoop.sin_slope, -hoop.rho * w2 * c - hoop.cos_slope,
                              -hoop.rho * std::sin(slope_of(hoop) + y[2]));
  const Eigen::Vector3d acceleration = mass.inverse() * force;
  for (int i = 0; i < 3; ++i) f[i] = y[3 + i], f[3 + i] = acceleration[i];
  return GSL_SUCCESS;
}

/// A lift-off of a random design that flies high enough to be a jump, by the integrated rolling.
struct RandomJump {
  Design design;
  LiftOff<double> lift_off;
};
std::vector<RandomJump> random_jumps(int count) {
  std::mt19937_64 random(5);
  std::vector<RandomJump> jumps;
  while (static_cast<int>(jumps.size()) < count) {
    const Design design = testing::random_design(random);
    const Outcome outcome = testing::solve(design);
    if (outcome.status == Status::jumped)
      jumps.push_back({design, {outcome.jump_time, outcome.jump_angle, outcome.jump_spin}});
  }
  return jumps;
}

TEST(Flight, HeightEqualsTheFormulaAsWritten) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 1000; ++i) {
    const Hoop<double> hoop = reduce<double>(testing::random_design(random));
    const double angle = testing::uniform(random, 0.0, 30.0), spin = testing::uniform(random, 0.5, 4.0);
    const double t = testing::uniform(random, 0.0, 4.0);
    const double y = -hoop.rho * std::cos(angle) + hoop.rho * std::sin(angle) * spin * t -
                     hoop.cos_slope * t * t / 2 + hoop.rho * std::cos(angle + spin * t);
    EXPECT_NEAR(height_above_plane(hoop, trig(angle), spin, t).value, y,
                1e-13);  // terms up to 20, a few roundings
  }
}

TEST(Flight, HeightIsAccurateRightAfterLiftOff) {
  // The leading term at a lift-off from rolling is y'' t^2 / 2; the formula as written has lost it at t =
  // 1e-8.
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  const double angle = 13.948749008421659, spin = 2.3312558443174480, t = 1e-8;
  const double leading = (-hoop.rho * spin * spin * std::cos(angle) - hoop.cos_slope) * t * t / 2;
  EXPECT_NEAR(height_above_plane(hoop, trig(angle), spin, t).value / leading, 1.0,
              1e-7);  // next term: order t
}

TEST(Flight, ClosedFormEqualsIntegrationOfThePapersEquations) {
  for (const RandomJump& jump : random_jumps(50)) {
    Hoop<double> hoop = reduce<double>(jump.design);
    const Flight<double> flight = fly(hoop, jump.lift_off);
    const auto [time, angle, spin] = jump.lift_off;
    GslIntegrator<6> integrator(*find_gsl_stepper("gsl-rk8pd"), {1e-13, 1e-13, 0.0},
                                {&flight_rhs, nullptr, 6, &hoop});
    ASSERT_TRUE(integrator.start({angle, 0.0, angle, spin, 0.0, spin}, 1e-3));
    double highest = 0.0, landing = 0.0;
    while (landing == 0.0) {
      ASSERT_TRUE(integrator.advance());
      const Step<6>& step = integrator.step();
      for (int k = 1; k <= 50;
           ++k) {  // 50 looks a step: the parabola's top is missed by less than 1e-4 of its height
        FlightState y;
        const double tau = step.h * k / 50;
        ASSERT_TRUE(integrator.retake(tau, y));
        const double flown = step.t0 + tau;
        // 1e-10: the integration's own error over some hundred steps
        EXPECT_NEAR(height_above_plane(hoop, trig(angle), spin, flown).value, y[1], 1e-10);
        EXPECT_NEAR(travel_in_flight(hoop, trig(angle), spin, 0.0, flown).value, y[0] - angle, 1e-10);
        EXPECT_NEAR(spin, y[5], 1e-11);
        highest = std::max(highest, y[1] / 2);
        if (landing == 0.0 && highest > 0.0 && y[1] <= 0.0) landing = flown;
      }
    }
    EXPECT_NEAR(flight.height, highest, 1e-3 * highest);
    EXPECT_GE(flight.height, highest - 1e-10);
    EXPECT_NEAR(flight.flight_time, landing, 0.02 * landing);  // one look late at most
  }
}

TEST(Flight, ApexAndLandingAreWhereTheyShouldBe) {
  for (const RandomJump& jump : random_jumps(200)) {
    const Hoop<double> hoop = reduce<double>(jump.design);
    const Flight<double> flight = fly(hoop, jump.lift_off);
    const auto at = [&](double t) {
      return height_above_plane(hoop, trig(jump.lift_off.angle), jump.lift_off.spin, t);
    };
    EXPECT_NEAR(at(flight.apex_time).value / 2, flight.height, 1e-15 * (1 + flight.height));  // roundings
    EXPECT_NEAR(at(flight.apex_time).rate, 0.0, 1e-13);  // y'' is of order one, the apex good to rounding
    EXPECT_NEAR(at(flight.flight_time).value, 0.0, 1e-13);
    EXPECT_LT(at(flight.flight_time).rate, 0.0);
    EXPECT_LT(flight.apex_time, flight.flight_time);
    EXPECT_LE(flight.dip, 0.0);
    for (int k = 1; k < 1000; ++k) {
      const double t = flight.flight_time * k / 1000;
      EXPECT_LE(at(t).value / 2, flight.height * (1 + 1e-14)) << "a higher point than the apex";
      if (t > flight.apex_time) {
        EXPECT_GT(at(t).value, 0.0) << "landed earlier";
      }
    }
  }
}

TEST(Flight, ThePapersJumpDipsBelowThePlaneBeforeItRises) {
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  const Flight<double> flight = fly<double>(hoop, {0.0, 13.948749008421659, 2.3312558443174480});
  EXPECT_NEAR(flight.dip, -0.0188531, 1e-7);               // 1.9 % of a diameter
  EXPECT_NEAR(flight.height, 0.98280096607011718, 1e-12);  // the spin above is good to 1e-13
}

TEST(Flight, ALiftOffThatGravityWinsFromTheStartHasNoHeight) {
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  for (const double spin : {0.0, 0.5, 0.99 * std::sqrt(hoop.cos_slope / hoop.rho)}) {
    const Flight<double> flight = fly<double>(hoop, {0.0, 4.0, spin});
    EXPECT_EQ(flight.height, 0.0);
    EXPECT_EQ(flight.flight_time, 0.0);
    EXPECT_EQ(flight.dip, 0.0);
  }
}

TEST(Flight, ATripleRootAtTheStartIsNotALanding) {
  // After sliding y, y' and y'' vanish together: cos(phi) = -cos(theta) / (rho w^2). The hoop rises if y''' >
  // 0.
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  for (const double spin : {1.5, 2.0, 3.0, 5.0}) {
    const double angle = std::acos(-hoop.cos_slope / (hoop.rho * spin * spin));
    for (const int nudge : {-1, 0, 1}) {  // one rounding to either side of the exact triple root
      const double start = nudge == 0 ? angle : std::nextafter(angle, nudge * 10.0);
      const Flight<double> flight = fly<double>(hoop, {0.0, start, spin});
      EXPECT_GT(flight.height, 0.01);
      EXPECT_GT(flight.flight_time, 0.1);
      EXPECT_GT(flight.dip, -1e-12);  // the nudge's own dip is of order 1e-16
    }
  }
}

TEST(Flight, AFastSpinsThousandTurnsAreLeaptOverWithoutMissingApexOrLanding) {
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  for (const double spin : {30.0, 300.0, 2e4}) {
    for (const double angle : {1.7, 2.5, 3.1, 3.3, 5.0}) {
      const Flight<double> flight = fly<double>(hoop, {0.0, angle, spin});
      // The parabola's apex and end, within the band of 2 rho that the turning mass adds.
      const double drift = hoop.rho * std::sin(angle) * spin, k = hoop.cos_slope;
      if (drift < 10.0) continue;
      EXPECT_NEAR(2 * flight.height, drift * drift / (2 * k), 2 * hoop.rho);
      EXPECT_NEAR(flight.flight_time, 2 * drift / k, 4 * hoop.rho / drift + 1e-9);
      const auto at = [&](double t) { return height_above_plane(hoop, trig(angle), spin, t).value; };
      EXPECT_NEAR(at(flight.flight_time), 0.0, 1e-6 * spin);  // a rounding of t turns into spin times as much
      for (int i = -3000; i <= 3000; ++i)                     // every tenth of a turn or less around the apex
        EXPECT_LE(at(flight.apex_time + 0.2 * i / spin), 2 * flight.height * (1 + 1e-12))
            << spin << " " << angle;
      for (int i = 1; i < 3000; ++i)
        EXPECT_GT(at(flight.flight_time - 0.2 * i / spin), 0.0) << "landed earlier: " << spin << " " << angle;
    }
  }
}

TEST(Flight, LanesFlyAsOneTossDoesThroughOneClimbOrMany) {
  std::mt19937_64 random(8);
  constexpr std::size_t width = Lanes<Batch>::count;
  int several = 0;
  for (std::size_t round = 0; round < 4000 / width; ++round) {
    LaneArray<Batch> angles, spins;
    Design design = testing::random_design(random);
    const Hoop<double> hoop = reduce<double>(design);
    for (std::size_t i = 0; i < width; ++i) {
      angles[i] = testing::uniform(random, 0.0, 20.0);
      spins[i] = std::exp(testing::uniform(random, -0.5, 3.0));
    }
    const Batch angle = Lanes<Batch>::load(angles.data()), spin = Lanes<Batch>::load(spins.data());
    Hoop<Batch> same;
    same.rho = Batch(hoop.rho), same.cos_slope = Batch(hoop.cos_slope);
    const Toss<Batch> toss = toss_of(same, angle, trig(angle), spin);
    const Ascent<Batch> ascent = ascend(toss, spin == spin);
    const Flight<Batch> flight = scaled(descend(toss, ascent, spin == spin), same, spin);
    for (std::size_t i = 0; i < width; ++i) {
      // the walk from knot to knot, another way to the same roots
      const Toss<double> one = toss_of(hoop, angles[i], trig(angles[i]), spins[i]);
      const Flight<double> walked =
          one.fastest > 0.0 ? scaled(walk_toss(one), hoop, spins[i]) : Flight<double>{};
      if (one.fastest > 2.0 * std::numbers::pi * one.gravity) ++several;
      EXPECT_NEAR(lanes_of(flight.height)[i], walked.height, 1e-13 * (1.0 + walked.height));
      EXPECT_NEAR(lanes_of(flight.apex_time)[i], walked.apex_time, 1e-12 * (1.0 + walked.apex_time));
      EXPECT_NEAR(lanes_of(flight.flight_time)[i], walked.flight_time, 1e-12 * (1.0 + walked.flight_time));
      EXPECT_NEAR(lanes_of(flight.dip)[i], walked.dip, 1e-13);
    }
  }
  EXPECT_GT(several, 500) << "tosses that climb more than once are among them";
}

TEST(Flight, LandsOnlyWhereThatIsAskedFor) {
  std::mt19937_64 random(9);
  constexpr std::size_t width = Lanes<Batch>::count;
  const auto lanes_between = [&](double from, double to) {
    LaneArray<Batch> numbers;
    for (double& number : numbers) number = testing::uniform(random, from, to);
    return Lanes<Batch>::load(numbers.data());
  };
  const Hoop<double> one = reduce<double>(Design{.slope = 0.3, .mass_ratio = 4.0, .offset_ratio = 0.9});
  Hoop<Batch> hoop;
  hoop.rho = Batch(one.rho), hoop.cos_slope = Batch(one.cos_slope), hoop.aloft = Batch(0.0);
  int low = 0, high = 0;
  for (int round = 0; round < 300; ++round) {
    const LiftOff<Batch> lift_off{Batch(0.0), lanes_between(1.0, 4.0), lanes_between(0.5, 4.0)};
    const Flight<Batch> whole = fly(hoop, lift_off);
    const auto heights = lanes_of(whole.height), times = lanes_of(whole.flight_time),
               dips = lanes_of(whole.dip);
    const double threshold = heights[0];  // which a flight that gets as high does not stay below
    const Flight<Batch> asked = fly(hoop, lift_off, {Batch(threshold), false}),
                        dipping = fly(hoop, lift_off, {Batch(threshold), true});
    const auto height = lanes_of(asked.height), time = lanes_of(asked.flight_time),
               apex = lanes_of(asked.apex_time), whole_apex = lanes_of(whole.apex_time),
               dip = lanes_of(dipping.dip);
    for (std::size_t i = 0; i < width; ++i) {
      EXPECT_EQ(height[i], heights[i]);
      EXPECT_EQ(apex[i], whole_apex[i]);
      (heights[i] < threshold ? low : high) += heights[i] > 0.0;
      if (!(heights[i] < threshold)) continue;
      EXPECT_EQ(time[i], times[i]);
      EXPECT_EQ(dip[i], dips[i]);
    }
  }
  EXPECT_GT(low, 100);
  EXPECT_GT(high, 100);
}

TEST(Flight, BackwardSpinFliesTheMirrorImage) {
  const Hoop<double> hoop = reduce<double>(testing::paper_hoop());
  const Flight<double> forward = fly<double>(hoop, {0.0, 1.4, 2.3}),
                       backward = fly<double>(hoop, {0.0, -1.4, -2.3});
  EXPECT_GT(forward.height, 0.1);
  EXPECT_EQ(forward.height, backward.height);
  EXPECT_EQ(forward.flight_time, backward.flight_time);
}

TEST(Flight, XMinusSinIsAccurateOnBothSidesOfItsSwitch) {
  for (const double x : {1e-8, 1e-3, 0.5, 0.69999, 0.70001, 1.0, -0.6, 3.0}) {
    const long double truth = x_minus_sin<long double>(x, trig<long double>(x));
    EXPECT_NEAR(x_minus_sin(x, trig(x)) / static_cast<double>(truth), 1.0, 3e-15)
        << x;  // x - sin x loses a digit at 0.7
  }
}

}  // namespace
}  // namespace leapmap
