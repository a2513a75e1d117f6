// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/engine.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "support/designs.hpp"
#include "sweep/designs.hpp"
#include "sweep/ordered_delivery.hpp"
#include "sweep/parallel.hpp"
#include "sweep/solver.hpp"

namespace leapmap {
namespace {

Spec small_grid() {
  return read_spec("",
                   {"slope={from=0.05,to=0.9,count=23}", "mass_ratio={from=0.1,to=20,count=19,scale=\"log\"}",
                    "offset_ratio={values=[0.6,1.0]}", "tolerance=1e-8"});
}

std::vector<Outcome> outcomes_of(const Spec& spec, int threads) {
  const Tiling tiling(shape_of(spec));
  std::vector<Outcome> all;
  EngineOptions options;
  options.threads = threads;
  run_sweep(spec, tiling, options, [&](const Tile&, std::span<const Outcome> outcomes) {
    all.insert(all.end(), outcomes.begin(), outcomes.end());
  });
  return all;
}

TEST(Engine, GivesTheSameBitsWhateverTheNumberOfThreads) {
  const Spec spec = small_grid();
  const auto one = outcomes_of(spec, 1);
  ASSERT_EQ(one.size(), 23u * 19u * 2u);
  for (const int threads : {2, 3, 7}) {
    const auto many = outcomes_of(spec, threads);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].status, many[i].status);
      EXPECT_EQ(one[i].candidates, many[i].candidates);
      EXPECT_EQ(std::memcmp(&one[i].jump_height, &many[i].jump_height, sizeof(double)), 0);
      EXPECT_EQ(std::memcmp(&one[i].jump_time, &many[i].jump_time, sizeof(double)), 0);
    }
  }
}

TEST(Engine, SolvesEachDesignOfEachTileInItsPlace) {
  const Spec spec = small_grid();
  const Tiling tiling(shape_of(spec));
  const DesignSpace space(spec);
  const Solver solve = make_solver(spec);
  std::size_t expected_number = 0;
  run_sweep(spec, tiling, {}, [&](const Tile& tile, std::span<const Outcome> outcomes) {
    EXPECT_EQ(tile.start, tiling.tile(expected_number++).start) << "tiles come in order";
    for (std::size_t i = 0; i < tile.count; i += 17) {
      const Design design = space.at(tiling.number(tile, i));
      Outcome outcome;
      solve({&design, 1}, {&outcome, 1});
      EXPECT_EQ(outcome.status, outcomes[i].status);
      if (outcome.status == Status::jumped) {
        EXPECT_EQ(outcome.jump_height, outcomes[i].jump_height);
      }
    }
  });
  EXPECT_EQ(expected_number, tiling.size());
}

TEST(Engine, AnErrorOfTheSinkEndsTheSweepAndIsThrownOn) {
  const Spec spec = small_grid();
  int taken = 0;
  EXPECT_THROW(run_sweep(spec, Tiling(shape_of(spec)), {.threads = 4, .stop_requested = {}, .progress = {}},
                         [&](const Tile&, std::span<const Outcome>) {
                           if (++taken == 3) throw std::runtime_error("disk full");
                         }),
               std::runtime_error);
  EXPECT_EQ(taken, 3) << "nothing is handed on after an error";
}

TEST(Engine, AStopKeepsWhatWasDoneInOrder) {
  const Spec spec = small_grid();
  const Tiling tiling(shape_of(spec));
  std::atomic<std::size_t> designs{0};
  EngineOptions options;
  options.threads = 2;
  options.stop_requested = [&] { return designs > 200; };
  options.progress = [&](std::size_t done) { designs = done; };
  std::size_t taken = 0;
  const std::size_t done =
      run_sweep(spec, tiling, options,
                [&](const Tile&, std::span<const Outcome> outcomes) { taken += outcomes.size(); });
  EXPECT_EQ(done, taken);
  EXPECT_GT(done, 200u);
  EXPECT_LT(done, tiling.designs());
}

TEST(OrderedDelivery, HandsOnInOrderAndHoldsBackTheFast) {
  std::vector<std::size_t> order;
  OrderedDelivery<int> delivery([&](std::size_t number, int) { order.push_back(number); }, 2);
  EXPECT_TRUE(delivery.bring(2, 0));
  EXPECT_TRUE(delivery.bring(1, 0));
  EXPECT_TRUE(order.empty());
  std::atomic<bool> brought{false};
  std::thread early([&] {
    delivery.bring(3, 0);  // two wait already: this one has to
    brought = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(brought);
  EXPECT_TRUE(delivery.bring(0, 0));
  early.join();
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(OrderedDelivery, AnErrorWhileTakingAbandonsTheDeliveryAtOnce) {
  int taken = 0;
  OrderedDelivery<int> delivery(
      [&](std::size_t, int) {
        ++taken;
        throw std::runtime_error("disk full");
      },
      2);
  EXPECT_THROW(delivery.bring(0, 0), std::runtime_error);
  EXPECT_FALSE(delivery.bring(1, 0)) << "nobody else may take the same item again";
  EXPECT_EQ(taken, 1);
}

TEST(OrderedDelivery, AbandoningLetsWaitingThreadsGo) {
  OrderedDelivery<int> delivery([](std::size_t, int) {}, 0);
  std::thread waiting([&] { EXPECT_FALSE(delivery.bring(5, 0)); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  delivery.abandon();
  waiting.join();
  EXPECT_FALSE(delivery.bring(0, 0));
}

TEST(ParallelForEach, EachNumberOnceAndAnExceptionFromAnyThreadIsThrownOn) {
  std::vector<std::atomic<int>> seen(1000);
  parallel_for_each(seen.size(), 4, [&] { return [&](std::size_t i) { return ++seen[i], true; }; });
  for (const auto& count : seen) EXPECT_EQ(count, 1);
  EXPECT_THROW(parallel_for_each(100, 4,
                                 [] {
                                   return [](std::size_t i) {
                                     if (i == 42) throw std::runtime_error("42");
                                     return true;
                                   };
                                 }),
               std::runtime_error);
}

TEST(Probe, EstimatesAPositiveTimeForEachDesign) {
  const double seconds = seconds_per_design(small_grid(), 0.02);
  EXPECT_GT(seconds, 0.0);
  EXPECT_LT(seconds, 1.0);
}

}  // namespace
}  // namespace leapmap
