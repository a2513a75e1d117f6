// SPDX-License-Identifier: GPL-3.0-or-later
/// The map from one landing to the next: its periodic orbits are gaits.
///
/// The state just after a landing is angle, spin, slip and the normal velocity of a rebound. Nothing depends
/// on whole turns of the angle, nor on how far or for how long the hoop has come. Without slip the last two
/// are zero, and as N = 0 ties spin to angle at a lift-off from rolling, the map has one dimension: its
/// derivative has one eigenvalue that is not zero. Passive walkers are told in these words, too (McGeer 1990,
/// Garcia et al. 1998).
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "model/model.hpp"

namespace leapmap {

using Landed = ContactState<double>;

/// Angle, spin, slip and normal velocity.
using StateVector = Eigen::Vector4d;
using StateMatrix = Eigen::Matrix4d;

/// The scene of one jump, from wherever it begins.
Scene each_jump_alone(Scene scene);

/// A state that knows its derivatives by itself; by the normal velocity only where there is one, as by slip.
ContactState<StateDual> by_state(const Landed& at);
/// Those of a state that a map has taken from there.
StateMatrix slope_of(const ContactState<StateDual>& at);
/// By size; of a pair of complex ones the size.
double largest_eigenvalue(const StateMatrix& slope);

/// How far b is from a, angles the shorter way round.
StateVector between(const Landed& a, const Landed& b);
/// Moved along what is not held at zero: slip where it sticks, and a rebound where there is none.
Landed moved(const Landed& at, const StateVector& by);

/// A periodic orbit: as many landings as its period, each with the jump that ends there.
struct Orbit {
  std::vector<Landed> landings;
  std::vector<Jump>
      jumps;  ///< jumps[k] goes from landings[k - 1] to landings[k]; times and distances from there
  double multiplier = 0.0;  ///< the largest eigenvalue by size of the return map's derivative round the orbit
  double height = 0.0;      ///< mean of the jumps [hoop diameters]
  double speed = 0.0;       ///< of the hoop's centre down the plane [m/s]
  double jump_time = 0.0;   ///< from one jump to the next [s]
  double energy_lost = 0.0;  ///< a jump, over (m + m_p) g R
};

/// Goes `period` jumps on from a landing and tells them, but for the multiplier. False: it does not make
/// them, or returns to within `near` of its start before the last of them.
bool go_once_round(const JumpSolver<double>& jumps, const Scene& scene, const Design& design, int period,
                   const Landed& start, Orbit& orbit, double near = 1e-8);

/// Of jumps from state to state: neither times nor measures.
inline constexpr Wanted untimed{
    .first_jump_time = false, .jump_time = false, .descent = false, .landing = false};

/// How designs go on from one landing to the next, each jump alone.
struct JumpSolvers {
  LongJumpSolver<double> jumps;    ///< untimed
  JumpSolver<double> timed_jumps;  ///< with all that there is
  DualJumpSolver<StateDual> duals;
  double tolerance;  ///< of the solvers: relative, of times
};
/// Those of the scene's model. tolerance: relative, of times.
JumpSolvers jump_solvers(const Scene& scene, double tolerance);

/// Goes round orbits of one design after the other. A thread's own workspace.
class ReturnMap {
 public:
  /// The runway counts from each landing to the next.
  ReturnMap(const Scene& scene, JumpSolvers solvers)
      : scene_(each_jump_alone(scene)), solvers_(std::move(solvers)) {}

  /// Takes designs from their landings, or releases, to their next landings, reduced, and further where
  /// goes_on says so. Outcomes are those of each design's last jump; one beyond the runway is no jump.
  void follow(Start start, std::span<const Design> designs, std::span<Landed> states,
              std::vector<Outcome>& outcomes, const GoesOn& goes_on);

  /// `period` jumps on from a state, with the derivative by it. False: it does not make them, or the
  /// derivative is not known.
  bool go_round(const Design& design, int period, Landed& at, StateMatrix& slope);

  /// The orbit of that period near a state, by Newton's iteration to rounding. False: there is none, or one
  /// of a shorter period that divides it.
  bool close(const Design& design, int period, const Landed& near, Orbit& orbit);

  /// How far apart one round may end if it is solved with derivatives and without.
  double nearness() const { return 10.0 * solvers_.tolerance; }

 private:
  bool describe(const Design& design, int period, const Landed& at, const StateMatrix& slope, Orbit& orbit);

  Scene scene_;
  JumpSolvers solvers_;
};

}  // namespace leapmap
