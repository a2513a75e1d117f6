// SPDX-License-Identifier: GPL-3.0-or-later
/// What derivatives cost: designs solved with those of two quantities by every parameter, over the same
/// designs solved without, one after the other in one run; medians. One thread.
///
///     build/release/tests/gradient-benchmark [RUNS]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "benchmarks/timing.hpp"
#include "friction/model.hpp"
#include "noslip/model.hpp"
#include "support/designs.hpp"

namespace {

using namespace leapmap;

std::vector<Design> grid(std::size_t rows) {
  std::vector<Design> designs;
  for (std::size_t i = 0; i < rows * rows; ++i) {
    Design design;
    design.slope = 0.1 + 0.7 * static_cast<double>(i / rows) / static_cast<double>(rows);
    design.mass_ratio = 0.5 + 9.5 * static_cast<double>(i % rows) / static_cast<double>(rows);
    designs.push_back(design);
  }
  return designs;
}

std::vector<Design> random_designs(std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<Design> designs;
  for (std::size_t i = 0; i < count; ++i) designs.push_back(testing::random_design(random));
  return designs;
}

void compare(const char* name, const std::vector<Design>& designs, const Solver& plain,
             const GradientSolver& differentiating, const GradientWanted& asked, int runs) {
  std::vector<Outcome> outcomes(designs.size());
  Gradients gradients(asked);
  std::vector<double> without, ratio;
  for (int run = 0; run < runs; ++run) {
    without.push_back(seconds([&] { plain(designs, outcomes); }));
    ratio.push_back(seconds([&] { differentiating(designs, outcomes, gradients); }) / without.back());
  }
  fmt::print("{:<24} {:>9.0f} ns a design without, {:.2f} times that with\n", name,
             1e9 * median(without) / static_cast<double>(designs.size()), median(ratio));
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  const Wanted wanted{.first_jump_time = false, .jump_time = true, .descent = false, .landing = false};
  GradientWanted asked{{&Outcome::jump_height, &Outcome::jump_time}, {}};
  for (std::size_t k = 0; k < without_slip; ++k) asked.by.push_back(k);
  const Scene sticking;
  compare("without slip, a grid", grid(200), noslip::exact(sticking, 1e-12, wanted),
          noslip::gradients(sticking, 1e-12, wanted, asked), asked, runs);
  compare("without slip, at random", random_designs(20'000), noslip::exact(sticking, 1e-12, wanted),
          noslip::gradients(sticking, 1e-12, wanted, asked), asked, runs);
  const Scene coulomb{.friction = Friction::coulomb};
  for (std::size_t k = without_slip; k < differentiable.size(); ++k) asked.by.push_back(k);
  compare("with friction, a grid", grid(30), friction::exact(coulomb, 1e-10, wanted),
          friction::gradients(coulomb, 1e-10, wanted, asked), asked, runs);
}
