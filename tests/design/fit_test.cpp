// SPDX-License-Identifier: GPL-3.0-or-later
/// Motions at given times, least squares, and fits to films whose truth is known.
#include "leapmap/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "design/least_squares.hpp"
#include "film/motion_at.hpp"
#include "hoop/rolling_by_angle.hpp"
#include "hoop/units.hpp"
#include "leapmap/leapmap.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int usual_films = 2, random_designs = 4;  // with sanitizers a film takes twenty times as long
#else
constexpr int usual_films = 12, random_designs = 60;
#endif

/// How many films to fit: LEAPMAP_FILMS if it is set.
int films() {
  const char* asked = std::getenv("LEAPMAP_FILMS");
  return asked ? std::atoi(asked) : usual_films;
}

Scene scene_of(Friction friction) { return {.friction = friction}; }

/// Designs that jump after hops, slips and turns, by chance.
Design jumping_design(std::mt19937_64& random, Friction friction) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  Design design{.slope = between(0.1, 0.6),
                .mass_ratio = between(0.5, 6.0),
                .offset_ratio = between(0.6, 1.0),
                .inertia_factor = between(0.6, 1.0),
                .release_angle = between(2.5, 5.0),
                .release_spin = between(-0.2, 0.5),
                .drive_torque = between(0.0, 0.1),
                .resisting_torque = between(0.005, 0.03)};
  if (friction == Friction::coulomb)
    design.mu_static = between(0.2, 1.0), design.restitution = between(0.0, 0.3);
  return design;
}

std::vector<double> even_times(double end, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(end * (i + 0.5) / count);
  return times;
}

class Motions : public ::testing::TestWithParam<Friction> {};

TEST_P(Motions, AtGivenTimesAreThoseOfATrace) {
  std::mt19937_64 random(3);
  int compared = 0;
  for (int i = 0; i < random_designs; ++i) {
    const Design design = jumping_design(random, GetParam());
    Scene scene = scene_of(GetParam());
    scene.jumps = 1 + i % 3;
    const Motion traced = trace(design, scene, {.interval = 5e-3, .tolerance = 1e-12});
    if (traced.outcome.status != Status::jumped) continue;
    std::vector<double> times;
    std::vector<MotionPoint> points;
    for (const MotionPoint& point : traced.points)
      if ((times.empty() || point.t > times.back()) && point.t < traced.end)
        times.push_back(point.t), points.push_back(point);
    const auto motion = motion_at<double>(design, scene, times);
    ASSERT_EQ(motion.size(), points.size());
    for (std::size_t k = 0; k < motion.size(); ++k) {
      // Both know the time to 1e-12, and a spin of up to ten takes the angle along.
      ASSERT_NEAR(motion[k].phi, points[k].phi, 1e-11) << "design " << i << " at " << times[k];
      ASSERT_NEAR(motion[k].x * 0.041, points[k].x, 1e-12);
      ASSERT_NEAR(motion[k].y * 0.041, points[k].y, 1e-12);
    }
    ++compared;
  }
  EXPECT_GE(compared, random_designs / 3);
}

TEST_P(Motions, HaveTheDerivativesThatDifferencesShow) {
  std::mt19937_64 random(4);
  int compared = 0, rough = 0;
  Scene scene = scene_of(GetParam());
  const std::size_t parameters = GetParam() == Friction::coulomb ? 9 : 8;
  for (int i = 0; i < random_designs; ++i) {
    const Design design = jumping_design(random, GetParam());
    scene.jumps = 1 + i % 2;
    const Motion traced = trace(design, scene, {.interval = 0.0});
    if (traced.outcome.status != Status::jumped) continue;
    const Candidate& last = traced.candidates.back();
    const auto times = even_times(last.t + 0.9 * last.flight_time, 23);
    const auto motion = motion_at<DesignDual>(design, scene, times);
    ASSERT_EQ(motion.size(), times.size());
    for (std::size_t k = 0; k < parameters; ++k) {
      constexpr double step = 1e-6;
      Design more = design, less = design;
      more.*differentiable[k] += step, less.*differentiable[k] -= step;
      const auto after = motion_at<double>(more, scene, times),
                 before = motion_at<double>(less, scene, times);
      ASSERT_EQ(after.size(), times.size());
      for (std::size_t n = 0; n < times.size(); ++n)
        for (const auto& [dual, high, low] : {std::tuple{motion[n].phi, after[n].phi, before[n].phi},
                                              {motion[n].x, after[n].x, before[n].x},
                                              {motion[n].y, after[n].y, before[n].y}}) {
          ++compared;
          const double difference = (high - low) / (2.0 * step);
          // Rounding 1e-11 over 2e-6, and a third derivative times 1e-12; where a step passes a cliff nothing
          // holds.
          rough += !(std::abs(dual.by[k] - difference) <= 3e-5 * (1.0 + std::abs(difference)));
        }
    }
  }
  EXPECT_GT(compared, random_designs * 50);
  EXPECT_LT(rough, compared / 50) << "of " << compared << ": beside kinks in time, and cliffs";
}

TEST_P(Motions, HaveTheSameDerivativesBySomeParametersAsByAll) {
  std::mt19937_64 random(5);
  constexpr std::array some{by_release_spin, by_slope, by_release_angle, std::size_t{1}};
  const Design design = jumping_design(random, GetParam());
  const auto times = even_times(2.0, 40);
  const auto all = motion_at<DesignDual>(design, scene_of(GetParam()), times);
  const auto few = motion_at<FewDual>(design, scene_of(GetParam()), times, 1e-11, some);
  ASSERT_EQ(few.size(), all.size());
  for (std::size_t n = 0; n < few.size(); ++n)
    for (std::size_t k = 0; k < some.size(); ++k)
      // Steps are halved by the largest derivative of those that are there: both within the accuracy.
      ASSERT_NEAR(few[n].phi.by[k], all[n].phi.by[some[k]], 1e-7 * (1.0 + std::abs(all[n].phi.by[some[k]])))
          << "by " << some[k] << " at " << times[n];
}

INSTANTIATE_TEST_SUITE_P(Models, Motions, ::testing::Values(Friction::sticking, Friction::coulomb),
                         [](const auto& model) {
                           return model.param == Friction::sticking ? "sticking" : "coulomb";
                         });

TEST(FilmMotions, GoOnForEverWhereAHoopRocks) {
  const Design design{.slope = 0.05, .release_angle = 0.6, .release_spin = 0.2};
  const Scene scene;
  ASSERT_EQ(solve(design, scene).status, Status::stalled);
  const double second = time_unit(scene), step = 1e-4 * second;
  std::vector<double> times;
  for (const double t : even_times(60.0 * second, 400)) times.insert(times.end(), {t - step, t, t + step});
  const auto motion = motion_at<double>(design, scene, times);
  ASSERT_EQ(motion.size(), times.size());
  const Hoop<double> hoop = reduce<double>(design, scene);
  const double energy = rolling_energy(hoop, design.release_angle, design.release_spin);
  int turns = 0;
  for (std::size_t k = 1; k < motion.size(); k += 3) {
    EXPECT_NEAR(rolling_energy(hoop, motion[k].phi, motion[k].spin), energy, 1e-12) << times[k];
    // Of differences over 2e-4 the third derivative leaves some 1e-9.
    EXPECT_NEAR((motion[k + 1].phi - motion[k - 1].phi) / 2e-4, motion[k].spin, 1e-8) << times[k];
    EXPECT_NEAR((motion[k + 1].spin - motion[k - 1].spin) / 2e-4, motion[k].spin_rate, 1e-7) << times[k];
    turns += k > 3 && motion[k].spin * motion[k - 3].spin < 0.0;
  }
  EXPECT_GT(turns, 10);
}

TEST(FilmMotions, EndWhereAResistingTorqueHoldsTheHoop) {
  const Design design{.slope = 0.02, .release_angle = 0.02, .release_spin = 0.05, .resisting_torque = 0.1};
  const Scene scene;
  ASSERT_EQ(solve(design, scene).status, Status::stalled);
  const auto motion =
      motion_at<FewDual>(design, scene, even_times(5.0, 50), 1e-11, std::array{by_release_spin});
  ASSERT_EQ(motion.size(), 50u);
  const Hoop<double> hoop = reduce<double>(design, scene);
  const MotionAt<FewDual>& last = motion.back();
  EXPECT_EQ(last.spin.value, 0.0);
  EXPECT_EQ(last.spin.by[0], 0.0);
  EXPECT_NEAR(rolling_energy(hoop, last.phi.value, 0.0),
              rolling_energy(hoop, design.release_angle, design.release_spin), 1e-14);
  // What it came to rest at follows from its energy: torque dphi = J w dw at the release.
  const double J = contact_inertia(hoop, trig(design.release_angle));
  EXPECT_NEAR(last.phi.by[0] * torque(hoop, trig(last.phi.value)), -J * design.release_spin, 1e-12);
}

TEST(FilmMotions, EndWhereAResistingTorqueHoldsAHoopThatSlidesAfterTheSearchsEnd) {
  const Scene scene{.friction = Friction::coulomb, .motor_in_flight = false};
  const Design design{.slope = 0.16355439059385629,
                      .mass_ratio = 0.63707172558885927,
                      .offset_ratio = 0.40771923170099661,
                      .inertia_factor = 0.77297619223111136,
                      .release_angle = 2.2937298517296032,
                      .release_spin = 1.5965092294908581,
                      .resisting_torque = 0.01117926162208626,
                      .mu_static = 0.98773630547262081,
                      .restitution = 0.78539083496470463};
  const auto motion = motion_at<double>(design, scene, even_times(2.0, 400));
  ASSERT_EQ(motion.size(), 400u);
  EXPECT_EQ(motion.back().spin, 0.0);
  for (const MotionAt<double>& at : motion) EXPECT_GE(at.spin, 0.0);
}

/// A roll over a crest that it all but stalls on, as far as roundings of its energy let it be known.
TEST(FilmMotions, AreKnownBesideAStall) {
  Scene scene;
  scene.hop_height = 10.0;
  for (const double beside : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const Design design{.slope = 0.1,
                        .mass_ratio = 3.0,
                        .offset_ratio = 0.9,
                        .release_angle = 0.3,
                        .release_spin = 1.9051270592669241 * (1.0 + beside)};
    const auto times = even_times(2.0, 60);
    constexpr std::array by{by_release_spin};
    for (const double accuracy : {1e-6, 1e-11})
      EXPECT_EQ(motion_at<double>(design, scene, times, accuracy).size(), times.size()) << beside;
    EXPECT_EQ(motion_at<FewDual>(design, scene, times, 1e-7, by).size(), times.size()) << beside;
    const auto motion = motion_at<double>(design, scene, times);
    const Motion traced = trace(design, scene, {.interval = 0.05, .tolerance = 1e-12});
    std::vector<double> at;
    for (const MotionPoint& point : traced.points) at.push_back(point.t);
    at.resize(at.size() / 2);
    const auto same = motion_at<double>(design, scene, at);
    ASSERT_EQ(same.size(), at.size());
    // E is known to 1e-16 of about 1, and the time on the crest to that over what is left of E.
    for (std::size_t k = 0; k < at.size(); ++k)
      EXPECT_NEAR(same[k].phi, traced.points[k].phi, 1e-11 + 1e-14 / beside) << beside << " at " << at[k];
  }
}

/// Phases that last for a rounding: with hop_height = 0 every lift-off is a jump.
TEST(FilmMotions, PassPhasesOfNoTime) {
  Scene scene{.motor_in_flight = false};
  scene.hop_height = 0.0, scene.jumps = 4;
  const Design design{.slope = 0.7542356066379261,
                      .mass_ratio = 23.064648642872971,
                      .offset_ratio = 0.88763580951345333,
                      .inertia_factor = 0.78298282691039844,
                      .release_angle = 2.0572113304796158,
                      .release_spin = 3.3105295026512359e-08};
  const Motion traced = trace(design, scene, {.interval = 0.0, .tolerance = 1e-12});
  std::vector<double> times;
  for (const PhaseStart& phase : traced.phases)
    for (const double t : {phase.t, phase.t, std::nextafter(phase.t, 1.0)}) times.push_back(t);
  std::ranges::sort(times);
  EXPECT_EQ(motion_at<double>(design, scene, times).size(), times.size());
  constexpr std::array by{by_slope};
  EXPECT_EQ(motion_at<FewDual>(design, scene, times, 1e-9, by).size(), times.size());
}

TEST(FilmMotions, OfASlideFromRestBeginWithTheReleaseSpin) {
  const Scene scene{.friction = Friction::coulomb};
  const Design design{.slope = 0.9, .mass_ratio = 0.13, .release_angle = -2.97, .mu_static = 0.38};
  constexpr std::array by{by_release_spin};
  const auto motion = motion_at<FewDual>(design, scene, std::array{0.0, 1e-9, 0.1}, 1e-9, by);
  ASSERT_EQ(motion.size(), 3u);
  ASSERT_EQ(trace(design, scene, {.interval = 0.0}).phases.front().phase, Phase::sliding);
  EXPECT_NEAR(motion[0].spin.by[0], 1.0, 1e-14);
  EXPECT_NEAR(motion[1].spin.by[0], 1.0, 1e-6) << "the same a billionth of a second later";
}

/// Long after the search's end, as a log of an encoder may be.
TEST(FilmMotions, OfALongSlideAreFollowedToTheEnd) {
  const Scene scene{.friction = Friction::coulomb};
  const Design design{.slope = 0.5, .mass_ratio = 0.5, .offset_ratio = 0.3, .mu_static = 0.05};
  const auto times = even_times(60.0, 500);
  constexpr std::array by{by_slope};
  EXPECT_EQ(motion_at<double>(design, scene, times).size(), times.size());
  EXPECT_EQ(motion_at<FewDual>(design, scene, times, 1e-7, by).size(), times.size());
}

/// A hoop that rocks in its place and slides all the time: derivatives at fixed angles would lose their
/// digits from turn to turn.
TEST(FilmMotions, KeepTheirDerivativesOverManyTurnsOfASlide) {
  const Scene scene{.friction = Friction::coulomb};
  const Design design{.slope = 0.15040848369427698,
                      .mass_ratio = 10.241850943878941,
                      .offset_ratio = 0.92655322382412053,
                      .inertia_factor = 0.7063462368652369,
                      .release_angle = 5.8288206691149735,
                      .release_spin = -0.1024366317565,
                      .mu_static = 0.13295607678620708,
                      .restitution = 0.25828442400442864};
  const auto times = even_times(3.0, 60);
  constexpr std::array by{by_slope, by_release_angle, by_release_spin, by_mu_static};
  const auto motion = motion_at<FewDual>(design, scene, times, 1e-9, by);
  ASSERT_EQ(motion.size(), times.size());
  for (std::size_t j = 0; j < by.size(); ++j) {
    const auto difference = [&](double step) {
      Design more = design, less = design;
      more.*differentiable[by[j]] += step, less.*differentiable[by[j]] -= step;
      const auto after = motion_at<double>(more, scene, times),
                 before = motion_at<double>(less, scene, times);
      std::vector<double> of_angle;
      for (std::size_t k = 0; k < times.size(); ++k)
        of_angle.push_back((after[k].phi - before[k].phi) / (2.0 * step));
      return of_angle;
    };
    const auto coarse = difference(1e-4), fine = difference(5e-5);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double extrapolated = (4.0 * fine[k] - coarse[k]) / 3.0;
      // The fifth derivative times 1e-17, and 1e-12 over 1e-4; before, the last ones were off by 1e-2.
      EXPECT_NEAR(motion[k].phi.by[j], extrapolated, 1e-7 * (1.0 + std::abs(extrapolated)))
          << "by " << by[j] << " at " << times[k];
    }
  }
}

TEST(FilmMotions, OfManyThousandFramesHaveDerivativesToo) {
  const Scene scene{.friction = Friction::coulomb};
  const auto times = even_times(1.2, 20'000);
  constexpr std::array by{by_mu_static};
  EXPECT_EQ(motion_at<FewDual>({.slope = 0.15, .mu_static = 0.4}, scene, times, 1e-7, by).size(),
            times.size());
}

TEST(LeastSquaresFits, FindTheCertifiedValuesOfMisra1a) {
  // NIST StRD, Misra1a: y = b1 (1 - exp(-b2 x)); b1 = 2.3894212918e2, b2 = 5.5015643181e-4,
  // sum 1.2455138894e-1.
  const std::vector<double> y{10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                              44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78},
      x{77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
  LeastSquares problem{.bounds = {{1.0, 1000.0}, {1e-5, 1e-2}}, .residuals = y.size(), .evaluate = {}};
  problem.evaluate = [&](std::span<const double> b, std::span<double> r, std::span<double> jacobian) {
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double decay = std::exp(-b[1] * x[i]);
      if (!r.empty()) r[i] = b[0] * (1.0 - decay) - y[i];
      if (!jacobian.empty()) jacobian[2 * i] = 1.0 - decay, jacobian[2 * i + 1] = b[0] * x[i] * decay;
    }
    return true;
  };
  const LeastSquaresFit fit = minimize(problem, std::vector{500.0, 1e-4});  // NIST's first start
  EXPECT_NEAR(fit.at[0], 2.3894212918e2, 1e-7 * 238.9);
  EXPECT_NEAR(fit.at[1], 5.5015643181e-4, 1e-7 * 5.5e-4);
  EXPECT_NEAR(fit.sum, 1.2455138894e-1, 1e-9);
}

TEST(LeastSquaresFits, StayWithinTheirBounds) {
  LeastSquares problem{.bounds = {{0.0, 1.0}}, .residuals = 1, .evaluate = {}};
  problem.evaluate = [](std::span<const double> at, std::span<double> r, std::span<double> jacobian) {
    EXPECT_GE(at[0], 0.0);
    EXPECT_LE(at[0], 1.0);
    if (!r.empty()) r[0] = at[0] - 3.0;
    if (!jacobian.empty()) jacobian[0] = 1.0;
    return true;
  };
  EXPECT_NEAR(minimize(problem, std::vector{0.2}).at[0], 1.0, 1e-6)
      << "the bound is reached as a square root";
}

/// A film at a thousand frames a second, its markers 0.3 mm off.
Measurements filmed(const Design& truth, const Scene& scene, double error, int seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::normal_distribution<double> off(0.0, error);
  Measurements measured{.origin = "film"};
  const Motion motion = trace(truth, scene, {.interval = 1e-3});
  Track mass{.name = "P"}, centre{.name = "O", .at = 0.0};
  for (const MotionPoint& point : motion.points) {
    if (!mass.t.empty() && point.t <= mass.t.back()) continue;
    mass.t.push_back(point.t), centre.t.push_back(point.t);
    const double x = point.x + 0.11, y = point.y + scene.radius - 0.02, L = truth.offset_ratio * scene.radius;
    mass.x.push_back(x - L * std::sin(point.phi) + off(random));
    mass.y.push_back(y - L * std::cos(point.phi) + off(random));
    centre.x.push_back(x + off(random)), centre.y.push_back(y + off(random));
  }
  measured.film.tracks = {mass, centre};
  return measured;
}

TEST(Fits, FindTheTruthOfAFilmWithinThreeErrorsIn95PercentOfSeeds) {
  const int seeds = films();
  const Design truth{.release_angle = degrees(190), .release_spin = 0.05, .mu_static = 0.4};
  const Scene scene = scene_of(Friction::coulomb);
  int within = 0;
  double squares = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    const FitReport report = fit(filmed(truth, scene, 3e-4, seed), {},
                                 {.models = {Friction::coulomb}, .coarse = 128, .starts = 2});
    const ModelFit& found = report.models[0];
    ASSERT_EQ(found.parameters.size(), 3u);
    bool all = true;
    for (const FittedParameter& parameter : found.parameters) {
      const double wanted = parameter.name == "release_angle"  ? truth.release_angle
                            : parameter.name == "release_spin" ? truth.release_spin
                                                               : truth.mu_static;
      const double off = (parameter.value - wanted) / parameter.error;
      all = all && parameter.identified && std::abs(off) <= 3.0;
      squares += off * off;
    }
    within += all;
    EXPECT_NEAR(found.error, 3e-4, 2e-5) << "the residuals tell the noise, of some 3,000 numbers to 1.3 %";
  }
  EXPECT_GE(within, seeds * 95 / 100);
  // The mean of 3 * seeds squares of unit deviates, correlated three by three: its deviation is at most
  // sqrt(2 / seeds).
  EXPECT_NEAR(squares / (3.0 * seeds), 1.0, 4.0 * std::sqrt(2.0 / seeds))
      << "errors are neither boasted nor modest";
}

TEST(Fits, TellWhichModelTheDataPrefer) {
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Design truth{.release_angle = degrees(195), .release_spin = 0.1, .mu_static = 0.5};
    Design made = truth;
    if (friction == Friction::sticking) made.mu_static = Design{}.mu_static;
    const FitReport report = fit(filmed(made, scene_of(friction), 3e-4, 1), {}, {.coarse = 128, .starts = 2});
    ASSERT_EQ(report.models.size(), 2u);
    EXPECT_EQ(report.models[0].scene.friction, friction);
    EXPECT_GT(report.models[1].information - report.models[0].information, 100.0)
        << "thousands of numbers leave no doubt";
  }
}

TEST(Fits, SayWhatTheDataDoNotTell) {
  // One event for one parameter that it does not depend on: the height of a hoop without a motor, by radius.
  const Design truth{};
  const Outcome outcome = solve(truth);
  Measurements measured{.origin = "events"};
  measured.events = {{"jump_height", outcome.jump_height, 0.01}, {"flight_time", outcome.flight_time, 0.001}};
  const Spec spec =
      parse_spec("[design]\nrelease_angle = { from = 3.0, to = 3.3 }\nrelease_spin = { from = 0, to = 0.2 }");
  const FitReport report = fit(measured, spec, {.models = {Friction::sticking}});
  const ModelFit& found = report.models[0];
  EXPECT_LT(found.chi_square, 1e-6);
  // Height and flight time both know only the energy: two parameters, one number.
  EXPECT_TRUE(
      std::ranges::any_of(found.parameters, [](const FittedParameter& one) { return !one.identified; }));
  for (const FittedParameter& parameter : found.parameters)
    if (!parameter.identified) {
      EXPECT_TRUE(std::isnan(parameter.error));
      EXPECT_LT(parameter.low, parameter.high) << "a profile in place of an error";
    }
}

TEST(Fits, OfEventsHaveTheErrorsThatTheirGradientTells) {
  const Design truth{};
  const Outcome outcome = solve(truth);
  Measurements measured{.origin = "events"};
  measured.events = {{"jump_time", outcome.jump_time, 0.001}};
  const Spec spec = parse_spec("[design]\nslope = { from = 0.39, to = 0.41 }");
  const FitReport report = fit(measured, spec, {.models = {Friction::sticking}});
  ASSERT_EQ(report.models[0].parameters.size(), 1u);
  const FittedParameter& slope = report.models[0].parameters[0];
  EXPECT_NEAR(slope.value, truth.slope, 1e-9);
  EXPECT_NEAR(slope.error, 0.001 / std::abs(gradient(truth, &Outcome::jump_time).slope), 1e-9);
}

struct BadData {
  const char* name;
  std::string text;
  std::vector<const char*> told;
};
void PrintTo(const BadData& data, std::ostream* out) { *out << data.name; }
class BadMeasurements : public ::testing::TestWithParam<BadData> {};

std::string refusal_of(const std::string& text) {
  const testing::TemporaryFolder folder;
  folder.write("data.csv", text);
  try {
    check_measurements(read_measurements({folder / "data.csv"}, {}), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return testing::accepted;
}

TEST_P(BadMeasurements, AreRefusedWithOneLineThatSaysWhere) {
  const std::string line = refusal_of(GetParam().text);
  testing::expect_one_line(line, GetParam().told);
  EXPECT_NE(line.find("allowed"), std::string::npos) << line;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadMeasurements,
    ::testing::Values(
        BadData{"no_lines", "t,phi\n", {"data.csv", "no line of numbers"}},
        BadData{"unknown_columns", "time,height\n0,1\n", {"data.csv", "time, height", "t, phi"}},
        BadData{"a_coordinate_missing", "t,x_P\n0,1\n1,1\n2,1\n", {"data.csv", "t, x_P", "x and y"}},
        BadData{"a_cell_too_many", "t,phi\n0,1\n0.1,1,1\n", {"data.csv:3", "3 cells"}},
        BadData{"text_among_numbers", "t,phi\n0,3.1\n0.001,three\n", {"data.csv:3", "column 2", "'three'"}},
        BadData{"no_number_at_all", "t,phi\n0,NaN\n0.001,NaN\n0.002,\n", {"data.csv", "0 rows"}},
        BadData{"unsorted_times", "t,phi\n0,3.1\n0.002,3.1\n0.001,3.1\n", {"data.csv:4", "ascend"}},
        BadData{"the_same_time_twice", "t,phi\n0,3.1\n0.001,3.1\n0.001,3.1\n", {"data.csv:4", "ascend"}},
        BadData{"a_unit_of_another_kind", "t [mm],phi\n0,3.1\n1,3.1\n", {"data.csv", "'t'", "mm"}},
        BadData{"an_unknown_unit", "t,phi [degs]\n0,3.1\n1,3.1\n", {"data.csv", "'phi'", "degs"}},
        BadData{"a_point_twice", "t,x,y,x\n0,1,1,1\n", {"data.csv", "'x'", "twice"}},
        BadData{"frames_without_a_rate", "frame,x,y\n0,1,1\n1,1,1\n", {"data.csv", "frame numbers", "--fps"}},
        BadData{"no_times", "x,y\n0,1\n1,1\n", {"data.csv", "a row for each frame", "--fps"}},
        BadData{"whole_numbers_as_times",
                "t,x,y\n0,1,1\n1,1,1\n2,1,1\n3,1,1\n",
                {"data.csv", "'t' counts frames or milliseconds", "t [ms]", "--fps"}},
        BadData{"two_tracks_without_a_time_in_common",
                "t,x,y,t,x,y\n0,0,1,0.5,0,0\n0.1,0,1,0.6,0,0\n0.2,0,1,0.7,0,0\n",
                {"data.csv", "twice"}},
        BadData{"a_gap",
                "t,phi\n0,3.1\n0.001,3.1\n0.002,3.1\n0.003,3.1\n0.020,3.1\n",
                {"data.csv", "t = 0.003 to 0.02", "gap", "--allow-gaps"}},
        BadData{"milliseconds", "t,phi\n0,3.1\n500,3.2\n1000,3.3\n", {"t = 1000", "another unit", "seconds"}},
        BadData{"degrees", "t,phi\n0,180\n0.001,181\n0.002,182\n", {"phi changes", "degrees", "phi [deg]"}},
        BadData{"an_angle_cut_at_a_turn", "t,phi\n0,6.2\n0.001,6.25\n0.002,0.02\n", {"t = 0.002", "turn"}},
        BadData{"no_unit_that_fits",
                "t,x_P,y_P,x_O,y_O\n0,0,0.5,0,0\n0.001,0,0.5,0,0\n0.002,0,0.5,0,0\n",
                {"another unit", "--scale 0.08"}},
        BadData{"two_lines", "t,phi\n0,3.1\n0.001,3.1\n", {"three or more"}},
        BadData{
            "an_unknown_event", "event,value,error\njump,1,0.1\n", {"data.csv:2", "'jump'", "jump_height"}},
        BadData{"no_error", "event,value,error\njump_height,1,0\n", {"data.csv:2", "error", "above 0"}},
        BadData{
            "an_event_in_milliseconds", "event,value,error\njump_time,330,1\n", {"data.csv:2", "seconds"}},
        BadData{"a_height_in_millimetres",
                "event,value,error\njump_height,82,1\n",
                {"data.csv:2", "hoop diameters"}}));

TEST(Measurements, TakeAFilmAsItIs) {
  EXPECT_EQ(refusal_of("t,phi\n0,3.1\n0.001,3.1\n0.002,3.2\n"), "(accepted)");
  EXPECT_EQ(refusal_of("t,x_P,y_P,x_O,y_O\n0,0,.041,0,0\n0.001,0,.041,0,0\n0.002,0,.041,0,0\n"),
            "(accepted)");
  EXPECT_EQ(refusal_of("event,value,error\njump_height,1,0.1\n"), "(accepted)");
}

TEST(Fits, RefuseMoreFreeParametersThanNumbers) {
  Measurements measured{.origin = "events"};
  measured.events = {{"jump_height", 1.0, 0.01}};
  EXPECT_THROW(fit(measured, {}, {}), InputError);
}

}  // namespace
}  // namespace leapmap
