// SPDX-License-Identifier: GPL-3.0-or-later
/// Designs aimed at the nodes of the scan and at the edge of a release, against long double. LEAPMAP_AIMED:
/// how many.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/aimed.hpp"
#include "support/exact.hpp"

namespace leapmap {
namespace {

using testing::how_many, testing::nudged;

/// allowed: by default what some units in the last place make of a height far down a long runway.
bool agree(const Outcome& a, const Outcome& b, double allowed = 1e-11) {
  return same_flags(a, b) && (std::isnan(a.jump_height) ? std::isnan(b.jump_height)
                                                        : std::abs(a.jump_height - b.jump_height) <=
                                                              allowed * (1.0 + b.jump_height));
}

/// Whether ours is what the reference finds beside the design, with any of its parameters some units in the
/// last place away: where those differ from the design itself, nobody can tell.
bool is_right_beside(const Outcome& ours, const Design& design, const Scene& scene) {
  for (double Design::*member : {&Design::release_spin, &Design::release_angle, &Design::slope,
                                 &Design::mass_ratio, &Design::offset_ratio, &Design::inertia_factor})
    for (const int ulps : {-1, 1, -2, 2, -4, 4, -8, 8}) {
      Design beside = design;
      beside.*member = nudged(design.*member, ulps);
      if (beside.offset_ratio <= 1.0 && agree(ours, testing::reference({beside}, scene)[0])) return true;
    }
  return false;
}

/// What a block of aimed designs came to.
struct Block {
  std::size_t draws = 0, lifted = 0, looked_at = 0, decided_beside = 0;
  std::vector<std::string> wrong;
};

/// Aims at nodes and solves each design and two beside it, 16 units in the last place of its spin and angle
/// away, in lanes. A node is no place where anything happens: an answer like neither of those beside it, and
/// one in so many of the others, is held against long double's.
template <class T>
Block aim(std::size_t seed, std::size_t count, std::size_t one_in) {
  std::mt19937_64 random(seed);
  constexpr double same = 1e-8;  // a lift-off lost or counted twice changes much more
  const Scene scene;
  Block block;
  std::vector<Design> designs, before, beyond;
  while (designs.size() < count) {
    ++block.draws;
    const auto design = testing::aimed_at_a_node(random);
    if (!design) continue;
    designs.push_back(*design);
    for (const auto& [beside, ulps] : {std::pair{&before, -16}, std::pair{&beyond, 16}}) {
      beside->push_back(*design);
      beside->back().release_spin = nudged(design->release_spin, ulps);
      beside->back().release_angle = nudged(design->release_angle, ulps);
    }
  }
  const std::vector<Outcome> ours = testing::solve_all<T>(designs, scene, 1e-12),
                             ours_before = testing::solve_all<T>(before, scene, 1e-12),
                             ours_beyond = testing::solve_all<T>(beyond, scene, 1e-12);
  for (std::size_t i = 0; i < count; ++i) {
    block.lifted += ours[i].candidates > 0;
    const bool isolated = !agree(ours[i], ours_before[i], same) && !agree(ours[i], ours_beyond[i], same);
    if (!isolated && i % one_in != 0) continue;
    ++block.looked_at;
    const Outcome truth = testing::reference({designs[i]}, scene)[0];
    if (agree(ours[i], truth)) continue;
    ++block.decided_beside;
    if (!is_right_beside(ours[i], designs[i], scene))
      block.wrong.push_back(fmt::format("{}: {} {} after {}, truth {} {} after {}", testing::told(designs[i]),
                                        name_of(ours[i].status), ours[i].jump_height, int{ours[i].candidates},
                                        name_of(truth.status), truth.jump_height, int{truth.candidates}));
  }
  return block;
}

template <class T>
void expect_right_answers(std::size_t seed, std::size_t count) {
  constexpr std::size_t block_size = 5'000, one_in = 100;
  const std::size_t blocks = (count + block_size - 1) / block_size;
  Block all;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t b = 0; b < blocks; ++b) {
    const Block block = aim<T>(seed * 1'000'000 + b, std::min(block_size, count - b * block_size), one_in);
#pragma omp critical
    {
      all.draws += block.draws, all.lifted += block.lifted;
      all.looked_at += block.looked_at, all.decided_beside += block.decided_beside;
      all.wrong.insert(all.wrong.end(), block.wrong.begin(), block.wrong.end());
    }
  }
  EXPECT_EQ(all.wrong.size(), 0u) << (all.wrong.empty() ? "" : all.wrong.front());
  EXPECT_LT(all.draws, 20 * count) << "most draws should do";
  EXPECT_GT(all.lifted, count / 2) << "they are aimed at lift-offs";
  EXPECT_GT(all.looked_at, count / one_in / 2);
  EXPECT_LT(all.decided_beside, count / 20) << "most places are well conditioned";
  ::testing::Test::RecordProperty("looked_at", std::to_string(all.looked_at));
  ::testing::Test::RecordProperty("decided_beside", std::to_string(all.decided_beside));
}

/// Twins of slow.aimed, which is a million; for sanitizers a smaller one.
#ifdef NDEBUG
constexpr std::size_t usual = 200'000;
#else
constexpr std::size_t usual = 40'000;
#endif

TEST(Aimed, LiftOffsOnNodesAreFoundOnceInLanes) { expect_right_answers<Batch>(1, how_many(usual)); }

TEST(Aimed, LiftOffsOnNodesAreFoundOnceOneByOne) { expect_right_answers<double>(2, how_many(usual) / 20); }

/// Found by aiming, each of them wrong before the sign at a node was computed once.
TEST(Aimed, KnownCases) {
  const auto solved = [](const Design& design) {
    return testing::solve_all<Batch>({design}, testing::unit_scene(), 1e-12)[0];
  };
  Design lost{.slope = 0.7869897210165152,
              .mass_ratio = 55.09232137250197,
              .inertia_factor = 0.5,
              .release_angle = 2.0925220780510614};
  for (int ulps = -8; ulps <= 8; ++ulps) {
    lost.release_spin = nudged(1.0270156691322998, ulps);
    const Outcome outcome = solved(lost);
    EXPECT_NEAR(outcome.jump_height, 0.203032525130437, 1e-12) << ulps;
    EXPECT_NEAR(outcome.jump_time, 0.259875582185, 1e-11) << ulps;
  }
  const Outcome flag = solved({.slope = 0.2735491205258086,
                               .mass_ratio = 0.391937962544061,
                               .inertia_factor = 0.5,
                               .release_spin = 0.5070788833416867});
  EXPECT_EQ(flag.spurious_first_jump, 1);
  EXPECT_EQ(flag.candidates, 2);
  // Released where N vanishes, falling: a lift-off at once, or in the air already.
  const Outcome released = solved({.slope = 0.44664999745829187,
                                   .mass_ratio = 2.205560224989598,
                                   .offset_ratio = 0.5530702718908482,
                                   .inertia_factor = 0.5,
                                   .release_angle = 1.4064306172117094,
                                   .release_spin = 4.243009454347112});
  if (released.status != Status::airborne_at_release) {
    EXPECT_NEAR(released.jump_height, 0.786706, 1e-6);
    EXPECT_NEAR(released.jump_time, 0.0, 1e-7) << "the root of a rounding";
  }
}

}  // namespace
}  // namespace leapmap
