// SPDX-License-Identifier: GPL-3.0-or-later
/// The gait that a design settles on: an outcome's gait_ fields.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "gaits/known_jumps.hpp"
#include "gaits/return_map.hpp"

namespace leapmap {

/// Lets designs jump until each round brings them nearer to an orbit by the same factor, and closes that
/// orbit. At most Scene::settle + Scene::most_period jumps are followed. Those between others of the same
/// design are interpolated (known_jumps.hpp), but orbits are closed by jumps that are solved. A thread's own
/// workspace.
class GaitSolver {
 public:
  GaitSolver(const Scene& scene, JumpSolvers solvers) : scene_(scene), map_(scene, std::move(solvers)) {}
  /// By the scene's model. tolerance: relative, of times.
  GaitSolver(const Scene& scene, double tolerance) : GaitSolver(scene, jump_solvers(scene, tolerance)) {}

  /// Fills in what outcomes tell of gaits.
  void solve(std::span<const Design> designs, std::span<Outcome> outcomes);

  /// The orbit that one design settles on. False: none.
  bool orbit_of(const Design& design, Orbit& orbit);

 private:
  /// What is known of a design on its way.
  struct Course {
    long jumps = 0, next_look = 12;
    std::vector<Landed> seen{};  ///< the last landings
    bool settled = false;
    KnownJumps known{};
    bool interpolates = false;  ///< a jump was known from others
  };
  void follow(std::span<const Design> designs, const std::function<void(std::size_t, const Orbit&)>& found);
  bool goes_on(const Design& design, Landed& landed, std::uint64_t phases, Course& course, Orbit& orbit);
  bool takes(const Design& design, const Landed& landed, Course& course, Orbit& orbit);
  bool is_settled(const Design& design, const Course& course, Orbit& orbit);
  /// How far off a round may be, as it is solved with derivatives or without. Jumps that are known from
  /// others lead beside the curve on which landings lie.
  double off(const Course& course) const {
    return map_.nearness() + (course.interpolates ? 100.0 * KnownJumps::error : 0.0);
  }
  bool find_orbit(const Design& design, const Course& course, Orbit& orbit);

  Scene scene_;
  ReturnMap map_;
  std::vector<Course> courses_;
  std::vector<Landed> states_;
  std::vector<Outcome> ends_;  // of each design: of its last jump
};

}  // namespace leapmap
