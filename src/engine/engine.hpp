// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves the tiles of a sweep on all threads and hands them on in order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "leapmap/outcome.hpp"
#include "map/tile.hpp"
#include "model/variable.hpp"
#include "request/solver.hpp"
#include "spec/spec.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

/// Of tiles prepared and not yet taken, for so many threads; enough to go on while a commit waits for the
/// disk, and while a tile that takes ten times as long as the others keeps those after it waiting.
constexpr std::size_t most_waiting_bytes(int threads) {
  return std::max(std::size_t{64} << 20, static_cast<std::size_t>(threads) << 22);
}

struct EngineOptions {
  int threads = 0;                       ///< 0: as many as OpenMP offers
  std::size_t first_tile = 0;            ///< tiles before it are there already
  std::function<bool()> stop_requested;  ///< asked after each tile; true: no further tile is begun
};

/// What is left to do with a tile once a thread has prepared it: `take` is called in the order of the tiles'
/// numbers, from one thread that does nothing else; until then it holds `bytes` of memory. No `take`: the
/// tile was given up as a stop was requested, and no tile after it is taken.
struct Prepared {
  std::function<void()> take;
  std::size_t bytes = 0;
};

/// A derivative by a number of [hoop], of a block of designs.
struct BodyColumn {
  const Field* field;
  Variable variable;
  std::vector<double> values;
};

/// Everything that a request asks of a block of designs.
struct Solved {
  std::span<const Outcome> outcomes;
  const Gradients& gradients;
  const MadeColumns& made;
  const std::vector<BodyColumn>& by_body;

  /// Of a field that is no part of an outcome.
  std::span<const double> column(const Field& field) const;
};

/// A thread's own solver of all that.
class BlockSolver {
 public:
  /// points: of hoops as made, shared by all threads.
  BlockSolver(const Request& request, std::size_t most_in_block,
              const std::shared_ptr<const SobolPoints>& points);
  /// What it returns holds until the next call. bodies: of the designs where [hoop] varies, else none.
  Solved solve(std::span<const Design> designs, std::span<const Body> bodies = {});

 private:
  void derive_by_body(std::span<const Design> designs, std::span<const Body> bodies);

  GradientSolver solver_;
  Gradients gradients_;
  std::optional<ScatterSolver> scatter_;
  MadeColumns made_;
  Body nominal_;
  std::vector<SameInSi> held_;
  std::vector<BodyColumn> by_body_;
  std::vector<Outcome> outcomes_;
};

/// What a thread does with the tiles it solves, one after the other. A tile's outcomes come a piece at a
/// time, in its order and while they are still in the cache.
struct TileWork {
  std::function<void(const Tile&, std::size_t first, const Solved&)> take;
  /// The whole tile was taken: encodes it, compresses it.
  std::function<Prepared(std::size_t number, const Tile&)> prepare;
};

/// Is handed a tile's outcomes as they are.
using TileSink = std::function<void(const Tile&, std::span<const Outcome>)>;

/// Prepares nothing: hands a copy of each tile's outcomes to the sink, in order.
std::function<TileWork()> in_order(TileSink sink);

/// Solves every tile from first_tile on; returns the number of designs handed on, all of them unless a stop
/// was requested. make_work is called once on each thread. What the work or `take` throws ends the sweep and
/// is thrown on. Outcomes depend on spec and request alone, not on threads or timing; memory does not grow
/// with the number of designs, nor when whoever takes them is slow.
std::size_t run_sweep(const Spec& spec, const Request& request, const Tiling& tiling,
                      const EngineOptions& options, const std::function<TileWork()>& make_work);

/// Seconds per design on one thread, from a seeded sample solved for about the given time.
double seconds_per_design(const Spec& spec, const Request& request, double seconds);

}  // namespace leapmap
