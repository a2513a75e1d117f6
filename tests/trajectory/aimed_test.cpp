// SPDX-License-Identifier: GPL-3.0-or-later
/// Designs aimed at the nodes of the scan and at the edge of a release, against long double. LEAPMAP_AIMED:
/// how many.
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/aimed.hpp"
#include "support/exact.hpp"

namespace leapmap {
namespace {

using testing::how_many, testing::nudged;

bool agree(const Outcome& a, const Outcome& b) {
  // 1e-11: what some units in the last place make of a height far down a long runway
  return same_flags(a, b) && (std::isnan(a.jump_height)
                                  ? std::isnan(b.jump_height)
                                  : std::abs(a.jump_height - b.jump_height) <= 1e-11 * (1.0 + b.jump_height));
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

template <class T>
void expect_right_answers(unsigned seed, std::size_t count) {
  std::mt19937_64 random(seed);
  const Scene scene;
  std::vector<Design> designs;
  std::size_t draws = 0, airborne = 0, lifted = 0, beside = 0;
  while (designs.size() < count) {
    ++draws;
    if (const auto design = testing::aimed_at_a_node(random)) designs.push_back(*design);
  }
  EXPECT_LT(draws, 20 * count) << "most draws should do";
  const std::vector<Outcome> ours = testing::solve_all<T>(designs, scene, 1e-12),
                             truth = testing::reference(designs, scene);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    airborne += truth[i].status == Status::airborne_at_release;
    lifted += truth[i].candidates > 0;
    if (agree(ours[i], truth[i])) continue;
    ++beside;
    EXPECT_TRUE(is_right_beside(ours[i], designs[i], scene))
        << testing::told(designs[i]) << ": " << name_of(ours[i].status) << " " << ours[i].jump_height
        << " after " << int{ours[i].candidates} << ", truth " << name_of(truth[i].status) << " "
        << truth[i].jump_height << " after " << int{truth[i].candidates};
  }
  EXPECT_GT(lifted, count / 2) << "they are aimed at lift-offs";
  EXPECT_LT(beside, count / 20) << "most places are well conditioned";
  ::testing::Test::RecordProperty("beside", static_cast<int>(beside));
}

TEST(Aimed, LiftOffsOnNodesAreFoundOnceInLanes) { expect_right_answers<Batch>(1, how_many(40'000)); }

TEST(Aimed, LiftOffsOnNodesAreFoundOnceOneByOne) { expect_right_answers<double>(2, how_many(40'000) / 4); }

/// Found by aiming, each of them wrong before the sign at a node was computed once.
TEST(Aimed, KnownCases) {
  const auto solved = [](const Design& design) { return testing::solve_all<Batch>({design}, {}, 1e-12)[0]; };
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
