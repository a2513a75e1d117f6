// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops made after a line of drawings that differ in one parameter only, by steps shorter than its
/// tolerance.
///
/// The same hoop of each sample, made after one drawing after the other, changes smoothly but where it passes
/// a discontinuity. Every eighth of these is solved, beginning anywhere. What lies between two of them is
/// interpolated where the four nearest agree in status and lift-offs, and where a polynomial of one degree
/// less tells the same; else it is halved. Phases may change between the two, as where a hoop just begins to
/// slip, if polynomials of both sides tell the same. They may not where they are all that tells on which side
/// of a discontinuity a hoop is: where they are asked for, and where no numbers are.
///
/// A band of other outcomes between two solved hoops would be passed over. But of the hoops made after a
/// drawing one in eight is solved whatever lies around it. If such a hoop is not what would have been
/// interpolated in its place, every hoop made after the drawings beside is solved, too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "leapmap/outcome.hpp"
#include "tolerance/drawn_line.hpp"
#include "tolerance/made_hoops.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// One a thread.
class MadeLine {
 public:
  /// numbers: of jumps, that are asked for besides status and lift-offs. phases: whether these are, too.
  MadeLine(std::vector<double Outcome::*> numbers, bool phases)
      : numbers_(std::move(numbers)), phases_matter_(phases || numbers_.empty()) {}

  /// Whether so many drawings so near each other are worth interpolating.
  static bool suits(const DrawnLine& line, std::span<const Design> drawings, const MadeHoops& hoops);
  /// Solves or interpolates every hoop made after each of the drawings.
  void solve(std::span<const Design> drawings, DrawnLine line, MadeHoops& hoops, const Solver& solve);
  /// What was asked for of the drawing's hoop of that number; the rest stays as it is.
  void put(std::size_t drawing, std::size_t hoop, Outcome& outcome) const;
  /// Of how many hoops one is solved at least.
  static constexpr std::size_t stride = 8, shortest_line = 4 * stride;
  /// Fewer hoops would meet too little by chance.
  static constexpr std::size_t fewest_samples = 128;
  /// Of a line, for which there is memory, and after which a stop need not wait long.
  static constexpr std::size_t most_hoops = 1 << 18;

 private:
  struct Kind {
    std::uint64_t phases = 0;
    Status status = Status::not_computed;  ///< until it is solved or interpolated
    std::uint8_t spurious = 0, candidates = 0;
    bool is_solved = false;

    bool is_like(const Kind& other) const {
      return phases == other.phases && status == other.status && spurious == other.spurious &&
             candidates == other.candidates;
    }
  };
  /// Some solved drawings.
  template <std::size_t N>
  using Nodes = std::array<std::size_t, N>;
  /// Two drawings that are solved, with none between them that is.
  struct Gap {
    std::size_t from, to;
    Nodes<4> nodes{};                  ///< about it, through which a cubic tells what lies in it
    std::array<Nodes<3>, 2> checks{};  ///< through which polynomials have to tell the same
    std::size_t checked = 0;           ///< the number of those; 0: the nodes are none
  };

  std::size_t place(std::size_t drawing, std::size_t hoop) const { return drawing * samples_ + hoop; }
  double number(std::size_t drawing, std::size_t hoop, std::size_t n) const {
    return values_[place(drawing, hoop) * numbers_.size() + n];
  }
  /// Whether nothing that is asked for besides numbers differs.
  bool agree(Kind a, const Kind& b) const {
    if (!phases_matter_) a.phases = b.phases;
    return a.is_like(b);
  }
  /// Solved by chance, whatever lies around.
  bool is_by_chance(std::size_t drawing, std::size_t hoop) const;
  void refine(std::span<const Design> drawings, MadeHoops& hoops, const Solver& solve);
  /// Asks for all hoops around those that are not what was expected. False: there are none.
  bool ask_where_surprised();
  bool surprises(std::size_t drawing, std::size_t hoop) const;
  bool is_in_narrow_band(std::size_t drawing, std::size_t hoop) const;
  bool has_narrow_phases(std::size_t drawing, std::size_t hoop) const;
  /// Whether the numbers of a solved hoop are about what the cubic through these nodes says.
  bool is_told(const Nodes<4>& nodes, std::size_t drawing, std::size_t hoop) const;
  void measure_spreads();
  void solve_asked(std::span<const Design> drawings, MadeHoops& hoops, const Solver& solve);
  void keep(std::size_t at, const Outcome& outcome);
  /// Calls take(gap) for each gap of a hoop.
  template <class F>
  void for_gaps(std::size_t hoop, const F& take);
  /// That after the i-th of some solved drawings, which ascend.
  Gap gap_after(std::size_t i, std::span<const std::size_t> solved, std::size_t hoop) const;
  bool is_smooth(const Gap& gap, std::size_t hoop) const;
  void interpolate(const Gap& gap, std::size_t hoop);
  /// Of the polynomial through some nodes, at x.
  template <std::size_t N>
  std::array<double, N> weights(const Nodes<N>& nodes, double x) const;

  std::vector<double Outcome::*> numbers_;
  bool phases_matter_;
  std::size_t samples_ = 0, count_ = 0;
  std::vector<double> x_;  // of each drawing
  std::vector<Kind> kinds_;
  std::vector<double> values_;
  std::vector<double> spreads_;  // of each number after each drawing: how well it may be known
  std::vector<char> asked_;
  std::vector<std::size_t> nodes_;  // of the hoop in hand, those that are solved
  std::vector<Design> batch_;
  std::vector<std::size_t> places_;
  std::vector<Outcome> outcomes_;
};

}  // namespace leapmap
