// SPDX-License-Identifier: GPL-3.0-or-later
#include "shards/shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <random>
#include <utility>

#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "model/model.hpp"
#include "request/request.hpp"
#include "spec/designs.hpp"

namespace leapmap {
namespace {

/// How many designs each shard looks at to share the map, as a share of its own; but at least so many, which
/// take a tenth of a second. Twice, where tiles are uneven.
constexpr double most_share = 0.005;
constexpr std::size_t least_samples = 8'192, most_of_tile = 32, most_tiles = 32'768;

/// What is known of a tile's designs.
struct Sampled {
  std::size_t designs = 0;
  double sum = 0.0, squares = 0.0;

  double mean() const { return sum / static_cast<double>(designs); }
  double deviation() const {
    return std::sqrt(std::max(squares / static_cast<double>(designs) - mean() * mean(), 0.0));
  }
};

DesignEffort effort_of(const Spec& spec) {
  const Request request = request_of(spec);
  const Scene scene = scene_followed(request);
  const Model& model = model_of(scene);
  if (!model.effort) return [](const Design&) { return 1.0; };
  return model.effort(scene, !derivatives_of(request).of.empty());
}

/// Counts the efforts of so many designs of each tile, one of each of as many pieces of it.
std::vector<Sampled> sample_tiles(const Spec& spec, const Tiling& tiling, std::size_t stride,
                                  const std::vector<std::size_t>& wanted, int threads) {
  const DesignSpace space(spec);
  std::vector<Sampled> sampled(wanted.size());
  parallel_for_each(wanted.size(), thread_count(threads), {}, [&] {
    return [&, effort = effort_of(spec)](std::size_t t) {
      const Tile tile = tiling.tile(stride * t);
      const std::size_t designs = std::min(wanted[t], tile.count);
      std::mt19937_64 random(t);  // the same numbers on every machine, as those of distributions are not
      for (std::size_t k = 0; k < designs; ++k) {
        const std::size_t begin = k * tile.count / designs, end = (k + 1) * tile.count / designs;
        const double one = effort(space.at(tiling.number(tile, begin + random() % (end - begin))));
        sampled[t].sum += one, sampled[t].squares += one * one;
      }
      sampled[t].designs = designs;
      return true;
    };
  });
  return sampled;
}

}  // namespace

std::vector<double> tile_efforts(const Spec& spec, const Tiling& tiling, std::size_t shards, int threads) {
  const double samples =
      std::max(most_share * static_cast<double>(tiling.designs()) / static_cast<double>(shards),
               static_cast<double>(least_samples));
  const std::size_t most_groups = std::min(static_cast<std::size_t>(samples), most_tiles);
  const std::size_t stride = (tiling.size() + most_groups - 1) / most_groups,
                    groups = (tiling.size() + stride - 1) / stride;
  const auto count = [&](std::size_t group) {
    return static_cast<double>(tiling.tile(stride * group).count);
  };
  const std::size_t each =
      std::clamp<std::size_t>(static_cast<std::size_t>(samples) / groups, 1, most_of_tile);
  std::vector<std::size_t> wanted(groups, each);
  std::vector<Sampled> sampled = sample_tiles(spec, tiling, stride, wanted, threads);
  // A few designs that rock to rest may be most of a tile's work. More are looked at where that tells most
  // for what it takes: Neyman's allocation.
  const auto worth = [&](std::size_t g) {
    return count(g) * sampled[g].deviation() / std::sqrt(sampled[g].mean());
  };
  double price = 0.0, mean = 0.0;
  for (std::size_t g = 0; g < groups; ++g) {
    price += worth(g) * sampled[g].mean();
    mean += sampled[g].mean() / static_cast<double>(groups);
  }
  if (price > 0.0) {
    for (std::size_t g = 0; g < groups; ++g)
      wanted[g] = std::max(each, static_cast<std::size_t>(worth(g) * samples * mean / price));
    sampled = sample_tiles(spec, tiling, stride, wanted, threads);
  }
  std::vector<double> efforts;
  for (std::size_t t = 0; t < tiling.size(); ++t)
    efforts.push_back(sampled[t / stride].mean() * static_cast<double>(tiling.tile(t).count));
  return efforts;
}

std::vector<std::vector<std::size_t>> share_tiles(const std::vector<double>& efforts, std::size_t shards) {
  std::vector<std::size_t> order(efforts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t t) { return efforts[t]; });
  using Load = std::pair<double, std::size_t>;  // and whose: of equal loads the first shard's counts
  std::priority_queue<Load, std::vector<Load>, std::greater<>> least;
  for (std::size_t s = 0; s < shards; ++s) least.emplace(0.0, s);
  std::vector<std::vector<std::size_t>> shares(shards);
  for (const std::size_t t : order) {
    const auto [load, shard] = least.top();
    least.pop();
    shares[shard].push_back(t);
    least.emplace(load + efforts[t], shard);
  }
  for (std::vector<std::size_t>& share : shares) std::ranges::sort(share);
  return shares;
}

Tiling shard_of(const Spec& spec, const Tiling& tiling, const Shard& shard, int threads) {
  return tiling.part(share_tiles(tile_efforts(spec, tiling, shard.of, threads), shard.of)[shard.number - 1]);
}

std::vector<std::int64_t> bits_of(const std::vector<std::size_t>& tiles, std::size_t count) {
  std::vector<std::uint64_t> words((count + 63) / 64);
  for (const std::size_t t : tiles) words[t / 64] |= std::uint64_t{1} << (t % 64);
  return {words.begin(), words.end()};
}

std::vector<std::size_t> tiles_held(hid_t shard, std::size_t count) {
  return tiles_in(hdf5::read_integers(shard, shard_tiles_attribute, (count + 63) / 64), count);
}

std::vector<std::size_t> tiles_in(const std::vector<std::int64_t>& bits, std::size_t count) {
  if (bits.size() != (count + 63) / 64) throw BrokenFile("its shard_tiles do not match its chunks");
  std::vector<std::size_t> tiles;
  for (std::size_t t = 0; t < 64 * bits.size(); ++t) {
    if ((static_cast<std::uint64_t>(bits[t / 64]) >> (t % 64) & 1u) == 0) continue;
    if (t >= count) throw BrokenFile("its shard_tiles do not match its chunks");
    tiles.push_back(t);
  }
  return tiles;
}

}  // namespace leapmap
