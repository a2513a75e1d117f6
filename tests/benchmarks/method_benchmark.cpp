// SPDX-License-Identifier: GPL-3.0-or-later
/// The methods on the same designs in one run, speed and error side by side.
///
/// Designs: slope 0.1 to 0.8, mass ratio 0.5 to 10, offset 0.3 to 1, uniform, seeded; runway 4.
/// items_per_second are designs a second; the errors are against long double at 1e-18; wrong counts designs
/// whose status, flag or number of candidates differs from it. Engine is run_sweep on one thread: designs
/// from axes, everything but the file.
#include "benchmarks/tell_errors.hpp"
#include "engine/engine.hpp"
#include "integrate/rolling_integration.hpp"
#include "noslip/exact.hpp"
#include "spec/designs.hpp"
#include "study/precision.hpp"

namespace leapmap {
namespace {

constexpr std::size_t count = 20'000;

Scene scene() {
  Scene scene;
  scene.runway = 4.0;
  return scene;
}

const std::vector<Design>& designs() {
  static const std::vector<Design> designs = random_designs(count, 1);
  return designs;
}

const std::vector<Outcome>& reference() {
  static const std::vector<Outcome> outcomes = [] {
    std::vector<Outcome> truths(count);
    ExactSolver<long double>(1e-18).solve(designs(), scene(), truths);
    return truths;
  }();
  return outcomes;
}

template <class T>
void Exact(benchmark::State& state) {
  ExactSolver<T> solver(tolerance(state));
  std::vector<Outcome> outcomes(count);
  for (auto _ : state) solver.solve(designs(), scene(), outcomes);
  tell_errors(state, outcomes, reference());
}

/// As a grid has them, the last parameter fastest: neighbours resemble each other.
std::vector<Design> grid() {
  constexpr int side = 32;
  std::vector<Design> designs;
  const auto value = [](double from, double to, int i) { return from + (to - from) * i / (side - 1); };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k)
        designs.push_back({.slope = value(0.1, 0.8, i),
                           .mass_ratio = value(0.5, 10.0, j),
                           .offset_ratio = value(0.3, 1.0, k)});
  return designs;
}

/// jump_height, jump_time and spurious_first_jump, or all fields; random designs, or a grid.
void ExactFields(benchmark::State& state, bool of_grid, const Wanted& wanted) {
  const std::vector<Design> solved = of_grid ? grid() : designs();
  ExactSolver<Batch> solver(tolerance(state), wanted);
  std::vector<Outcome> outcomes(solved.size());
  for (auto _ : state) solver.solve(solved, scene(), outcomes);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(solved.size()));
}

void ExactHeightsAndFlagsOnly(benchmark::State& state) {
  ExactSolver<Batch> solver(
      tolerance(state), {.first_jump_time = false, .jump_time = false, .descent = false, .landing = false});
  std::vector<Outcome> outcomes(count);
  for (auto _ : state) solver.solve(designs(), scene(), outcomes);
  tell_errors(state, outcomes, reference());
}

void GslRk8pd(benchmark::State& state) {
  constexpr std::size_t fewer = count / 10;
  RollingIntegration rolling(adaptive("gsl-rk8pd", tolerance(state)));
  std::vector<Outcome> outcomes(fewer);
  for (auto _ : state)
    for (std::size_t i = 0; i < fewer; ++i) outcomes[i] = rolling.solve(designs()[i], scene());
  tell_errors(state, outcomes, reference());
}

void Engine(benchmark::State& state) {
  const Spec spec = read_spec(
      "", {"runway=4", "slope={from=0.1,to=0.8,count=64}", "mass_ratio={from=0.5,to=10,count=64}",
           "offset_ratio={from=0.3,to=1,count=64}", "tolerance=1e-" + std::to_string(state.range(0))});
  const Tiling tiling(shape_of(spec));
  EngineOptions options;
  options.threads = static_cast<int>(state.range(1));
  for (auto _ : state) {
    std::size_t jumps = 0;
    run_sweep(spec, request_of(spec), tiling, options,
              in_order([&](const Tile&, std::span<const Outcome> outcomes) {
                for (const Outcome& outcome : outcomes) jumps += outcome.status == Status::jumped;
              }));
    benchmark::DoNotOptimize(jumps);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(tiling.designs()));
}

BENCHMARK(Exact<Batch>)->Arg(12)->Arg(10)->Arg(6)->Unit(benchmark::kMillisecond);
constexpr Wanted three_fields{
    .first_jump_time = false, .jump_time = true, .descent = false, .landing = false};
BENCHMARK_CAPTURE(ExactFields, grid_three, true, three_fields)->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ExactFields, grid_all, true, Wanted{.landing = false})
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ExactFields, random_three, false, three_fields)->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ExactFields, random_all, false, Wanted{.landing = false})
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ExactHeightsAndFlagsOnly)->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK(Exact<double>)->Arg(12)->Arg(6)->Unit(benchmark::kMillisecond);
BENCHMARK(Exact<long double>)->Arg(18)->Unit(benchmark::kMillisecond);
BENCHMARK(GslRk8pd)->Arg(12)->Arg(10)->Arg(6)->Unit(benchmark::kMillisecond);
BENCHMARK(Engine)->Args({12, 1})->Args({12, 2})->Args({6, 1})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace leapmap

BENCHMARK_MAIN();
