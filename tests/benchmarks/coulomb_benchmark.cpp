// SPDX-License-Identifier: GPL-3.0-or-later
/// Coulomb friction by quadratures and by integration, on the same designs in one run, one thread.
///
/// Designs: those of method_benchmark, with mu 0.1 to 1. items_per_second are designs a second; the errors
/// are against long double at 1e-15; wrong counts designs whose flags or phases differ from it. Phases tells
/// where the time goes, in percent, and how many phases a design goes through; looking on costs it some of
/// its speed.
#include <chrono>
#include <cmath>

#include "benchmarks/tell_errors.hpp"
#include "friction/coulomb_integration.hpp"
#include "friction/coulomb_lanes.hpp"
#include "study/precision.hpp"

namespace leapmap {
namespace {

constexpr std::size_t count = 3'000;
const Scene scene{.friction = Friction::coulomb};

const std::vector<Design>& designs() {
  static const std::vector<Design> designs = [] {
    std::vector<Design> random = random_designs(count, 1);
    for (std::size_t i = 0; i < count; ++i)
      random[i].mu_static = 0.1 + 0.9 * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
    return random;
  }();
  return designs;
}

const std::vector<Outcome>& truths() {
  static const std::vector<Outcome> truths = [] {
    std::vector<Outcome> outcomes;
    CoulombSolver<long double> wide(1e-15);
    for (const Design& design : designs()) outcomes.push_back(wide.solve(design, scene));
    return outcomes;
  }();
  return truths;
}

template <class Method>
void solve_all(benchmark::State& state, Method& method) {
  std::vector<Outcome> outcomes(count);
  for (auto _ : state)
    for (std::size_t i = 0; i < count; ++i) outcomes[i] = method.solve(designs()[i], scene);
  tell_errors(state, outcomes, truths());
}

void Quadratures(benchmark::State& state) {
  CoulombSolver<double> exact(tolerance(state));
  solve_all(state, exact);
}

void InLanes(benchmark::State& state) {
  CoulombLanes<Batch> lanes(tolerance(state));
  std::vector<Outcome> outcomes(count);
  for (auto _ : state) lanes.solve(designs(), scene, outcomes);
  tell_errors(state, outcomes, truths());
}

void GslRk8pd(benchmark::State& state) {
  CoulombIntegration integration(adaptive("gsl-rk8pd", tolerance(state)));
  solve_all(state, integration);
}

void Phases(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  CoulombSolver<double> exact(tolerance(state));
  std::array<double, 4> spent{}, met{};
  for (auto _ : state) {
    for (const Design& design : designs()) {
      std::size_t phase = 0;  // before the first one
      auto since = Clock::now();
      const auto note = [&](std::size_t next) {
        const auto now = Clock::now();
        spent[phase] += std::chrono::duration<double>(now - since).count();
        since = now, phase = next;
      };
      CoulombObserver observer;
      observer.phase = [&](Phase next, const ContactState<double>&, int) {
        note(static_cast<std::size_t>(next));
        ++met[static_cast<std::size_t>(next)];
      };
      exact.solve(design, scene, observer);
      note(0);
    }
  }
  const double all = spent[0] + spent[1] + spent[2] + spent[3];
  const double solved = static_cast<double>(state.iterations()) * static_cast<double>(count);
  for (const auto& [name, phase] : {std::pair{"rolling", 1u}, {"sliding", 2u}, {"flight", 3u}}) {
    state.counters[std::string(name) + "_percent"] = 100.0 * spent[phase] / all;
    state.counters[std::string(name) + "_phases"] = met[phase] / solved;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

BENCHMARK(InLanes)->Arg(9)->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK(Quadratures)->Arg(9)->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK(GslRk8pd)->Arg(9)->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK(Phases)->Arg(9)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace leapmap

BENCHMARK_MAIN();
