// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip without an integrator: lift-offs as roots of G(phi), times by quadrature.
#pragma once

#include <span>
#include <vector>

#include "trajectory/lift_off_scan.hpp"
#include "trajectory/outcome.hpp"
#include "trajectory/rolling_time.hpp"

namespace leapmap {

/// Which of an outcome's fields are wanted; the others may be left NaN.
struct Wanted {
  bool first_jump_time = true;
  bool jump_time = true;
};

/// Solves designs a block at a time, in stages on full lanes: scan all designs for intervals that may hold a lift-off;
/// tell, polish and fly the next one of each design still searching, until it jumps or its runway ends; integrate the
/// times that are asked for.
///
/// On any scalar: double; Batch, as many designs at once as the machine has lanes; long double, the tests' reference.
/// A thread's own workspace. An outcome depends on the design, the scene and the block's other designs to within
/// rounding (they share numbers of quadrature nodes), not on threads.
template <class T>
class ExactSolver {
 public:
  using S = ScalarOf<T>;

  /// tolerance: relative, of times; angles, spins and heights are good to rounding.
  explicit ExactSolver(double tolerance, const Wanted& wanted = {});

  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);

 private:
  static constexpr std::size_t block = 512;
  static constexpr std::size_t width = Lanes<T>::count;
  using Index = std::array<std::uint32_t, width>;  // of designs in the block, lanes to spare repeat the first

  /// A number for each design of the block.
  using Column = std::vector<S>;

  /// How far a design's flagged intervals have been looked at: now at part `part` of 2^halvings equal ones.
  struct Place {
    int turn = 0, node = 0, halvings = 0;
    std::uint64_t part = 0;
  };
  struct Interval {
    std::uint32_t design;
    S from, to;
  };

  void solve_block(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  void prepare(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  void find_stall(std::uint32_t design, S minimum, S crest);
  void scan(std::span<const std::uint32_t> designs);
  bool next_interval(std::uint32_t design, Interval& interval);
  void advance(std::uint32_t design);
  void look(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  void take_times(std::span<Outcome> outcomes);

  Index index_of(std::span<const std::uint32_t> designs, std::size_t first) const;
  T load(const Column& column, const Index& index) const;
  void store(const T& value, Column& column, const Index& index, std::size_t count) const;
  Roll<T> load_roll(const Index& index) const;
  Roll<S> roll_of(std::uint32_t design) const;

  Wanted wanted_;
  RollingTime<T> time_;
  ScanNodes<S> nodes_;
  // Of each design in the block
  std::array<Column, 13> rolls_;
  Column end_, quiet_, first_turn_, first_angle_, jump_angle_;
  std::vector<std::uint8_t> stalls_;
  std::vector<ScanFlags> flags_;
  std::vector<Place> places_;
  // Designs still searching, those that need a scan, intervals to look at, designs with a lift-off
  std::vector<std::uint32_t> searching_, unscanned_, lifted_;
  std::vector<Interval> intervals_;
};

extern template class ExactSolver<double>;
extern template class ExactSolver<long double>;
extern template class ExactSolver<Batch>;

}  // namespace leapmap
