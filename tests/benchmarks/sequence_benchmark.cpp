// SPDX-License-Identifier: GPL-3.0-or-later
/// What jumps after the first cost: designs followed for twenty jumps, by exact in lanes and by gsl-rk8pd,
/// one after the other in one run; medians. One thread.
///
///     build/release/tests/sequence-benchmark [RUNS]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "benchmarks/timing.hpp"
#include "gaits/error_growth.hpp"
#include "gaits/settle.hpp"
#include "integrate/integration_options.hpp"
#include "model/model.hpp"

namespace {

using namespace leapmap;

/// Of those that jump often.
std::vector<Design> lively(std::size_t count, Friction friction) {
  std::mt19937_64 random(1);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  std::vector<Design> designs(count);
  for (Design& design : designs) {
    design.slope = between(0.1, 0.3), design.mass_ratio = between(1.0, 4.0);
    design.offset_ratio = between(0.4, 0.6);
    if (friction == Friction::coulomb) design.mu_static = between(0.5, 1.0);
  }
  return designs;
}

double jumps_a_second(const Solver& solve, const std::vector<Design>& designs, int runs) {
  std::vector<Outcome> outcomes(designs.size());
  std::vector<double> speeds;
  for (int run = 0; run < runs; ++run) {
    const double spent = seconds([&] { solve(designs, outcomes); });
    std::size_t jumps = 0;
    for (const Outcome& outcome : outcomes) jumps += outcome.jumps();
    speeds.push_back(static_cast<double>(jumps) / spent);
  }
  return median(speeds);
}

void tell(std::string_view what, double speed, std::string_view unit, double of) {
  fmt::print("{:<46} {:>12.0f} {} a second, {:.4g} times gsl-rk8pd\n", what, speed, unit, speed / of);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    Scene scene{.friction = friction, .runway = 50.0};
    scene.jumps = 20;
    const Model& model = model_of(scene);
    fmt::print("{}\n", model.meaning);
    const std::size_t count = friction == Friction::sticking ? 4000 : 200;
    const std::vector<Design> designs = lively(count, friction), few(designs.begin(), designs.begin() + 40);
    const double integrated =
        jumps_a_second(model.integration(scene, adaptive("gsl-rk8pd", 1e-12)), few, std::min(runs, 3));
    const Wanted heights{.first_jump_time = false, .jump_time = false, .descent = false, .landing = false};
    tell("heights, exact", jumps_a_second(model.exact(scene, 1e-12, heights), designs, runs), "jumps",
         integrated);
    tell("heights and times, exact", jumps_a_second(model.exact(scene, 1e-12, {}), designs, runs), "jumps",
         integrated);
    const Solver exact = model.exact(scene, 1e-12, {});
    ErrorGrowth growth(scene, 1e-12);
    tell("the same and how errors grow",
         jumps_a_second(
             [&](std::span<const Design> all, std::span<Outcome> outcomes) {
               exact(all, outcomes);
               growth.tell(all, outcomes);
             },
             few, runs),
         "jumps", integrated);
    scene.jumps = 1, scene.settle = 500;
    GaitSolver gaits(scene, 1e-12);
    std::vector<Outcome> outcomes(few.size());
    const double spent = seconds([&] { gaits.solve(few, outcomes); });
    fmt::print("{:<46} {:>12.0f} designs a second\n", "the gait after 500 jumps",
               static_cast<double>(few.size()) / spent);
  }
}
