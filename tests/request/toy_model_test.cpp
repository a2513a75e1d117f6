// SPDX-License-Identifier: GPL-3.0-or-later
// A model that can be integrated and nothing else: a point mass on a compressed spring, which throws it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "hoop/units.hpp"
#include "integrate/integration_options.hpp"
#include "leapmap/boundaries.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/gait.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/sweep.hpp"
#include "leapmap/trace.hpp"
#include "map/reader.hpp"
#include "model/model.hpp"
#include "numerics/gsl_integrator.hpp"
#include "spec/designs.hpp"
#include "spec/spec.hpp"
#include "support/temporary_folder.hpp"
#include "sweep/check.hpp"

namespace leapmap {
namespace {

constexpr auto spring = static_cast<Friction>(2);

/// y'' = -k y - 1: of a spring that is relaxed at y = 0, with k = mass_ratio and compressed by offset_ratio.
int pull(double, const double y[], double slope[], void* stiffness) {
  slope[0] = y[1];
  slope[1] = -*static_cast<double*>(stiffness) * y[0] - 1.0;
  return GSL_SUCCESS;
}

Motion throw_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                            double) {
  const double second = time_unit(scene);
  double stiffness = design.mass_ratio;
  Motion motion;
  Outcome& outcome = motion.outcome;
  outcome.status = Status::stalled;
  if (stiffness * design.offset_ratio <= 2.0) return motion;  // it stays on the spring
  GslIntegrator<2> integrator(*options.stepper, options.control, {pull, nullptr, 2, &stiffness});
  integrator.start({-design.offset_ratio, 0.0}, 1e-3);
  for (long steps = 0; steps < options.max_steps; ++steps) {
    MotionPoint point{};
    point.t = second * (integrator.step().t0 + integrator.step().h), point.phase = Phase::rolling;
    point.y = scene.radius * integrator.step().y1[0];
    motion.points.push_back(point);
    if (!integrator.advance()) break;
    const auto& step = integrator.step();
    if (step.y1[0] < 0.0) continue;
    double low = 0.0, high = step.h;
    State<2> at = step.y1;
    while (low < (low + high) / 2.0 && (low + high) / 2.0 < high) {
      const double middle = (low + high) / 2.0;
      integrator.retake(middle, at);
      (at[0] < 0.0 ? low : high) = middle;
    }
    outcome.status = Status::jumped;
    outcome.spurious_first_jump = 0, outcome.candidates = 1;
    outcome.jump_time = second * (step.t0 + high);
    outcome.jump_height = at[1] * at[1] / 4.0;  // v^2 / 2 in R
    return motion;
  }
  outcome = failed_outcome("more steps than max_steps");
  return motion;
}

Solver integration(const Scene& scene, const IntegrationOptions& options) {
  return [=](std::span<const Design> designs, std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i)
      outcomes[i] = throw_by_integration(designs[i], scene, options, 0.0).outcome;
  };
}

void add_spring() {
  if (find_model("spring")) return;
  Model model{};
  model.friction = spring, model.name = "spring", model.meaning = "a point mass on a spring";
  model.integration = integration, model.tell_by_integration = throw_by_integration;
  add_model(model);
}

Spec spec_with(std::vector<std::string> more) {
  add_spring();
  std::vector<std::string> all{"friction=spring", "audit=0", "offset_ratio={from=0.2,to=1,count=9}",
                               "mass_ratio={from=1,to=9,count=9}"};
  all.insert(all.end(), more.begin(), more.end());
  return read_spec("", all);
}

TEST(ToyModel, IsSweptIntoAMapByItsIntegrationAlone) {
  const Spec spec = spec_with({"method=gsl-rk8pd"});
  const testing::TemporaryFolder folder;
  const std::string path = folder / "spring.h5";
  const Report report = sweep(spec, path);
  EXPECT_TRUE(report.whole);
  const MapReader map(path, Locking::required);
  const Tiling tiling = map.blocks("jump_height");
  const DesignSpace space(spec);
  std::size_t thrown = 0;
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const Tile tile = tiling.tile(t);
    const std::vector<double> heights = map.read("jump_height", tile);
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const Design design = space.at(tiling.number(tile, i));
      const double k = design.mass_ratio, c = design.offset_ratio;
      if (k * c <= 2.0) {
        EXPECT_TRUE(std::isnan(heights[i]));
        continue;
      }
      EXPECT_NEAR(heights[i], (k * c * c - 2.0 * c) / 4.0, 1e-9);  // by energy; steps to 1e-10
      ++thrown;
    }
  }
  EXPECT_EQ(thrown, 46u);  // of 81
}

TEST(ToyModel, HasMotionsAndDiscontinuities) {
  const Spec spec = spec_with({"method=gsl-rk8pd", "max_steps=1000"});
  Design design;
  design.mass_ratio = 5.0, design.offset_ratio = 0.8;
  const Motion motion = trace(design, spec.scene, {.method = "gsl-rk8pd"});
  EXPECT_EQ(motion.outcome.status, Status::jumped);
  EXPECT_GT(motion.points.size(), 3u);
  const double k = 5.0, c = 0.8, time = std::acos(-1.0 / (k * c - 1.0)) / std::sqrt(k);
  EXPECT_NEAR(motion.outcome.jump_time, time_unit(spec.scene) * time, 1e-10);

  const Boundaries found = find_boundaries(spec);
  ASSERT_FALSE(found.cliffs.empty());
  for (const Cliff& cliff : found.cliffs) {
    const std::vector<double> place = place_of(found, cliff);
    EXPECT_NEAR(place[0] * place[1], 2.0, 0.01);  // a step may pass over a top that is barely above 0
  }
}

TEST(ToyModel, SaysInOneLineWhatItLacks) {
  const auto refused = [](std::vector<std::string> more) -> std::string {
    try {
      check_spec(spec_with(more));
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  const auto says = [](const std::string& text, const char* what) { return text.find(what) != text.npos; };
  EXPECT_PRED2(says, refused({}), "method needs a semi-analytic solver, which the model \"spring\" lacks");
  EXPECT_PRED2(says, refused({"method=gsl-rk8pd", "audit=0.1"}), "audit needs a second method");
  EXPECT_PRED2(says, refused({"method=gsl-rk8pd", "jumps=2"}), "jumps needs jumps that begin at a landing");
  EXPECT_PRED2(says, refused({"method=exact", "gradients=[\"jump_height\"]"}), "semi-analytic");
  const Spec spec = spec_with({"method=gsl-rk8pd"});
  EXPECT_THROW(find_gaits(spec.design, spec.scene), InputError);
  EXPECT_THROW(solve(spec.design, spec.scene), InputError);

  const testing::TemporaryFolder folder;
  const std::string path = folder / "spring.h5";
  sweep(spec, path);
  CheckOptions options;
  options.sample = 3;
  EXPECT_PRED2(says, check_map(path, options).findings.at(0), "no semi-analytic solver");
}

}  // namespace
}  // namespace leapmap
