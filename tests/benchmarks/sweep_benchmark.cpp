// SPDX-License-Identifier: GPL-3.0-or-later
/// What the engine adds to a bare loop over the same stepper and event search, in one run.
///
/// Designs: slope 0.1 to 0.8, mass ratio 0.5 to 10, offset 0.3 to 1, uniform, seeded; runway 4; gsl-rk8pd at
/// 1e-10. Compare items_per_second of the rows: they are designs a second.
#include <benchmark/benchmark.h>

#include <random>

#include "engine/engine.hpp"
#include "integrate/rolling_integration.hpp"
#include "request/solver.hpp"

namespace leapmap {
namespace {

constexpr std::size_t designs = 10'000;

Spec random_list() {
  Spec spec = read_spec("", {"runway=4", "method=gsl-rk8pd", "tolerance=1e-10"});
  std::mt19937_64 random(1);
  spec.list.count = designs;
  for (const auto& [key, low, high] :
       {std::tuple{"slope", 0.1, 0.8}, {"mass_ratio", 0.5, 10.0}, {"offset_ratio", 0.3, 1.0}}) {
    Axis column{key, {}};
    std::uniform_real_distribution<double> uniform(low, high);
    for (std::size_t i = 0; i < designs; ++i) column.values.push_back(uniform(random));
    spec.list.columns.push_back(column);
  }
  return spec;
}

void BareLoop(benchmark::State& state) {
  const Spec spec = random_list();
  RollingIntegration rolling(integration_options(spec.numerics, spec.scene));
  std::vector<Outcome> outcomes(designs);
  for (auto _ : state) {
    for (std::size_t i = 0; i < designs; ++i) {
      Design design = spec.design;
      design.slope = spec.list.columns[0].values[i];
      design.mass_ratio = spec.list.columns[1].values[i];
      design.offset_ratio = spec.list.columns[2].values[i];
      outcomes[i] = rolling.solve(design, spec.scene);
    }
    benchmark::DoNotOptimize(outcomes.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(designs));
}

void Engine(benchmark::State& state) {
  const Spec spec = random_list();
  const Tiling tiling({designs});
  EngineOptions options;
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    double sum = 0.0;
    run_sweep(spec, request_of(spec), tiling, options,
              in_order([&](const Tile&, std::span<const Outcome> outcomes) {
                for (const Outcome& outcome : outcomes)
                  sum += outcome.status == Status::jumped ? outcome.jump_height : 0.0;
              }));
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(designs));
}

BENCHMARK(BareLoop)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(Engine)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace leapmap

BENCHMARK_MAIN();
