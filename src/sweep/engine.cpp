// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/engine.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "sweep/designs.hpp"
#include "sweep/ordered_delivery.hpp"
#include "sweep/parallel.hpp"
#include "sweep/solver.hpp"

namespace leapmap {

namespace {

/// Designs solved at once: what the solvers take as one block, and no more than stays in the second cache.
constexpr std::size_t piece = 1024;

struct Item {
  Prepared prepared;
  std::size_t designs;
};

}  // namespace

std::function<TileWork()> in_order(TileSink sink) {
  return [sink = std::move(sink)] {
    const auto kept = std::make_shared<std::vector<Outcome>>();
    return TileWork{
        [kept](const Tile&, std::size_t, std::span<const Outcome> outcomes, const Gradients&) {
          kept->insert(kept->end(), outcomes.begin(), outcomes.end());
        },
        [sink, kept](std::size_t, const Tile& tile) {
          const std::size_t bytes = kept->size() * sizeof(Outcome);
          return Prepared{[sink, tile, outcomes = std::exchange(*kept, {})] { sink(tile, outcomes); }, bytes};
        }};
  };
}

std::size_t run_sweep(const Spec& spec, const Tiling& tiling, const EngineOptions& options,
                      const std::function<TileWork()>& make_work) {
  const DesignSpace space(spec);
  std::size_t delivered = 0;
  OrderedDelivery<Item> delivery(
      options.first_tile,
      [&](Item& item) {
        item.prepared.take();
        delivered += item.designs;
      },
      most_waiting_bytes);

  const std::size_t most = std::min(piece, tiling.tile(0).count);  // no tile is larger than the first
  const std::size_t tiles = tiling.size() - std::min(options.first_tile, tiling.size());
  parallel_for_each(tiles, thread_count(options.threads), [&] {
    // A thread's own: the method's workspace, the encoder's, and the piece of a tile in hand.
    return
        [&, solve = make_gradient_solver(spec), gradients = Gradients(gradients_of(spec)), work = make_work(),
         designs = std::vector<Design>(most), outcomes = std::vector<Outcome>(most)](std::size_t i) mutable {
          try {
            const std::size_t number = options.first_tile + i;
            const Tile tile = tiling.tile(number);
            for (std::size_t first = 0; first < tile.count; first += piece) {
              const std::size_t count = std::min(piece, tile.count - first);
              const std::span some(designs.data(), count);
              const std::span solved(outcomes.data(), count);
              space.fill(tile, first, some);
              solve(some, solved, gradients);
              work.take(tile, first, solved, gradients);
            }
            Prepared prepared = work.prepare(number, tile);
            if (!prepared.take) {
              delivery.close(number);
              return false;
            }
            const std::size_t bytes = prepared.bytes;
            const bool wanted = delivery.bring(number, {std::move(prepared), tile.count}, bytes);
            return wanted && !(options.stop_requested && options.stop_requested());
          } catch (...) {
            delivery.abandon();
            throw;
          }
        };
  });
  delivery.finish();
  return delivered;
}

double seconds_per_design(const Spec& spec, double seconds) {
  using Clock = std::chrono::steady_clock;
  const DesignSpace space(spec);
  const std::size_t count = Tiling(shape_of(spec)).designs();
  const GradientSolver solve = make_gradient_solver(spec);
  Gradients gradients(gradients_of(spec));
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
    solve(designs, outcomes, gradients);
    passed += Clock::now() - begin;
    solved += designs.size();
    if (passed.count() < 0.1 * seconds) designs.resize(std::min<std::size_t>(2 * designs.size(), 8192));
  }
  return passed.count() / static_cast<double>(solved);
}

}  // namespace leapmap
