// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/engine.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "engine/ordered_delivery.hpp"
#include "engine/parallel.hpp"
#include "hoop/units.hpp"
#include "leapmap/errors.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"

namespace leapmap {

namespace {

/// Designs solved at once: what the solvers take as one block, and no more than stays in the second cache;
/// with many hoops made after each fewer, so that a stop need not wait long.
std::size_t piece_of(const Request& request) {
  constexpr std::size_t most = 1024;
  if (!wants_samples(request)) return most;
  const std::size_t most_hoops = can_be_interpolated(request) ? MadeLine::most_hoops : 1 << 16;
  return std::clamp<std::size_t>(most_hoops / static_cast<std::size_t>(request.scatter.samples), 1, most);
}

/// How many of a tile's designs, from `first` on, are solved at once where hoops are interpolated along rows:
/// as many whole rows as fit, or what is left of one.
std::size_t some_rows(const Tile& tile, std::size_t first, std::size_t most) {
  const std::size_t row = tile.extent.back();
  return row <= most ? most - most % row : std::min(most, row - first % row);
}

struct Item {
  Prepared prepared;
  std::size_t designs;
};

}  // namespace

std::span<const double> Solved::column(const Field& field) const {
  const auto* derivative = std::get_if<Derivative>(&field.source);
  if (derivative && !derivative->by) return std::ranges::find(by_body, &field, &BodyColumn::field)->values;
  return derivative ? gradients.column(derivative->of, derivative->by) : made.column(field);
}

BlockSolver::BlockSolver(const Request& request, std::size_t most_in_block,
                         const std::shared_ptr<const SobolPoints>& points)
    : solver_(make_gradient_solver(request)),
      gradients_(derivatives_of(request)),
      made_(statistics_of(request)),
      nominal_(request.hoop.value_or(Body{})),
      held_(request.held),
      outcomes_(most_in_block) {
  for (const Field* column : request.columns)
    if (const auto* derivative = std::get_if<Derivative>(&column->source); derivative && !derivative->by)
      by_body_.push_back({column, *find_variable(derivative->hoop, &nominal_), {}});
  if (wants_samples(request)) scatter_.emplace(scatter_solver_of(request, points));
}

Solved BlockSolver::solve(std::span<const Design> designs, std::span<const Body> bodies) {
  const std::span outcomes = std::span(outcomes_).first(designs.size());
  solver_(designs, outcomes, gradients_);
  if (scatter_) scatter_->solve(designs, made_, bodies);
  derive_by_body(designs, bodies);
  return {outcomes, gradients_, made_, by_body_};
}

void BlockSolver::derive_by_body(std::span<const Design> designs, std::span<const Body> bodies) {
  for (BodyColumn& column : by_body_) {
    const OutcomeNumber& of = std::get<Derivative>(column.field->source).of;
    column.values.resize(designs.size());
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const Design by = gradients_.of_design(of, i);
      column.values[i] =
          column.variable.derivative(by, bodies.empty() ? nominal_ : bodies[i],
                                     ByScale::of(designs[i], by, in_seconds(of, outcomes_[i]), held_));
    }
  }
}

std::function<TileWork()> in_order(TileSink sink) {
  return [sink = std::move(sink)] {
    const auto kept = std::make_shared<std::vector<Outcome>>();
    return TileWork{
        [kept](const Tile&, std::size_t, const Solved& solved) {
          kept->insert(kept->end(), solved.outcomes.begin(), solved.outcomes.end());
        },
        [sink, kept](std::size_t, const Tile& tile) {
          const std::size_t bytes = kept->size() * sizeof(Outcome);
          return Prepared{[sink, tile, outcomes = std::exchange(*kept, {})] { sink(tile, outcomes); }, bytes};
        }};
  };
}

std::size_t run_sweep(const Spec& spec, const Request& request, const Tiling& tiling,
                      const EngineOptions& options, const std::function<TileWork()>& make_work) {
  const DesignSpace space(spec);
  const std::size_t tiles = tiling.size() - std::min(options.first_tile, tiling.size());
  std::size_t delivered = 0;
  OrderedDelivery<Item> delivery(
      options.first_tile,
      [&](Item& item) {
        item.prepared.take();
        delivered += item.designs;
      },
      most_waiting_bytes(thread_count(options.threads)), tiles);

  const std::size_t piece = std::min(piece_of(request), tiling.largest_tile());
  const bool in_rows = !interpolated_along(spec, request).empty();
  const auto points = points_of(request.scatter);
  const bool scattered = wants_samples(request), needs_bodies = scattered || derives_by_body(request);
  parallel_for_each(tiles, thread_count(options.threads), options.stop_requested, [&] {
    // A thread's own: the method's workspace, the encoder's, and the piece of a tile in hand.
    return
        [&, solver = BlockSolver(request, piece, points), work = make_work(),
         block = std::vector<Design>(piece),
         bodies = std::vector<Body>(needs_bodies && space.varies_body() ? piece : 0)](std::size_t i) mutable {
          try {
            const std::size_t number = options.first_tile + i;
            const Tile tile = tiling.tile(number);
            for (std::size_t first = 0, count = 0; first < tile.count; first += count) {
              // A tile of many hoops as made may take minutes, and is given up; any other is brought to its
              // end, unless that takes seconds.
              if (scattered && options.stop_requested && options.stop_requested()) {
                delivery.close(number);
                return false;
              }
              count = std::min(in_rows ? some_rows(tile, first, piece) : piece, tile.count - first);
              const std::span some(block.data(), count);
              const std::span of_some(bodies.data(), std::min(count, bodies.size()));
              space.fill(tile, first, some, of_some);
              work.take(tile, first, solver.solve(some, of_some));
            }
            Prepared prepared = work.prepare(number, tile);
            if (!prepared.take) {
              delivery.close(number);
              return false;
            }
            const std::size_t bytes = prepared.bytes;
            const bool wanted = delivery.bring(number, {std::move(prepared), tile.count}, bytes);
            return wanted && !(options.stop_requested && options.stop_requested());
          } catch (const Stopped&) {  // inside a design that takes long: the tile is given up
            delivery.close(options.first_tile + i);
            return false;
          } catch (...) {
            delivery.abandon();
            throw;
          }
        };
  });
  delivery.finish();
  return delivered;
}

double seconds_per_design(const Spec& spec, const Request& request, double seconds) {
  using Clock = std::chrono::steady_clock;
  const DesignSpace space(spec);
  const std::size_t count = designs_of(shape_of(spec));
  constexpr std::size_t most = 8192;
  BlockSolver solver(request, most, points_of(request.scatter));
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> pick(0, count - 1);
  // Few at a time while it is not known how long one takes: an integration may need seconds. But what is
  // interpolated along lines takes less than one by one.
  const bool in_lines = !interpolated_along(spec, request).empty();
  const std::size_t row = in_lines ? spec.axes.back().values.size() : 1,
                    line = in_lines ? std::min(row, piece_of(request)) : 1;
  std::vector<Design> some(in_lines ? line : wants_samples(request) ? 1 : 8);
  std::chrono::duration<double> passed{0};
  std::size_t solved = 0;
  while (passed.count() < seconds) {
    for (std::size_t i = 0; i < some.size(); i += line) {
      const std::size_t first = pick(random) / row * row;
      for (std::size_t k = 0; k < line; ++k) some[i + k] = space.at(first + k);
    }
    const auto begin = Clock::now();
    solver.solve(some);
    passed += Clock::now() - begin;
    solved += some.size();
    if (passed.count() < 0.1 * seconds) some.resize(std::min(2 * some.size(), most / line * line));
  }
  return passed.count() / static_cast<double>(solved);
}

}  // namespace leapmap
