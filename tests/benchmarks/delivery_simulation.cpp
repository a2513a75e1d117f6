// SPDX-License-Identifier: GPL-3.0-or-later
/// How large a machine one sweep fills: the engine's own delivery in order, with threads that sleep as long
/// as a tile takes to solve and a writer that sleeps as long as it takes to write, so that two cores show
/// what 128 would do. All times are drawn out until a tile takes so long that the machine's own waking up is
/// nothing beside it.
///   delivery-simulation [DESIGNS_PER_SECOND_OF_A_CORE DESIGNS_PER_SECOND_OF_THE_WRITER BYTES_OF_A_TILE]
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/engine.hpp"
#include "engine/ordered_delivery.hpp"

namespace leapmap {
namespace {

using Seconds = std::chrono::duration<double>;
constexpr double designs_of_tile = 16'384.0;
constexpr double drawn_out = 0.1;  ///< s that a tile takes here
constexpr std::size_t tiles_of_core = 96, most_tiles = 6'144;

struct Work {
  std::string_view name;
  double solved, written;  ///< designs a second: by a core, and by the writer
  std::size_t bytes;       ///< of a tile that waits
  double spread;           ///< of the logarithm of what a tile takes
};

struct Seen {
  double seconds = 0.0;  ///< in all, as if nothing were drawn out
  double writing = 0.0;  ///< share of that in which the writer had something to do
  std::size_t most_bytes = 0;
};

Seen simulate(const Work& work, std::size_t threads, std::size_t tiles) {
  const double slower = drawn_out * work.solved / designs_of_tile;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Seconds> solving;
  for (std::size_t t = 0; t < tiles; ++t)
    solving.emplace_back(drawn_out *
                         std::exp(work.spread * normal(random) - 0.5 * work.spread * work.spread));
  std::atomic<std::size_t> next{0};
  std::atomic<std::ptrdiff_t> bytes{0}, most{0};  // taken may be counted before brought
  const auto of_tile = static_cast<std::ptrdiff_t>(work.bytes);
  Seconds writing{0};
  const auto begin = std::chrono::steady_clock::now();
  {
    OrderedDelivery<int> delivery(
        0,
        [&](int&) {
          const Seconds one{slower * designs_of_tile / work.written};
          std::this_thread::sleep_for(one);
          writing += one;
          bytes -= of_tile;
        },
        most_waiting_bytes(static_cast<int>(threads)));
    std::vector<std::jthread> cores;
    for (std::size_t k = 0; k < threads; ++k)
      cores.emplace_back([&] {
        for (std::size_t t; (t = next++) < tiles;) {
          std::this_thread::sleep_for(solving[t]);
          if (!delivery.bring(t, 0, work.bytes)) return;
          const std::ptrdiff_t now = bytes += of_tile;
          for (std::ptrdiff_t seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
          }
        }
      });
    cores.clear();
    delivery.finish();
  }
  const Seconds took = std::chrono::steady_clock::now() - begin;
  return {took.count() / slower, writing / took, static_cast<std::size_t>(most)};
}

void report(const Work& work) {
  fmt::print("{}: {:.3g} designs/s and core, the writer {:.3g} designs/s, which {:.0f} cores fill\n",
             work.name, work.solved, work.written, work.written / work.solved);
  for (const std::size_t threads : {8u, 32u, 64u, 128u}) {
    const std::size_t tiles = std::min(tiles_of_core * threads, most_tiles);
    const Seen seen = simulate(work, threads, tiles);
    const double rate = static_cast<double>(tiles) * designs_of_tile / seen.seconds;
    fmt::print(
        "  {:3} cores  {:8.3g} designs/s, {:3.0f} % of all cores' work; writer busy {:3.0f} %; {:5.1f} MB "
        "waiting at most\n",
        threads, rate, 100.0 * rate / (static_cast<double>(threads) * work.solved), 100.0 * seen.writing,
        static_cast<double>(seen.most_bytes) / 1e6);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace leapmap

int main(int argc, char** argv) {
  const std::span words(argv, static_cast<std::size_t>(argc));
  if (words.size() == 4) {
    const double solved = std::atof(words[1]), written = std::atof(words[2]), bytes = std::atof(words[3]);
    if (solved > 0.0 && written > 0.0 && bytes > 0.0) {
      leapmap::report({"asked", solved, written, static_cast<std::size_t>(bytes), 0.5});
      return 0;
    }
  }
  if (words.size() != 1) {
    fmt::print(stderr,
               "delivery-simulation: allowed: nothing, or three numbers above 0: designs a second of a core "
               "and of the "
               "writer, bytes of a tile\n");
    return 2;
  }
  leapmap::report({"never slip, three fields in f4", 3.6e6, 1.35e8, 56'000, 0.3});
  leapmap::report({"slip, three fields in f8", 2.0e5, 1.35e8, 300'000, 1.0});
  return 0;
}
