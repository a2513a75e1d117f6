// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling without slip without an integrator: lift-offs as roots of G(phi), times by quadrature.
#pragma once

#include <span>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "physics/flight.hpp"
#include "rolling/exact_rows.hpp"
#include "rolling/lift_off_scan.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// Solves designs a block at a time, in stages on full lanes: scan all designs for intervals that may hold a
/// lift-off; tell, polish and fly the next one of each design still searching, until it jumps or its runway
/// ends; integrate the times that are asked for.
///
/// On any scalar: double; Batch, as many designs at once as the machine has lanes; long double, the tests'
/// reference. A thread's own workspace. An outcome depends on the design and the scene; its times also,
/// within the tolerance, on the other designs of the call, which share numbers of nodes; never on threads.
template <class T>
class ExactSolver {
 public:
  using S = ScalarOf<T>;

  /// tolerance: relative, of times; angles, spins and heights are good to rounding.
  explicit ExactSolver(double tolerance, const Wanted& wanted = {});

  /// Solves designs[i] into outcomes[i]. lift_offs, if given, is told angle and spin of every candidate,
  /// those of one design in order; their times are NaN.
  void solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
             std::vector<LiftOff<double>>* lift_offs = nullptr);

 private:
  static constexpr std::size_t block = 1024;
  static constexpr int most_halvings = 40;  // an interval is then 1e-13 rad long
  static constexpr std::size_t width = Lanes<T>::count;
  using Index = std::array<std::uint32_t, width>;  // of designs in the block; lanes to spare repeat the first
  using List = std::vector<std::uint32_t>;         // of designs in the block

  /// One design's search. Flagged intervals are looked at in order of angle, each in 2^halvings equal parts,
  /// now part `part`.
  struct Search {
    S release, end;  // where the hoop is released, and where its runway ends or it stalls
    S turned_back;   // whole turns by which all angles here are less than they are
    S first_turn;    // of the scan
    ScanFlags flags;
    std::uint32_t node_past_release;  // the first one of the first scan; 0 in later scans
    bool released_on_node;            // on that one, but for rounding
    bool last_above;                  // whether G > 0 at the last node of the scan
    int turn, node, halvings;
    std::uint64_t part;
    S first_angle, jump_angle;  // of the lift-offs found
    bool stalls;
    // The time so far: to `panel` pi; the nodes it needs. 0: RollingTime::halving is needed
    long panel;
    S panel_time;
    int panel_nodes, rest_nodes;
  };
  /// An end at the release or at a node has a sign of G that was decided before; elsewhere it is asked.
  enum class Side : std::int8_t { below = -1, asked = 0, above = 1 };
  struct Interval {
    std::uint32_t design;
    S turn;  // the revolution it lies in
    S from, to, guess;
    bool falls;  // surely once, and nothing else
    Side from_side, to_side;
  };
  struct Part {
    long number;  // of the part of a panel in which the lift-off lies, from angle 0 on
    std::uint32_t design;
  };
  struct LoadedIntervals {
    Index index;
    T from, to, turn;
  };

  void solve_block(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  void prepare(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  void scan(const List& designs);
  void hand_on_signs(Search& search, const NodeSigns& signs, std::size_t lane, int turns) const;
  bool next_interval(std::uint32_t design, Interval& interval);
  void advance(Search& search) const;
  void classify_intervals();
  void take_off(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes);
  void land(std::span<Outcome> outcomes) const;
  void take_times(std::span<Outcome> outcomes);
  void start_clocks();
  void sort_parts(std::vector<Part>& parts);
  S halve_time(std::uint32_t design, S Search::*angle) const;
  void take_times(const List& designs, S Search::*angle, double Outcome::*time, std::span<Outcome> outcomes);

  Index index_of(const List& designs, std::size_t first) const {
    Index index;
    for (std::size_t i = 0; i < width; ++i)
      index[i] = designs[first + i < designs.size() ? first + i : first];
    return index;
  }
  T gather(const Index& index, S Search::*member) const {
    LaneArray<T> lanes;
    for (std::size_t i = 0; i < width; ++i) lanes[i] = searches_[index[i]].*member;
    return Lanes<T>::load(lanes.data());
  }
  Index index_of_part(const std::vector<Part>& parts, std::size_t first, std::size_t& count) const;
  LoadedIntervals load_intervals(const std::vector<Interval>& intervals, std::size_t first) const;

  Wanted wanted_;
  std::vector<LiftOff<double>>* told_ = nullptr;
  RollingTime<T> time_;
  ScanNodes<S> nodes_;
  std::vector<Search> searches_;  // of each design in the block
  BlockRows<T> rows_;
  List searching_, still_searching_, unscanned_, lifted_, jumped_, later_;
  std::vector<Interval> intervals_, falls_;
  std::vector<Part> early_, due_, sorted_parts_;
  std::vector<std::uint32_t> places_;
  std::array<S, most_halvings + 1> part_length_;
};

extern template class ExactSolver<double>;
extern template class ExactSolver<long double>;
extern template class ExactSolver<Batch>;

}  // namespace leapmap
