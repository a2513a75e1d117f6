// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip without an integrator: lift-offs as roots of G(phi), times by quadrature.
#pragma once

#include <span>
#include <vector>

#include "noslip/clock.hpp"
#include "noslip/find.hpp"
#include "noslip/take_off.hpp"
#include "trajectory/sequence.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// Solves designs a block at a time, in stages on full lanes: prepare all designs; scan them for intervals
/// that may hold a lift-off; classify, take off from and fly the next one of each design still searching,
/// until it jumps, its runway ends, or it has turned round twice and repeats itself; land, and clock the
/// times that are asked for.
///
/// On any scalar: double; Batch, as many designs at once as the machine has lanes; long double, the tests'
/// reference. A thread's own workspace. An outcome depends on the design and the scene; its times also,
/// within the tolerance, on the other designs of the call, which share numbers of nodes; never on threads.
template <class T>
class ExactSolver {
 public:
  /// tolerance: relative, of times; angles, spins and heights are good to rounding.
  explicit ExactSolver(double tolerance, const Wanted& wanted = {}) : wanted_(wanted), clock_(tolerance) {}

  /// Solves designs[i] into outcomes[i]. told, if given, is told the way of the last one: of one design at a
  /// time.
  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
             FoundLiftOffs* told = nullptr) {
    solve(Start::release, designs, {}, scene, outcomes, told);
  }
  /// The same from where states[i] have designs[i], which have just landed there or are released; moves each
  /// to just after the landing of its jump.
  void solve(Start start, std::span<const Design> designs, std::span<ContactState<ScalarOf<T>>> states,
             const Scene& scene, std::span<Outcome> outcomes, FoundLiftOffs* told = nullptr);
  /// What the solver knows of the last designs it solved, as many as a block holds.
  const Block<T>& block() const { return block_; }

 private:
  void solve_block(Start start, std::span<const Design> designs, std::span<ContactState<ScalarOf<T>>> states,
                   const Scene& scene, std::span<Outcome> outcomes);
  void pick_intervals(std::span<Outcome> outcomes);
  void end_leg(std::uint32_t design, Outcome& outcome);
  void take_times(std::span<Outcome> outcomes);

  Wanted wanted_;
  Block<T> block_;
  Scan<T> scan_;
  Classify<T> classify_;
  TakeOff<T> take_off_;
  Clock<T> clock_;
  DesignList unscanned_, going_on_, turning_, lifted_, jumped_;
  std::vector<Reading<ScalarOf<T>>> readings_;
};

extern template class ExactSolver<double>;
extern template class ExactSolver<long double>;
extern template class ExactSolver<Batch>;

}  // namespace leapmap
