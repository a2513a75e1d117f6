// SPDX-License-Identifier: GPL-3.0-or-later
/// How errors grow from landing to landing: how many jumps a sequence can be followed for.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "trajectory/sequence_gradient.hpp"

namespace leapmap {

/// No larger growth is told.
inline constexpr double most_growth = 1e20;

/// A thread's own workspace.
class ErrorGrowth {
 public:
  ErrorGrowth(const Scene& scene, DualJumpSolver<StateDual> duals);
  /// By the scene's model. tolerance: relative, of times.
  ErrorGrowth(const Scene& scene, double tolerance);

  /// Of each jump that the exact solver makes, up to `most`: what an error of one [rad, sqrt(g/R)] at the
  /// release and another at every landing come to at its landing, all together. It grows as the power of a
  /// Lyapunov number where jumps are chaotic, and stays bounded on the way to a stable gait. `most_growth`
  /// from there on: no digit of doubles is left. NaN from there on: on a kink or a fold.
  std::vector<double> along(const Design& design, std::size_t most);
  /// The same from a landing on, or from a release in that state.
  std::vector<double> along(const Design& design, Start start, ContactState<double> at, std::size_t most);

  /// Fills in the sequence_condition of outcomes: that at the last landing.
  void tell(std::span<const Design> designs, std::span<Outcome> outcomes);

 private:
  Scene scene_;
  DualJumpSolver<StateDual> duals_;
};

}  // namespace leapmap
