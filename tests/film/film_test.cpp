// SPDX-License-Identifier: GPL-3.0-or-later
/// Films in the forms of other programs, and what they are understood as.
#include "leapmap/film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "film/film_model.hpp"
#include "film/place_film.hpp"
#include "leapmap/leapmap.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {
namespace {

template <class F>
std::string refusal_of(const F& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return testing::accepted;
}

Recording read_text(const std::string& text, const RecordingOptions& options = {},
                    const std::string& name = "film.csv") {
  const testing::TemporaryFolder folder;
  folder.write(name, text);
  return read_film({folder / name}, options);
}

TEST(Films, OfTrackerHaveTracksSideBySide) {
  const Recording film = read_text(
      "rim\t\t\tcentre\t\t\t\nt\tx\ty\tt\tx\ty\t\n0\t1\t2\t0\t3\t4\t\n1E-1\t\t\t1E-1\t5\t6\t\n0.2\t7\t8\t0."
      "2\t9\t1\t\n"
      "0.3\t7\t8\t0.3\t9\t1\t\n");
  ASSERT_EQ(film.tracks.size(), 2u);
  EXPECT_EQ(film.tracks[0].name, "rim");
  EXPECT_EQ(film.tracks[0].t, (std::vector{0.0, 0.2, 0.3})) << "a blank cell is a frame without a point";
  EXPECT_EQ(film.tracks[1].x, (std::vector{3.0, 5.0, 9.0, 9.0}));
  EXPECT_EQ(film.unit, "");
  ASSERT_EQ(film.notes.size(), 1u);
  EXPECT_NE(film.notes[0].find("'rim' x, y from columns 2, 3, 3 points, 1 frames without one"),
            std::string::npos)
      << film.notes[0];
}

TEST(Films, HaveSemicolonsDecimalCommasMarksOfByteOrderAndLinesThatEndAsElsewhere) {
  const Recording film =
      read_text("\xEF\xBB\xBFTime;Weight/X;Weight/Y\r\n0;1,5;2\r\n4;1,25;3\r\n8;1;4\r\n12;1;5\r\n");
  ASSERT_EQ(film.tracks.size(), 1u);
  EXPECT_EQ(film.tracks[0].name, "Weight");
  EXPECT_EQ(film.tracks[0].x, (std::vector{1.5, 1.25, 1.0, 1.0}));
  EXPECT_EQ(film.tracks[0].t, (std::vector{0.0, 0.004, 0.008, 0.012})) << "whole numbers are milliseconds";
}

TEST(Films, OfDeepLabCutDropUnlikelyPoints) {
  const Recording film = read_text(
      "scorer,net,net,net\nbodyparts,weight,weight,weight\ncoords,x,y,likelihood\n0,1,2,0.9\n1,1,2,0.1\n2,1,"
      "2,0.8\n"
      "3,1,2,0.99\n",
      {.fps = 100.0});
  ASSERT_EQ(film.tracks.size(), 1u);
  EXPECT_EQ(film.tracks[0].t, (std::vector{0.0, 0.02, 0.03}));
}

TEST(Films, OfDLTdvHaveRowsForFrames) {
  const Recording film = read_text(
      "pt1_cam1_X,pt1_cam1_Y,pt2_cam1_X,pt2_cam1_Y\n1,2,3,4\nNaN,NaN,3,4\n1,2,3,4\n1,2,3,4\n", {.fps = 10});
  ASSERT_EQ(film.tracks.size(), 2u);
  EXPECT_EQ(film.tracks[0].name, "pt1_cam1");
  EXPECT_EQ(film.tracks[0].t, (std::vector{0.0, 0.2, 0.3}));
}

TEST(Films, OfEncodersHaveHeadersInComments) {
  const Recording film = read_text(
      "%Time (s)\tTheta (deg)\tOmega (rpm)\r\n\t%ramp 2\r\n0\t0\t0\r\n0.1\t180\t60\r\n0.2\t360\t\r\n");
  ASSERT_EQ(film.phi.size(), 3u);
  EXPECT_DOUBLE_EQ(film.phi[1], std::numbers::pi);
  EXPECT_DOUBLE_EQ(film.spin[1], 2.0 * std::numbers::pi);
  EXPECT_TRUE(std::isnan(film.spin[2]));
}

TEST(Films, OfSeveralFilesAreOneMotion) {
  const testing::TemporaryFolder folder;
  folder.write("a.csv", "mass_W,,,\nt,x,y,\n0,1,2,\n0.1,1,2,\n0.2,1,2,\n");
  folder.write("b.csv", "mass_C,,,\nt,x,y,\n0,1,2,\n0.1,1,2,\n0.2,1,2,\n");
  EXPECT_EQ(read_film({folder / "a.csv", folder / "b.csv"}).tracks[1].name, "mass_C");
  EXPECT_NE(refusal_of([&] {
              read_film({folder / "a.csv", folder / "a.csv"});
            }).find("two tracks"),
            std::string::npos);
}

constexpr const char* project = R"(<?xml version="1.0"?>
<object class="org.opensourcephysics.cabrillo.tracker.TrackerPanel">
 <property name="videoclip" type="object"><object class="x.VideoClip">
  <property name="startframe" type="int">2</property><property name="starttime" type="double">500.0</property>
 </object></property>
 <property name="clipcontrol" type="object"><object class="x.StepperClipControl">
  <property name="delta_t" type="double">10.0</property></object></property>
 <property name="coords" type="object"><object class="x.ImageCoordSystem">
  <property name="framedata" type="array"><property name="[0]" type="object"><object class="x.FrameData">
   <property name="xorigin" type="double">100.0</property>
   <property name="yorigin" type="double">200.0</property>
   <property name="angle" type="double">90.0</property>
   <property name="xscale" type="double">50.0</property><property name="yscale" type="double">50.0</property>
  </object></property></property></object></property>
 <property name="tracks" type="collection"><property name="item" type="object"><object class="x.PointMass">
  <property name="name" type="string">slug</property>
  <property name="framedata" type="array">
   <property name="[2]" type="object"><object class="x.FrameData">
    <property name="x" type="double">150.0</property>
    <property name="y" type="double">100.0</property></object></property>
   <property name="[3]" type="object"><object class="x.FrameData">
    <property name="x" type="double">100.0</property>
    <property name="y" type="double">200.0</property></object></property>
   <property name="[5]" type="object"><object class="x.FrameData">
    <property name="x" type="double">100.0</property>
    <property name="y" type="double">150.0</property></object></property>
  </property></object></property></property>
</object>)";

TEST(Films, OfTrackersProjectsAreInMetresAlongItsAxes) {
  const Recording film = read_text(project, {}, "film.trk");
  ASSERT_EQ(film.tracks.size(), 1u);
  const Track& slug = film.tracks[0];
  EXPECT_EQ(slug.name, "slug");
  EXPECT_EQ(film.unit, "m");
  const std::vector t{0.5, 0.51, 0.53}, x{2.0, 0.0, 1.0}, y{-1.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(slug.t[i], t[i], 1e-15);
    EXPECT_NEAR(slug.x[i], x[i], 1e-14) << "the axis of x points upwards in the picture";
    EXPECT_NEAR(slug.y[i], y[i], 1e-14);
  }
}

TEST(Films, ThatAreNoProjectsAreRefused) {
  for (const auto& [name, text] : {std::pair{"film.trk", "<object class='x'/>"},
                                   {"film.trk", "no xml"},
                                   {"film.trz", "no zip"},
                                   {"film.trk", "<object class='x.TrackerPanel'/>"}}) {
    const std::string line = refusal_of([&, name = name, text = text] { read_text(text, {}, name); });
    testing::expect_one_line(line, {name, "allowed"});
  }
}

/// What a camera with an axis of its own sees of a hoop that is released at t = 0.2 s.
Film film_of(const Design& design, const Scene& scene, const Camera& camera, bool is_level) {
  const Motion motion = trace(design, scene, {.interval = 2e-3});
  Film film{.is_level = is_level, .unit = "px", .camera = camera};
  film.tracks = {{.name = "slug", .at = 0.6 * scene.radius, .angle = 0.4}, {.name = "centre", .at = 0.0}};
  const double a = camera.tilt + (is_level ? design.slope : 0.0);
  for (const MotionPoint& point : motion.points) {
    if (!film.tracks[0].t.empty() && point.t + camera.time_offset <= film.tracks[0].t.back()) continue;
    for (Track& track : film.tracks) {
      const double X = point.x - track.at * std::sin(point.phi + track.angle),
                   Y = point.y + scene.radius - track.at * std::cos(point.phi + track.angle);
      track.t.push_back(point.t + camera.time_offset);
      track.x.push_back(camera.x + (X * std::cos(a) + Y * std::sin(a)) / camera.scale);
      track.y.push_back(camera.y + (Y * std::cos(a) - X * std::sin(a)) / camera.scale);
    }
  }
  return film;
}

class Cameras : public ::testing::TestWithParam<Friction> {};

TEST_P(Cameras, SeeTheMotionAndItsDerivatives) {
  const Scene scene{.friction = GetParam()};
  Design design{
      .slope = 0.35, .mass_ratio = 1.6, .offset_ratio = 0.8, .release_angle = 3.4, .release_spin = 0.1};
  if (GetParam() == Friction::coulomb) design.mu_static = 0.5;
  const Camera camera{.time_offset = 0.2, .scale = 4e-4, .tilt = 0.05, .x = 300.0, .y = -150.0};
  const Film film = film_of(design, scene, camera, true);
  const FilmModel model(film, scene);
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < model.observations().size(); i += 7) numbers.push_back(i);
  std::vector<double Camera::*> by_camera;
  for (const CameraNumber& number : camera_numbers) by_camera.push_back(number.member);
  const std::vector<std::size_t> by_design{0, 1, 2, 4, 5};
  const std::size_t columns = by_design.size() + by_camera.size();
  std::vector<double> residuals(numbers.size()), jacobian(numbers.size() * columns), more(residuals),
      less(residuals);
  ASSERT_TRUE(model.residuals(design, camera, {numbers, by_design, by_camera}, residuals, jacobian));
  // Of positions up to a thousand pixels; a trace and a motion at given times agree within 1e-9 m.
  for (const double residual : residuals) ASSERT_NEAR(residual, 0.0, 1e-5);
  const auto compare = [&](std::size_t column, const Design& d1, const Camera& c1, const Design& d2,
                           const Camera& c2, double step) {
    ASSERT_TRUE(model.residuals(d1, c1, {numbers}, more, {}) && model.residuals(d2, c2, {numbers}, less, {}));
    std::size_t rough = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double difference = (more[i] - less[i]) / (2.0 * step);
      // Differences have seven digits; the time of the release has kinks at ends of phases.
      rough +=
          !(std::abs(jacobian[i * columns + column] - difference) <= 1e-4 * (10.0 + std::abs(difference)));
    }
    EXPECT_LE(rough, numbers.size() / 50) << "column " << column;
  };
  for (std::size_t k = 0; k < by_design.size(); ++k) {
    Design up = design, down = design;
    up.*differentiable[by_design[k]] += 1e-6, down.*differentiable[by_design[k]] -= 1e-6;
    compare(k, up, camera, down, camera, 1e-6);
  }
  for (std::size_t k = 0; k < by_camera.size(); ++k) {
    const double step =
        1e-6 * std::max(1.0, std::abs(camera.*by_camera[k])) * (by_camera[k] == &Camera::scale ? 1e-3 : 1);
    Camera up = camera, down = camera;
    up.*by_camera[k] += step, down.*by_camera[k] -= step;
    compare(by_design.size() + k, design, up, design, down, step);
  }
}

TEST_P(Cameras, AreFoundFromAMotionByLinearLeastSquares) {
  const Scene scene{.friction = GetParam()};
  Design design{.slope = 0.35, .mass_ratio = 1.6, .offset_ratio = 0.8, .release_angle = 3.4};
  if (GetParam() == Friction::coulomb) design.mu_static = 0.5;
  const Camera truth{.time_offset = 0.2, .scale = 4e-4, .tilt = 0.05, .x = 300.0, .y = -150.0};
  for (const bool level : {false, true}) {
    const Film film = film_of(design, scene, truth, level);
    const FilmModel model(film, scene);
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < model.observations().size(); i += 5) numbers.push_back(i);
    std::vector<double> residuals(numbers.size());
    const std::array free{&Camera::scale, &Camera::tilt, &Camera::x, &Camera::y};
    Camera camera{.time_offset = truth.time_offset, .scale = 1e-3, .tilt = -0.3};
    ASSERT_TRUE(model.residuals_with_camera(design, camera, free, numbers, residuals));
    EXPECT_NEAR(camera.scale, truth.scale, 1e-11);
    EXPECT_NEAR(camera.tilt, truth.tilt, 1e-8);
    EXPECT_NEAR(camera.x, truth.x, 1e-5);
    EXPECT_NEAR(camera.y, truth.y, 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Cameras, ::testing::Values(Friction::sticking, Friction::coulomb),
                         [](const auto& model) {
                           return model.param == Friction::sticking ? "sticking" : "coulomb";
                         });

/// A hoop without a point mass rolls to rest on level ground: after v / (c / J) it stays where it is.
TEST(FilmFits, OfAHoopThatRollsToRestKnowItsResistance) {
  const double c = 0.1, J = 2.0, spin = 1.5;
  const Scene scene{.runway = 1000.0};
  const double second = std::sqrt(scene.radius / scene.gravity), stop = spin * J / c;
  for (const double end : {0.9, 1.5, 2.0}) {
    Measurements measured{.origin = "film"};
    std::mt19937_64 random(6);
    std::normal_distribution<double> off(0.0, 1e-3);
    for (double t = 0.0; t < end * stop; t += 0.1) {
      const double rolled = std::min(t, stop);
      measured.film.t.push_back(t * second);
      measured.film.phi.push_back(1.0 + spin * rolled - 0.5 * c / J * rolled * rolled + off(random));
    }
    Spec spec;
    spec.scene = scene;
    spec.design.slope = 0.0, spec.design.mass_ratio = 0.0, spec.design.release_angle = 1.0;
    spec.design.release_spin = spin;
    const ModelFit fitted =
        fit(measured, spec, {.models = {Friction::sticking}, .free = {"resisting_torque"}, .coarse = 64})
            .models[0];
    ASSERT_TRUE(fitted.found) << end;
    EXPECT_NEAR(fitted.parameters[0].value, c, 4.0 * fitted.parameters[0].error) << end;
    EXPECT_LT(fitted.parameters[0].error, 1e-3) << end;
    EXPECT_TRUE(explains(fitted)) << end;
  }
}

TEST(FilmFits, WithBadPointsAreRobustWithHubersLoss) {
  const Scene scene{.friction = Friction::coulomb};
  const Design truth{.release_angle = 3.4, .mu_static = 0.5};
  std::mt19937_64 random(5);
  std::normal_distribution<double> off(0.0, 3e-4);
  Measurements measured{.origin = "film"};
  measured.film = film_of(truth, scene, {}, false);
  measured.film.unit = "m";
  std::size_t bad = 0;
  for (Track& track : measured.film.tracks)
    for (std::size_t i = 0; i < track.t.size(); ++i) {
      track.x[i] += off(random), track.y[i] += off(random);
      if (i % 20 == 0) track.x[i] += 0.02, ++bad;  // the first among them
    }
  const FitOptions options{.models = {Friction::coulomb}, .coarse = 256, .starts = 2};
  FitOptions robust = options;
  robust.loss = Loss::huber;
  const auto off_of = [&](const FitOptions& how) {
    const ModelFit fitted = fit(measured, {}, how).models[0];
    double worst = 0.0;
    for (const FittedParameter& one : fitted.parameters) {
      const double wanted = one.name == "release_angle" ? 3.4 : one.name == "mu_static" ? 0.5 : 0.0;
      worst = std::max(worst, std::abs(one.value - wanted) / one.error);
    }
    return std::pair{worst, fitted};
  };
  const auto [off_robust, robust_fit] = off_of(robust);
  const auto [off_plain, plain_fit] = off_of(options);
  EXPECT_LT(off_robust, 3.5);
  EXPECT_EQ(robust_fit.outliers.size(), bad)
      << "0.02 m are 66 deviations, and 4 of them are exceeded by chance rarely";
  EXPECT_TRUE(explains(robust_fit));
  EXPECT_TRUE(plain_fit.outliers.empty());
  EXPECT_LT(robust_fit.parameters[0].error, 0.3 * plain_fit.parameters[0].error);
}

/// A bare hoop rolls on a level plane and nothing resists: the torque is at its bound, and has a profile.
TEST(FilmFits, BadPointsWidenNoProfileWithHubersLoss) {
  const Scene scene{.runway = 1000.0};
  const auto high_of = [&](bool has_bad, Loss loss) {
    std::mt19937_64 random(6);
    std::normal_distribution<double> off(0.0, 1e-3);
    Measurements measured{.origin = "film"};
    const double second = std::sqrt(scene.radius / scene.gravity);
    for (int i = 0; i < 200; ++i) {
      const double t = 0.1 * i;
      measured.film.t.push_back(t * second);
      measured.film.phi.push_back(1.0 + 0.5 * t + off(random) +
                                  (has_bad && i % 20 == 10 ? (i % 40 == 10 ? 0.1 : -0.1) : 0.0));
    }
    Spec spec;
    spec.scene = scene;
    spec.design = {.slope = 0.0, .mass_ratio = 0.0, .release_angle = 1.0, .release_spin = 0.5};
    const FitOptions options{
        .models = {Friction::sticking}, .free = {"resisting_torque"}, .loss = loss, .coarse = 64};
    const ModelFit fitted = fit(measured, spec, options).models[0];
    EXPECT_TRUE(fitted.found);
    EXPECT_TRUE(fitted.parameters[0].at_bound || (has_bad && loss == Loss::squares));
    return fitted.parameters[0].high;
  };
  const double clean = high_of(false, Loss::squares);
  EXPECT_LT(high_of(true, Loss::huber), 2.0 * clean) << "a tenth of the points lost, and others cut";
  EXPECT_GT(high_of(true, Loss::squares), 4.0 * clean);
}

}  // namespace
}  // namespace leapmap
