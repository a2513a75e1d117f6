// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/engine.hpp"

#include <chrono>
#include <random>
#include <vector>

#include "sweep/designs.hpp"
#include "sweep/ordered_delivery.hpp"
#include "sweep/parallel.hpp"
#include "sweep/solver.hpp"

namespace leapmap {

std::size_t run_sweep(const Spec& spec, const Tiling& tiling, const EngineOptions& options,
                      const TileSink& sink) {
  const int threads = thread_count(options.threads);
  const DesignSpace space(spec);

  std::size_t delivered = 0;
  OrderedDelivery<std::vector<Outcome>> delivery(
      [&](std::size_t number, const std::vector<Outcome>& outcomes) {
        sink(tiling.tile(number), outcomes);
        delivered += outcomes.size();
        if (options.progress) options.progress(delivered);
      },
      4 * static_cast<std::size_t>(threads));

  parallel_for_each(tiling.size(), threads, [&] {
    // A thread's own: the method's workspace and the designs of the tile in hand.
    return [&, solve = make_solver(spec), designs = std::vector<Design>()](std::size_t number) mutable {
      try {
        const Tile tile = tiling.tile(number);
        designs.resize(tile.count);
        std::vector<Outcome> outcomes(tile.count);
        space.fill(tile, designs);
        solve(designs, outcomes);
        const bool wanted = delivery.bring(number, std::move(outcomes));
        return wanted && !(options.stop_requested && options.stop_requested());
      } catch (...) {
        delivery.abandon();
        throw;
      }
    };
  });
  return delivered;
}

double seconds_per_design(const Spec& spec, double seconds) {
  using Clock = std::chrono::steady_clock;
  const DesignSpace space(spec);
  const std::size_t count = Tiling(shape_of(spec)).designs();
  const Solver solve = make_solver(spec);
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> pick(0, count - 1);
  // Few at a time while it is not known how long one takes: an integration may need seconds.
  std::vector<Design> designs(8);
  std::vector<Outcome> outcomes;
  std::chrono::duration<double> passed{0};
  std::size_t solved = 0;
  while (passed.count() < seconds) {
    for (Design& design : designs) design = space.at(pick(random));
    outcomes.resize(designs.size());
    const auto begin = Clock::now();
    solve(designs, outcomes);
    passed += Clock::now() - begin;
    solved += designs.size();
    if (passed.count() < 0.1 * seconds) designs.resize(std::min<std::size_t>(2 * designs.size(), 8192));
  }
  return passed.count() / static_cast<double>(solved);
}

}  // namespace leapmap
