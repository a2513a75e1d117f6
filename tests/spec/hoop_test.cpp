// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers of [hoop] as axes, tolerances, free parameters and columns of a list.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "leapmap/leapmap.hpp"
#include "model/variable.hpp"
#include "spec/designs.hpp"
#include "spec/spec_hoop.hpp"
#include "tolerance/made_hoops.hpp"
#include "tolerance/scatter_solver.hpp"

namespace leapmap {
namespace {

constexpr const char* drawing = R"(
[hoop]
diameter = "120 mm"
mass = "61 g"
inertia = "1.9e-4 kg m2"
[[hoop.weight]]
name = "slug"
mass = { from = "40 g", to = "160 g", count = 4 }
at = "47 mm"
[[hoop.weight]]
name = "battery"
mass = "12 g"
at = "30 mm"
angle = "170 deg"
[design]
slope = { from = "10 deg", to = "40 deg", count = 3 }
)";

Spec read(const std::string& more = "", const std::vector<std::string>& overrides = {}) {
  return parse_spec(drawing + more, "drawing", overrides);
}

/// What a body of its own comes to.
Design reduced(const Body& body, Design design = {}) {
  Scene scene;
  apply_body(reduce_body(body), body, design, scene);
  return design;
}

bool same(const Design& a, const Design& b) {
  return a.mass_ratio == b.mass_ratio && a.offset_ratio == b.offset_ratio &&
         a.inertia_factor == b.inertia_factor && a.slope == b.slope && a.release_angle == b.release_angle;
}

TEST(HoopNumbers, AlongAnAxisComeToTheBodiesThatOneDraws) {
  const Spec spec = read();
  ASSERT_EQ(spec.axes.size(), 2u);
  EXPECT_EQ(spec.axes[0].key, "hoop.slug.mass") << "in the order of the file";
  EXPECT_EQ(spec.scene.mass, 0.0) << "it differs from design to design";
  EXPECT_EQ(spec.scene.radius, 0.06);
  const DesignSpace space(spec);
  const Tiling tiling = tiling_of(spec);
  std::vector<Design> all(tiling.tile(0).count);
  std::vector<Body> bodies(all.size());
  space.fill(tiling.tile(0), 0, all, bodies);
  for (std::size_t i = 0; i < 12; ++i) {
    Body body = *spec.hoop;
    body.weights[0].mass = spec.axes[0].values[i / 3];
    const Design expected = reduced(body, {.slope = spec.axes[1].values[i % 3]});
    EXPECT_TRUE(same(space.at(i), expected)) << i;
    EXPECT_TRUE(same(all[i], expected)) << i;
    EXPECT_EQ(bodies[i].weights[0].mass, body.weights[0].mass) << i;
  }
}

TEST(HoopNumbers, AreReadBackFromTheResolvedSpecWithTheirOrder) {
  const Spec spec = read(
      "[output]\norder = [\"slope\", \"hoop.slug.mass\"]\n[tolerances]\n"
      "hoop.slug.mass = { normal = \"1 g\" }\nhoop.battery.angle = { uniform = \"5 %\" }\n");
  ASSERT_EQ(spec.axes[0].key, "slope");
  check_spec(spec);
  const Spec again = parse_spec(resolved_text(spec));
  EXPECT_EQ(resolved_text(again), resolved_text(spec));
  ASSERT_EQ(again.axes.size(), 2u);
  EXPECT_EQ(again.axes[0].key, "slope");
  EXPECT_EQ(again.axes[1].values, spec.axes[1].values);
  ASSERT_EQ(again.scatter.spreads.size(), 2u);
  EXPECT_EQ(again.scatter.spreads[0].width, 1e-3);
  EXPECT_TRUE(again.scatter.spreads[1].percent);
  EXPECT_EQ(again.hoop->weights[1].angle, spec.hoop->weights[1].angle);
  EXPECT_TRUE(same(DesignSpace(again).at(7), DesignSpace(spec).at(7)));
}

TEST(HoopNumbers, OfMadeHoopsTurnTheCentreOfMassWhileTheReleaseStays) {
  const Spec spec = read("", {"hoop.slug.mass=85g", "slope=0.5", "drive_torque=0.1",
                              "scatter.hoop.battery.angle={uniform=\"90 deg\"}",
                              "scatter.hoop.battery.mass={uniform=\"6 g\"}", "samples=64"});
  check_spec(spec);
  MadeHoops made(spec.scatter, spec.hoop, {}, points_of(spec.scatter));
  made.draw(spec.design);
  std::vector<Design> hoops(made.samples());
  made.fill(0, hoops);
  const ReducedBody nominal = reduce_body(*spec.hoop);
  double turned = 0.0;
  for (const Design& hoop : hoops) {
    // From the ratios alone: the weights' common mass and place tell the battery's, and with it the turn.
    const double weights = hoop.mass_ratio * spec.hoop->mass, battery = weights - 0.085;
    const double at = hoop.offset_ratio * 0.06;
    const double slug = 0.085 * 0.047, other = battery * 0.03, whole = weights * at;
    const double cosine = (whole * whole + slug * slug - other * other) / (2.0 * whole * slug);
    const double from_slug = std::acos(std::min(cosine, 1.0));
    const double turn = hoop.release_angle - spec.design.release_angle;
    EXPECT_NEAR(std::abs(turn + nominal.direction), from_slug, 2e-7);  // acos next to 1 halves the digits
    EXPECT_NEAR(hoop.drive_torque * (spec.hoop->mass + weights), 0.1 * nominal.total_mass, 1e-15)
        << "the motor is the same";
    turned = std::max(turned, std::abs(turn));
  }
  EXPECT_GT(turned, 0.05);
}

TEST(HoopNumbers, HaveTheDerivativesOfDifferences) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(0.1, 0.9);
  for (int i = 0; i < 100; ++i) {
    Body body{.diameter = 0.12, .mass = 0.1 * u(random), .inertia = 3e-4 * u(random)};
    for (const char* name : {"a", "b", "c"})
      body.weights.push_back({.name = name,
                              .mass = 0.1 * u(random),
                              .at = 0.06 * u(random),
                              .angle = 6.0 * u(random) - 3.0,
                              .inertia = 1e-5 * u(random)});
    const Design by{.mass_ratio = u(random), .offset_ratio = u(random), .inertia_factor = u(random)};
    for (const std::string key :
         {"hoop.mass", "hoop.inertia", "hoop.a.mass", "hoop.b.at", "hoop.c.angle", "hoop.b.inertia"}) {
      const Variable variable = *find_variable(key, &body);
      const auto moved = [&](double step) {
        Body other = body;
        Design unused;
        variable.in(unused, other) += step;
        const Design design = reduced(other);
        return by.mass_ratio * design.mass_ratio + by.offset_ratio * design.offset_ratio +
               by.inertia_factor * design.inertia_factor;
      };
      const double value = variable.of({}, body), step = 1e-5 * std::abs(value);
      const double difference = (moved(step) - moved(-step)) / (2.0 * step);
      // Roundings of 1e-16 over a step of 1e-5, and its square by a third derivative, of some hundreds where
      // the weights are all but balanced.
      const double tolerance = 1e-7 * std::abs(difference) + 1e-10 / std::abs(value);
      EXPECT_NEAR(variable.derivative(by, body), difference, tolerance) << key << ' ' << i;
    }
  }
}

TEST(HoopNumbers, ThatScatterAreJudgedByTheirOwnMillimetresAndNewtons) {
  const Spec spec =
      parse_spec(drawing, "drawing",
                 {"hoop.slug.mass=85 g", "slope=34 deg", "tolerances.hoop.diameter={normal=\"3 %\"}",
                  "tolerances.hoop.slug.mass={normal=\"2 g\"}", "tolerances.samples=512",
                  "goal.jump_height={at_least=\"52 mm\"}", "goal.max_normal_force={at_most=\"8.8 N\"}"});
  EXPECT_EQ(resolved_text(parse_spec(resolved_text(spec))), resolved_text(spec));
  const ScatterReport report = scatter(spec);
  std::size_t both = 0, high = 0, soft = 0, by_nominal = 0;
  for (std::size_t i = 0; i < report.made.size(); ++i) {
    const Design& made = report.made[i];
    // Size and mass are those of a body with the ratios that the solver was given.
    Body body = *spec.hoop;
    const double mass = 0.158 * made.mass;
    body.diameter = 0.12 * made.size, body.weights[0].mass += mass - 0.158;
    const ReducedBody reduced = reduce_body(body);
    ASSERT_NEAR(reduced.total_mass, mass, 1e-15);
    ASSERT_NEAR(reduced.mass_ratio, made.mass_ratio, 1e-12 * made.mass_ratio);
    ASSERT_NEAR(reduced.offset_ratio, made.offset_ratio, 1e-12);
    ASSERT_NEAR(reduced.inertia_factor, made.inertia_factor, 1e-12 * made.inertia_factor);
    const Outcome& outcome = report.outcomes[i];
    const bool is_high = body.diameter * outcome.jump_height >= 0.052,
               is_soft = mass * spec.scene.gravity * outcome.max_normal_force <= 8.8;
    high += is_high, soft += is_soft, both += is_high && is_soft;
    by_nominal += 0.12 * outcome.jump_height >= 0.052 && 0.158 * 9.81 * outcome.max_normal_force <= 8.8;
  }
  const auto all = static_cast<double>(report.made.size());
  EXPECT_EQ(report.yield.value, static_cast<double>(both) / all);
  EXPECT_EQ(report.missed[0].value, 1.0 - static_cast<double>(high) / all);
  EXPECT_EQ(report.missed[1].value, 1.0 - static_cast<double>(soft) / all);
  EXPECT_NE(both, by_nominal) << "or the test could not tell the two apart";
  EXPECT_TRUE(both > 51 && both < 461) << both << " of 512: some reach the goals, some do not";
}

TEST(HoopNumbers, ThatCannotVaryAreRefused) {
  const auto refusal = [](const std::string& more, const std::vector<std::string>& overrides = {}) {
    try {
      check_spec(read(more, overrides));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto says = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  says(refusal("", {"hoop.diameter={values=[0.12,0.09]}"}), "hoop.slug.at = 0.047 is beyond the rim");
  says(refusal("", {"hoop.slug.at={from=\"40 mm\",to=\"61 mm\",count=3}"}), "hoop.slug.at = 0.061");
  says(refusal("", {"hoop.diameter={from=0.1,to=0.2,count=3}", "hop_height=10 mm"}), "each hoop has its own");
  says(refusal("", {"scatter.hoop.slg.mass={normal=\"1 g\"}"}), "did you mean slug?");
  says(refusal("", {"scatter.hoop.slug.mass={normal=\"1 mm\"}"}), "scatter.hoop.slug.mass");
  says(refusal("[tolerances]\nhoop.slug.mass = { normal = \"1 g\" }\nmass_ratio = { normal = \"1 %\" }\n"),
       "follows from numbers of [hoop]");
  says(refusal("[output]\norder = [\"slope\"]\n"), "does not name the axes");
  says(refusal("", {"hoop.mass={from=\"1e-9 kg\",to=1,count=3}", "hoop.battery.mass=1e5"}), "trillionth");
  Spec spec = read();
  spec.design.mass_ratio = 5.0;
  EXPECT_THROW(check_spec(spec), InputError) << "the body says another";
}

}  // namespace
}  // namespace leapmap
