// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops made after a line of drawings that differ in one parameter only, by steps shorter than its
/// tolerance.
///
/// The same hoop of each sample, made after one drawing after the other, changes smoothly but where it passes
/// a discontinuity. Every eighth of these is solved, beginning anywhere. What lies between two of them is
/// interpolated if the four nearest agree in status and lift-offs, and if a polynomial of one degree less
/// gives the same numbers; else the gap is halved. Phases may change in the gap, for example because the hoop
/// begins to slip, if polynomials from both sides give the same numbers. They must agree, too, if phases are
/// asked for, or if no numbers are: then nothing else reveals a discontinuity.
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
    Nodes<4> nodes{};                  ///< of the cubic that interpolates in the gap
    std::array<Nodes<3>, 2> checks{};  ///< of parabolas that have to agree with the cubic
    std::size_t checked = 0;           ///< number of parabolas; 0: nothing may be interpolated
  };

  std::size_t place(std::size_t drawing, std::size_t hoop) const { return drawing * samples_ + hoop; }
  double number(std::size_t drawing, std::size_t hoop, std::size_t n) const {
    return values_[place(drawing, hoop) * numbers_.size() + n];
  }
  const Kind& kind(std::size_t drawing, std::size_t hoop) const { return kinds_[place(drawing, hoop)]; }
  /// Whether two kinds agree in everything asked for besides numbers.
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
  /// Whether the cubic through these nodes predicts the numbers of a solved hoop.
  bool predicts(const Nodes<4>& nodes, std::size_t drawing, std::size_t hoop) const;
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
  /// Its value for number n of a hoop.
  template <std::size_t N>
  double weighted(const Nodes<N>& nodes, const std::array<double, N>& weights, std::size_t hoop,
                  std::size_t n) const;

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
