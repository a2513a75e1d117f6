// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/engine.hpp"

#include <chrono>
#include <memory>
#include <random>
#include <vector>

#include "sweep/designs.hpp"
#include "sweep/ordered_delivery.hpp"
#include "sweep/parallel.hpp"
#include "trajectory/rolling_integration.hpp"

namespace leapmap {

std::size_t run_sweep(const Spec& spec, const Tiling& tiling, const EngineOptions& options,
                      const TileSink& sink) {
  const int threads = thread_count(options.threads);
  const DesignSpace space(spec);
  const IntegrationOptions integration = integration_options(spec.numerics);

  std::size_t delivered = 0;
  OrderedDelivery<std::vector<Outcome>> delivery(
      [&](std::size_t number, const std::vector<Outcome>& outcomes) {
        sink(tiling.tile(number), outcomes);
        delivered += outcomes.size();
        if (options.progress) options.progress(delivered);
      },
      4 * static_cast<std::size_t>(threads));

  parallel_for_each(tiling.size(), threads, [&] {
    // A thread's own: GSL's workspaces and the designs of the tile in hand.
    return [&, rolling = std::make_unique<RollingIntegration>(integration),
            designs = std::vector<Design>()](std::size_t number) mutable {
      try {
        const Tile tile = tiling.tile(number);
        designs.resize(tile.count);
        std::vector<Outcome> outcomes(tile.count);
        space.fill(tile, designs);
        for (std::size_t i = 0; i < tile.count; ++i) outcomes[i] = rolling->solve(designs[i], spec.scene);
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
  const std::size_t designs = Tiling(shape_of(spec)).designs();
  RollingIntegration rolling(integration_options(spec.numerics));
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> pick(0, designs - 1);
  const auto begin = Clock::now();
  std::chrono::duration<double> passed{0};
  long solved = 0;
  while (passed.count() < seconds) {
    for (int i = 0; i < 8; ++i) rolling.solve(space.at(pick(random)), spec.scene);
    solved += 8;
    passed = Clock::now() - begin;
  }
  return passed.count() / static_cast<double>(solved);
}

}  // namespace leapmap
