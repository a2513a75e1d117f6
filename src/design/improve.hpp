// SPDX-License-Identifier: GPL-3.0-or-later
/// From a design to the best one around it, along cliffs and goals, never over them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "design/judge.hpp"

namespace leapmap {

struct Place {
  std::vector<double> at;
  Verdict verdict;
};

/// Row i of places judged together, with its verdict.
Place place_of(std::span<const double> places, std::span<const Verdict> verdicts, std::size_t i);

struct ImproveOptions {
  std::size_t most_rounds = 400;
  std::size_t a_round = 512;  ///< places judged at once
  std::uint64_t seed = 1;
  double widest = 0.1;  ///< step, as a share of the box
};

/// Random steps about the best place so far, of lengths spread evenly over all magnitudes, in a shape that
/// follows the steps that were good. It needs no derivative and no distance to a bound: where the best lies
/// on a cliff, steps along it stay as likely as they were. Ends when rounds bring nothing.
void improve(Judge& judge, Place& place, const ImproveOptions& options);

/// Goes along the cliff or the goal that a place lies on: steps aside, each followed by bisection along the
/// way that the objective rises. What improve finds by chance it finds to rounding. Does nothing inside a
/// branch.
void follow_boundary(Judge& judge, Place& place, std::uint64_t seed);

/// Moves a place that a rounding would take over a cliff or a bound away from there, no farther than it must:
/// its neighbours at 1e-12 of the box are feasible and as good, too. Does nothing if none such is found
/// nearby.
void move_off_boundary(Judge& judge, Place& place, std::uint64_t seed);

/// Whether two places are of one basin: a straight way leads from one to the other that is never worse than
/// both; or the outcome is the same and they are nearer than a fiftieth of the box, as along a curved cliff.
bool are_connected(Judge& judge, const Place& a, const Place& b);

/// The largest distance along any axis of the box.
double distance(const Place& a, const Place& b);

}  // namespace leapmap
