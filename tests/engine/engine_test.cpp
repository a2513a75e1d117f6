// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/engine.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "audit/audit.hpp"
#include "engine/ordered_delivery.hpp"
#include "engine/parallel.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "support/designs.hpp"

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
  run_sweep(spec, request_of(spec), tiling, options,
            in_order([&](const Tile&, std::span<const Outcome> outcomes) {
              all.insert(all.end(), outcomes.begin(), outcomes.end());
            }));
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
  const Solver solve = make_solver(request_of(spec));
  std::size_t expected_number = 0;
  const auto check = [&](const Tile& tile, std::span<const Outcome> outcomes) {
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
  };
  run_sweep(spec, request_of(spec), tiling, {}, in_order(check));
  EXPECT_EQ(expected_number, tiling.size());
}

TEST(Engine, AnErrorOfTheSinkEndsTheSweepAndIsThrownOn) {
  const Spec spec = small_grid();
  int taken = 0;
  EngineOptions options;
  options.threads = 4;
  EXPECT_THROW(run_sweep(spec, request_of(spec), Tiling(shape_of(spec)), options,
                         in_order([&](const Tile&, std::span<const Outcome>) {
                           if (++taken == 3) throw std::runtime_error("disk full");
                         })),
               std::runtime_error);
  EXPECT_EQ(taken, 3) << "nothing is handed on after an error";
}

/// 2,911 designs in rows of 71, so that pieces begin in the middle of one.
TEST(Engine, ATileOfSeveralPiecesIsFilledSolvedAndAuditedAsAWhole) {
  const Spec spec = read_spec(
      "", {"slope={from=0.1,to=0.8,count=41}", "mass_ratio={from=0.5,to=10,count=71}", "audit=0.3"});
  const std::vector<std::size_t> shape = shape_of(spec);
  const Tiling tiling(shape, shape);
  const DesignSpace space(spec);
  std::vector<AuditSample> samples;
  std::size_t taken = 0, pieces = 0;
  run_sweep(spec, request_of(spec), tiling, {}, [&] {
    return TileWork{[&](const Tile& tile, std::size_t first, const Solved& solved) {
                      const std::span<const Outcome> outcomes = solved.outcomes;
                      EXPECT_EQ(first, taken);
                      std::vector<Design> designs(outcomes.size());
                      space.fill(tile, first, designs);
                      for (std::size_t i = 0; i < designs.size(); ++i) {
                        const Design expected = space.at(first + i);
                        EXPECT_EQ(designs[i].slope, expected.slope);
                        EXPECT_EQ(designs[i].mass_ratio, expected.mass_ratio);
                        if (outcomes[i].status == Status::jumped) {
                          EXPECT_EQ(outcomes[i].jump_distance,
                                    outcomes[i].jump_angle - expected.release_angle);
                        }
                      }
                      for (const AuditSample& sample : audit_samples(spec, tiling, tile, first, outcomes)) {
                        EXPECT_EQ(std::memcmp(&sample.outcome.jump_height,
                                              &outcomes[sample.number - first].jump_height, sizeof(double)),
                                  0);
                        samples.push_back(sample);
                      }
                      taken += outcomes.size(), ++pieces;
                    },
                    [](std::size_t, const Tile&) { return Prepared{[] {}}; }};
  });
  EXPECT_EQ(taken, 41u * 71u);
  EXPECT_GT(pieces, 2u);
  const std::vector<std::size_t> drawn = audit_draw(0.3, tiling, tiling.tile(0));
  ASSERT_EQ(samples.size(), drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) EXPECT_EQ(samples[i].number, drawn[i]);

  std::vector<Outcome> alone(taken);
  const Solver solve = make_solver(request_of(spec));
  for (const AuditSample& sample : samples) {
    const Design design = space.at(sample.number);
    solve({&design, 1}, {&alone[sample.number], 1});
    EXPECT_TRUE(same_flags(alone[sample.number], sample.outcome));
  }
}

TEST(Engine, AStopKeepsWhatWasDoneInOrder) {
  const Spec spec = small_grid();
  const Tiling tiling(shape_of(spec));
  std::atomic<std::size_t> solved{0};
  std::size_t taken = 0;
  EngineOptions options;
  options.threads = 2;
  options.stop_requested = [&] { return solved > 200; };
  const std::size_t done = run_sweep(spec, request_of(spec), tiling, options, [&] {
    return TileWork{[&](const Tile&, std::size_t, const Solved& some) { solved += some.outcomes.size(); },
                    [&](std::size_t, const Tile& tile) {
                      return Prepared{[&taken, count = tile.count] { taken += count; }};
                    }};
  });
  EXPECT_EQ(done, taken);
  EXPECT_EQ(done, solved) << "what was begun is brought to its end";
  EXPECT_GT(done, 200u);
  EXPECT_LT(done, tiling.designs());
}

TEST(Engine, GoesOnAtAnyTile) {
  const Spec spec = small_grid();
  const Tiling tiling(shape_of(spec));
  EngineOptions options;
  for (const std::size_t first : {std::size_t{1}, tiling.size() / 2, tiling.size() - 1, tiling.size()}) {
    options.first_tile = first;
    std::size_t next = first;
    const std::size_t done = run_sweep(spec, request_of(spec), tiling, options,
                                       in_order([&](const Tile& tile, std::span<const Outcome>) {
                                         EXPECT_EQ(tile.start, tiling.tile(next++).start);
                                       }));
    EXPECT_EQ(next, tiling.size());
    const std::size_t before =
        first < tiling.size() ? tiling.designs_before(tiling.tile(first)) : tiling.designs();
    EXPECT_EQ(done, tiling.designs() - before);
  }
}

TEST(OrderedDelivery, HandsOnInOrderAndHoldsBackTheFast) {
  std::vector<int> order;
  OrderedDelivery<int> delivery(
      10, [&](int& item) { order.push_back(item); }, 2);
  EXPECT_TRUE(delivery.bring(12, 12, 1));
  EXPECT_TRUE(delivery.bring(11, 11, 1));
  std::atomic<bool> brought{false};
  std::thread early([&] {
    delivery.bring(13, 13, 1);  // two bytes wait already: this one has to
    brought = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(brought);
  EXPECT_TRUE(delivery.bring(10, 10, 100)) << "the one whose turn it is never waits, however large";
  early.join();
  delivery.finish();
  EXPECT_EQ(order, (std::vector<int>{10, 11, 12, 13}));
}

TEST(OrderedDelivery, HandsOnWhatIsDueBeforeMoreIsBrought) {
  std::atomic<int> taken{0};
  OrderedDelivery<int> delivery(
      0, [&](int&) { ++taken; }, 100);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(delivery.bring(i, 0, 1));
    const auto begin = std::chrono::steady_clock::now();  // ten seconds are for the slowest machine
    while (taken <= static_cast<int>(i) &&
           std::chrono::steady_clock::now() - begin < std::chrono::seconds(10))
      std::this_thread::yield();
    EXPECT_EQ(taken, static_cast<int>(i) + 1);
  }
  delivery.finish();
}

TEST(OrderedDelivery, HoldsBackTheFastWhileTakingIsSlow) {
  std::atomic<int> brought{0}, most_ahead{0};
  int taken = 0;
  OrderedDelivery<int> delivery(
      0,
      [&](int&) {
        most_ahead = std::max(most_ahead.load(), brought - ++taken);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      },
      5);
  for (std::size_t i = 0; i < 40; ++i) delivery.bring(i, 0, 1), ++brought;
  delivery.finish();
  EXPECT_EQ(taken, 40);
  EXPECT_LE(most_ahead, 7) << "five may wait, one is being taken, one brings itself";
}

TEST(OrderedDelivery, AnErrorWhileTakingAbandonsTheDeliveryAtOnce) {
  std::atomic<int> taken{0};
  OrderedDelivery<int> delivery(
      0,
      [&](int&) {
        ++taken;
        throw std::runtime_error("disk full");
      },
      2);
  delivery.bring(0, 0, 1);
  while (delivery.bring(1, 0, 1)) std::this_thread::yield();
  EXPECT_THROW(delivery.finish(), std::runtime_error);
  EXPECT_EQ(taken, 1) << "nothing is taken after an error";
}

TEST(OrderedDelivery, ASingleItemIsTakenByWhoeverFinishes) {
  std::vector<std::thread::id> takers;
  OrderedDelivery<int> delivery(
      3, [&](int&) { takers.push_back(std::this_thread::get_id()); }, 2, 1);
  EXPECT_TRUE(delivery.bring(3, 0, 1));
  EXPECT_TRUE(takers.empty());
  delivery.finish();
  EXPECT_EQ(takers, std::vector{std::this_thread::get_id()});

  OrderedDelivery<int> fails(
      0, [](int&) { throw std::runtime_error("disk full"); }, 2, 1);
  EXPECT_TRUE(fails.bring(0, 0, 1));
  EXPECT_THROW(fails.finish(), std::runtime_error);

  OrderedDelivery<int> none(
      0, [&](int&) { takers.clear(); }, 2, 1);
  none.close(0);
  EXPECT_FALSE(none.bring(0, 0, 1));
  none.finish();
  OrderedDelivery<int> abandoned(
      0, [&](int&) { takers.clear(); }, 2, 1);
  EXPECT_TRUE(abandoned.bring(0, 0, 1));
  abandoned.abandon();
  abandoned.finish();
  EXPECT_EQ(takers.size(), 1u) << "what was closed or abandoned is not taken";
}

TEST(OrderedDelivery, AbandoningLetsWaitingThreadsGo) {
  OrderedDelivery<int> delivery(
      0, [](int&) {}, 0);
  std::thread waiting([&] { EXPECT_FALSE(delivery.bring(5, 0, 1)); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  delivery.abandon();
  waiting.join();
  EXPECT_FALSE(delivery.bring(0, 0, 1));
}

TEST(ParallelForEach, EachNumberOnceAndAnExceptionFromAnyThreadIsThrownOn) {
  std::vector<std::atomic<int>> seen(1000);
  parallel_for_each(seen.size(), 4, {}, [&] { return [&](std::size_t i) { return ++seen[i], true; }; });
  for (const auto& count : seen) EXPECT_EQ(count, 1);
  EXPECT_THROW(parallel_for_each(100, 4, {},
                                 [] {
                                   return [](std::size_t i) {
                                     if (i == 42) throw std::runtime_error("42");
                                     return true;
                                   };
                                 }),
               std::runtime_error);
}

TEST(Probe, EstimatesAPositiveTimeForEachDesign) {
  const double seconds = seconds_per_design(small_grid(), request_of(small_grid()), 0.02);
  EXPECT_GT(seconds, 0.0);
  EXPECT_LT(seconds, 1.0);
}

}  // namespace
}  // namespace leapmap
