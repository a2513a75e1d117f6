// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves one design from the paper's equations alone (referee/motion.hpp), by integrating them in SI units:
/// slow, and right or wrong for reasons of its own. It judges the solvers that are fast.
#pragma once

#include <functional>
#include <vector>

#include "integrate/guarded_steps.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "numerics/gsl_integrator.hpp"
#include "referee/motion.hpp"
#include "referee/sampled.hpp"

namespace leapmap::referee {

/// One thread's workspace for one scene.
class Referee {
 public:
  /// tolerance: of each step, relative. A design that takes more steps than that is given up.
  Referee(const Scene& scene, double tolerance, long most_steps = 20'000);
  Referee(const Referee&) = delete;
  Referee& operator=(const Referee&) = delete;

  /// The outcome as maps store it, times in seconds, by the rules of the scene's friction. Failed: the
  /// integrator gave up, or the design takes too many steps or phases.
  Outcome solve(const Design& design);

  /// Whether solve also fills in max_normal_force and what a motor does, which takes many times as long.
  bool meets_forces = false;

 private:
  using Guard = GuardOf<Motion>;
  struct Moving;
  struct System {
    Body body;
    Mode mode;
  };
  /// Moves from `at` on, in one mode, and tells of each fall, in order of time: happens(guard) returns true
  /// where the mode ends. False: it could not be followed.
  bool follow(const Mode& mode, const std::vector<Guard>& guards,
              const std::function<bool(std::size_t)>& happens);
  Outcome solve_sticking();
  Outcome solve_coulomb(const Design& design);
  class Slipping;
  /// Meets the largest force, spin and power of the step in hand up to a time of it.
  void meet(const Mode& mode, double end);
  /// Counts a lift-off; true if it is the jump.
  bool count_lift_off(const Flown& flown);
  /// Tells how far the jump goes and how hard it lands: from the lift-off to just before the landing.
  void measure(const Motion& lift_off, const Motion& before, const Landed& landed);
  /// Finds where the jump from that lift-off clears a wall.
  void clear(const Motion& lift_off);

  Scene scene_;
  double tolerance_;
  double second_;  ///< sqrt(R/g) [s], in which spins are given
  System system_{};
  GslIntegrator<6> integrator_;
  GuardedSteps<6> guarded_;
  long most_steps_, steps_ = 0;
  Motion at_{};        ///< where the hoop is
  double time_ = 0.0;  ///< since release [s]
  Outcome outcome_;
  struct Met {
    double force = 0.0, spin = 0.0, power = 0.0;
  };
  Met met_;            ///< the largest so far, of solve
  double wall_ = 0.0;  ///< height of the wall to clear [m]
};

}  // namespace leapmap::referee
